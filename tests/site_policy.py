"""What every response of the site says of what a browser may do with it, and what one lacks of that."""

ALWAYS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}
POLICY = {
    "default-src": "'none'",
    "img-src": "'self' data:",
    "style-src": "'self' 'unsafe-inline'",
    "script-src": "'self'",
    "font-src": "'self'",
    "connect-src": "'self'",
    "form-action": "'self'",
    "base-uri": "'none'",
    "frame-ancestors": "'none'",
    "manifest-src": "'self'",
}


def policy_of(reply):
    return dict(part.strip().split(" ", 1) for part in reply.headers["content-security-policy"].split(";"))


def faults_of(reply, policy):
    """What a response lacks."""
    found = [
        f"{name} is {reply.headers.get(name)}"
        for name, text in ALWAYS.items()
        if reply.headers.get(name) != text
    ]
    if policy_of(reply) != policy:
        found.append(f"policy {set(policy_of(reply).items()) ^ set(policy.items())}")
    if (reply.headers.get("x-frame-options") == "DENY") != (policy["frame-ancestors"] == "'none'"):
        found.append("x-frame-options")
    kept = reply.headers.get("cache-control", "")
    if kept != "no-store" and not kept.startswith("public, max-age="):
        found.append(f"cache-control {kept}")
    return found
