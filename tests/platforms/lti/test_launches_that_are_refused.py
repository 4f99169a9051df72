"""A launch that is replayed, expired, forged or for somebody else is refused with a sentence, and opens
nothing."""

import base64
import json
import logging
import time

import jwt
import pytest
from cryptography.hazmat.primitives import serialization
from lti_platform import CLIENT, DEEP, LTI, MEMBER, SITE, TOOL, field, seal
from tables import each_row

from coursework.database.tables import lti_session, submission
from coursework.language.words import words
from coursework.platforms.lti.key_sets import AGAIN_SECONDS, CACHE_SECONDS
from coursework.platforms.lti.login import session_cookie
from coursework.site.lti.site_host import SiteHost

SAID = words("en")["lti"]["refused"]


def refused(answer, why, status):
    """Whether an answer is a page with the sentence, and no more."""
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"].startswith("text/html")
    assert SAID[why].split(":")[0][:40] in answer.text.replace("’", "'")
    assert "Traceback" not in answer.text
    assert "lti-session" not in str(answer.headers)
    assert "frame-ancestors" in answer.headers["content-security-policy"]
    return True


def test_a_launch_opens_the_exercise(visitor):
    page, _path = visitor.enter()
    assert page.status_code == 200
    assert "Ada Byron" in page.text
    assert '<form method="post"' in page.text


def test_a_launch_that_comes_again_is_refused(tool, visitor):
    told, cookies = visitor.told(), dict(visitor.browser.cookies)
    assert visitor.returned(told).status_code == 303
    visitor.browser.cookies.update(cookies)
    assert refused(visitor.returned(told), "replayed", 403)
    tool.begin()  # what is used is remembered
    again = tool.visitor()
    again.browser.cookies.update(cookies)
    assert refused(again.returned(told), "replayed", 403)


def test_a_launch_that_comes_again_without_its_cookie_is_refused(visitor):
    told = visitor.told()
    assert visitor.returned(told).status_code == 303
    assert refused(visitor.returned(told), "cookie", 400)


def test_a_nonce_goes_with_its_own_login_alone(visitor):
    told = {**visitor.told(), "state": visitor.login()["state"]}
    assert refused(visitor.returned(told), "nonce", 400)


def test_a_used_nonce_opens_nothing_with_a_fresh_login(visitor):
    told = visitor.told()
    assert visitor.returned(told).status_code == 303
    assert refused(visitor.launch(sign=lambda claims: told["id_token"]), "nonce", 400)


def test_a_login_of_long_ago_is_refused(tool, visitor):
    told = visitor.told()
    tool.ahead = 700.0
    assert refused(visitor.returned(told), "stale", 400)


def test_another_browser_s_login_is_refused(tool, visitor):
    told, other = visitor.told(), tool.visitor()
    other.login()
    assert refused(other.returned(told), "cookie", 400)
    (name,) = [name for name in visitor.browser.cookies if name.startswith("__Host-lti-")]
    other.browser.cookies.set(name, "guessed", domain="tool.example.org", path="/")
    assert refused(other.returned(told), "browser", 403)


def test_without_a_cookie_the_page_offers_a_new_window(tool, visitor):
    asked = visitor.login(lti_message_hint="42")
    visitor.browser.cookies.clear()
    token = visitor.platform.signed(visitor.platform.claims(asked["nonce"]))
    page = visitor.returned({"state": asked["state"], "id_token": token})
    assert refused(page, "cookie", 400)
    assert 'target="_blank"' in page.text
    again = {
        name: field(page.text, name)
        for name in ("iss", "login_hint", "lti_message_hint", "client_id", "target_link_uri")
    }
    answer = visitor.browser.post("/lti/login", data=again)
    assert answer.status_code == 302
    assert "lti_message_hint=42" in answer.headers["location"]


TIMES = ("exp", "iat", "nbf")  #: claims that are told below in seconds ago


@each_row(
    ("changed", "why", "status"),
    [
        ({"exp": 120, "iat": 600}, "expired", 401),
        ({"iat": -600, "exp": -900}, "not_yet", 401),
        ({"nbf": -600}, "not_yet", 401),
        ({"aud": "somebody"}, "audience", 403),
        ({"aud": [CLIENT, "somebody"]}, "audience", 403),
        ({"aud": [CLIENT, "somebody"], "azp": "somebody"}, "audience", 403),
        ({"azp": "somebody"}, "audience", 403),
        ({"iss": "https://evil.example.org"}, "issuer", 403),
        ({"deployment_id": "4"}, "deployment", 403),
        ({"deployment_id": None}, "deployment", 403),
        ({"sub": None}, "claim", 400),
        ({"sub": ""}, "claim", 400),
        ({"exp": None}, "claim", 400),
        ({"iat": None}, "claim", 400),
        ({"aud": None}, "claim", 400),
        ({"iss": None}, "claim", 400),
        ({"nonce": None}, "claim", 400),
        ({"roles": None}, "claim", 400),
        ({"roles": "Instructor"}, "claim", 400),
        ({"resource_link": None}, "claim", 400),
        ({"resource_link": {"title": "no id"}}, "claim", 400),
        ({"message_type": None}, "claim", 400),
        ({"message_type": "LtiSubmissionReviewRequest"}, "message", 400),
        ({"version": "1.1"}, "message", 400),
    ],
)
def test_a_token_that_says_something_else_is_refused(tool, visitor, changed, why, status):
    def sign(claims):
        for name, value in changed.items():
            if name in TIMES and value is not None:
                value = int(time.time()) - value
            claims[name if name in claims or name in ("azp", "nbf") else f"{LTI}{name}"] = value
        return tool.platform.signed({name: value for name, value in claims.items() if value is not None})

    assert refused(visitor.launch(sign=sign), why, status)
    assert not tool.one(lti_session.c.id)


def part(data):
    return base64.urlsafe_b64encode(json.dumps(data).encode()).rstrip(b"=").decode()


def public_pem(platform):
    return platform.private.public_key().public_bytes(
        serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    )


def sealed_with_the_public_key(platform, claims):
    """HS256 with what everybody can read as the secret."""
    import hashlib
    import hmac

    signed = f"{part({'alg': 'HS256', 'kid': platform.kid, 'typ': 'JWT'})}.{part(claims)}"
    seal = hmac.new(public_pem(platform), signed.encode(), hashlib.sha256).digest()
    return f"{signed}.{base64.urlsafe_b64encode(seal).rstrip(b'=').decode()}"


def unsigned(platform, claims):
    return f"{part({'alg': 'none', 'kid': platform.kid})}.{part(claims)}."


def by_another_key(platform, claims):
    from lti_platform import _KEYS

    return jwt.encode(claims, _KEYS[2], "RS256", headers={"kid": platform.kid})


def by_a_key_it_brings(platform, claims):
    from lti_platform import _KEYS, jwk

    return jwt.encode(claims, _KEYS[2], "RS256", headers={"kid": "mine", "jwk": jwk(_KEYS[2], "mine")})


def changed_after_signing(platform, claims):
    head, _, seal = platform.signed(claims).split(".")
    return f"{head}.{part({**claims, LTI + 'roles': [MEMBER + 'Instructor']})}.{seal}"


FORGED = [sealed_with_the_public_key, unsigned, by_another_key, by_a_key_it_brings, changed_after_signing]


@each_row("forge", FORGED)
def test_a_forged_token_is_refused(visitor, forge):
    answer = visitor.launch(sign=lambda claims: forge(visitor.platform, claims))
    assert refused(answer, "signature", 401)


@each_row("token", ["", "x", "a.b.c", "é", "." * 50, "eyJhbGciOiJSUzI1NiJ9.e30."])
def test_what_is_no_token_is_refused(visitor, token):
    answer = visitor.launch(sign=lambda claims: token)
    assert answer.status_code in (400, 401)
    assert "<h1>" in answer.text


@each_row("state", ["", "x", "a.b.c"])
def test_a_state_that_is_not_ours_is_refused(visitor, state):
    answer = visitor.returned({**visitor.told(), "state": state})
    assert refused(answer, "state" if state else "bad_request", 400)


def test_a_state_sealed_by_nobody_is_refused(visitor):
    told = visitor.told()
    held = jwt.decode(told["state"], options={"verify_signature": False})
    forged = jwt.encode({**held, "exp": held["exp"] + 9999}, "k" * 64, "HS256")
    assert refused(visitor.returned({**told, "state": forged}), "state", 400)


# ------------------------------------------------------------------------- keys


def test_an_unknown_key_is_refused_and_asked_for_once_in_a_while(tool, visitor):
    visitor.enter()
    before = tool.platform.asked_for("/jwks")
    for _ in range(5):
        answer = visitor.launch(sign=lambda claims: tool.platform.signed(claims, kid="nobody"))
        assert refused(answer, "signature", 401)
    assert tool.platform.asked_for("/jwks") <= before + 1


def test_a_platform_that_rotates_its_key_is_followed(tool):
    from coursework.platforms.lti.key_sets import KeySets
    from coursework.platforms.lti.refusal import LTIRefusal

    now = [0.0]
    sets = KeySets(tool.platform.client, lambda: now[0])
    platform = tool.settings.platforms[0]
    assert sets.key(platform, "one")
    tool.platform.rotate()
    with pytest.raises(LTIRefusal, match="has no key"):
        sets.key(platform, "key-1")  # asked for a moment ago
    now[0] += AGAIN_SECONDS + 1
    assert sets.key(platform, "key-1")
    with pytest.raises(LTIRefusal, match="has no key"):
        sets.key(platform, "one")  # what the platform took back is gone


def test_a_key_that_was_taken_back_is_not_kept_for_ever(tool):
    from coursework.platforms.lti.key_sets import KeySets
    from coursework.platforms.lti.refusal import LTIRefusal

    now = [0.0]
    sets, platform = KeySets(tool.platform.client, lambda: now[0]), tool.settings.platforms[0]
    assert sets.key(platform, "one")
    tool.platform.rotate()
    now[0] += CACHE_SECONDS + 1
    with pytest.raises(LTIRefusal, match="has no key"):
        sets.key(platform, "one")


def test_keys_that_are_known_serve_while_the_platform_is_down(tool):
    from coursework.platforms.lti.key_sets import KeySets

    now = [0.0]
    sets, platform = KeySets(tool.platform.client, lambda: now[0]), tool.settings.platforms[0]
    assert sets.key(platform, "one")
    tool.platform.down = -1
    now[0] += CACHE_SECONDS + 1
    assert sets.key(platform, "one")


def test_a_platform_without_keys_is_said_to_be_down(tool, visitor):
    tool.platform.down = 503
    assert refused(visitor.launch(), "platform_down", 502)


def test_a_symmetric_key_among_those_published_is_not_used(tool):
    secret = base64.urlsafe_b64encode(b"s" * 32).rstrip(b"=").decode()
    real = tool.platform.answer

    def answer(request):
        got = real(request)
        if request.url.path == "/jwks":
            import httpx

            return httpx.Response(
                200, json={"keys": [{"kty": "oct", "kid": "one", "k": secret, "alg": "HS256"}]}
            )
        return got

    tool.platform.answer = answer
    tool.begin()
    kid = {"kid": "one"}
    answer = tool.visitor().launch(sign=lambda claims: jwt.encode(claims, b"s" * 32, "HS256", headers=kid))
    assert refused(answer, "signature", 401)


# ----------------------------------------------------------------- login and sizes


@each_row(
    ("told", "why", "status"),
    [
        ({"iss": "https://evil.example.org"}, "platform", 403),
        ({"iss": ""}, "platform", 403),
        ({"client_id": "another"}, "platform", 403),
        ({"login_hint": ""}, "bad_request", 400),
        ({"login_hint": "x" * 3000}, "bad_request", 400),
        ({"target_link_uri": "https://evil.example.org/launch"}, "target", 400),
        ({"target_link_uri": "https://tool.example.org@evil.example.org/"}, "target", 400),
        ({"target_link_uri": "//evil.example.org"}, "target", 400),
        ({"target_link_uri": "javascript:alert(1)"}, "target", 400),
        ({"target_link_uri": "https://tool.example.org\\@evil.example.org"}, "target", 400),
    ],
)
def test_a_login_that_is_not_for_us_is_refused(visitor, told, why, status):
    usual = {"iss": SITE, "login_hint": "ada", "target_link_uri": f"{TOOL}/lti/launch", "client_id": CLIENT}
    assert refused(visitor.browser.get("/lti/login", params={**usual, **told}), why, status)
    assert refused(visitor.browser.post("/lti/login", data={**usual, **told}), why, status)


def test_nobody_is_sent_where_a_launch_says(visitor):
    answer = visitor.launch(target_link_uri="https://evil.example.org/steal")
    assert answer.status_code == 303
    assert answer.headers["location"].startswith(f"{TOOL}/lti/at/")


def test_logging_in_writes_nothing_down(tool, visitor):
    before = [(path.name, path.stat().st_size) for path in sorted(tool.site.lti.parent.iterdir())]
    for _ in range(20):
        visitor.login()
    assert [(path.name, path.stat().st_size) for path in sorted(tool.site.lti.parent.iterdir())] == before


def test_a_form_that_is_too_large_is_refused(visitor):
    assert refused(visitor.returned({"state": "x" * 300_000}), "too_large", 413)
    told = {"content-type": "application/x-www-form-urlencoded", "content-length": "300000"}
    assert refused(
        visitor.browser.post("/lti/launch", content=b"x=y", headers=told), "too_large", 413
    )  # by its head alone
    page, path = visitor.enter()
    assert visitor.hand_in(path, page, {"e1-rA": "1" * 5000}).status_code == 413
    assert refused(visitor.browser.post(path, data={f"f{k}": "1" for k in range(1500)}), "bad_request", 400)
    assert refused(visitor.browser.post(path, files={"rA": b"1"}), "bad_request", 400)
    json = {"content-type": "application/json"}
    assert refused(visitor.browser.post(path, content=b"{}", headers=json), "bad_request", 415)


@each_row(
    ("method", "path", "status"),
    [("get", "/lti/launch", 405), ("put", "/lti/login", 405), ("get", "/lti/", 404), ("get", "/lti/at", 404)],
)
def test_what_there_is_not_is_told_on_a_page(visitor, method, path, status):
    assert refused(getattr(visitor.browser, method)(path), "method" if status == 405 else "page", status)


def test_a_refusal_speaks_the_language_of_the_browser(visitor):
    page = visitor.browser.get("/lti/nowhere", headers={"Accept-Language": "de, fr-CA;q=0.9, en;q=0.5"})
    assert words("fr")["lti"]["refused"]["page"] in page.text.replace("’", "'")


# ---------------------------------------------------------------- sessions and forms


def test_another_s_cookie_opens_nothing(tool, visitor):
    other = tool.visitor()
    _, path = visitor.enter()
    _, others = other.enter(sub="bob", name="Bob")
    assert refused(other.browser.get(path), "cookie", 403)
    mine, theirs = (session_cookie(one.rpartition("/")[2], TOOL) for one in (path, others))
    other.browser.cookies.set(mine, other.browser.cookies[theirs], domain="tool.example.org", path="/")
    assert refused(other.browser.get(path), "browser", 403)
    assert other.browser.get(others).status_code == 200


def test_a_session_ends(tool, visitor):
    page, path = visitor.enter()
    tool.ahead = 13 * 3600.0
    assert refused(visitor.browser.get(path), "session", 403)
    assert refused(visitor.hand_in(path, page, {"e1-rA": "1"}), "session", 403)


def test_a_form_of_another_site_is_refused(tool, visitor):
    page, path = visitor.enter()
    fields = {"_seal": seal(page.text), "_number": "1", "e1-rA": "1 mm"}
    for sent in ("https://evil.example.org", "null"):
        assert refused(visitor.browser.post(path, data=fields, headers={"Origin": sent}), "form", 403)
    assert refused(visitor.browser.post(path, data={**fields, "_seal": "0" * 64}), "form", 403)
    assert refused(visitor.browser.post(path, data={**fields, "_seal": "é"}), "form", 403)
    other, _ = tool.visitor().enter(sub="bob")
    assert refused(visitor.browser.post(path, data={**fields, "_seal": seal(other.text)}), "form", 403)
    assert not tool.one(submission.c.id)
    assert visitor.browser.post(path, data=fields, headers={"Origin": TOOL}).status_code == 303


def test_cookies_are_for_https_and_for_one_frame_alone(visitor):
    answer = visitor.browser.get("/lti/login", params={"iss": SITE, "login_hint": "ada", "client_id": CLIENT})
    cookies = [answer.headers["set-cookie"], visitor.launch().headers["set-cookie"]]
    for cookie in cookies:
        assert cookie.startswith("__Host-lti-"), "plain http or a neighbouring host could set it"
        for word in ("HttpOnly", "Secure", "SameSite=None", "Partitioned"):
            assert word in cookie


def test_only_the_platform_may_hold_a_page_in_a_frame(visitor):
    page, _ = visitor.enter()
    policy = page.headers["content-security-policy"]
    assert f"frame-ancestors {SITE} https://frames.example.org" in policy.split("; ")
    assert page.headers["cache-control"] == "no-store"
    assert page.headers["x-content-type-options"] == "nosniff"


def test_the_log_holds_neither_answers_nor_tokens(visitor, caplog):
    with caplog.at_level(logging.DEBUG, "coursework.site"):
        page, path = visitor.enter()
        visitor.hand_in(path, page, {"e1-rA": "12345.678 mm"})
        visitor.browser.get(path)
        visitor.launch(sign=lambda claims: "a.b.c")
    assert caplog.text.count("coursework.site") >= 5
    for secret in ("12345.678", path.rpartition("/")[2], seal(page.text), "Ada"):
        assert secret not in caplog.text


def test_what_concerns_security_is_in_the_site_s_log_of_it(tool, visitor, caplog):
    with caplog.at_level(logging.INFO, "coursework.security"):
        _, path = visitor.enter()
        visitor.launch(sign=lambda claims: "a.b.c")
        visitor.browser.post(path, data={"_seal": "forged"})
        tool.visitor().browser.get(path)
    events = [
        record.getMessage().removeprefix("security: ").partition(", from ") for record in caplog.records
    ]
    assert [event for event, _, _ in events] == [
        "signed in, POST /lti/launch, nobody",
        "sign-in failed, POST /lti/launch, nobody",
        "forged form, POST /lti/at/{session}, somebody of learn.example.org",
        "no permission, GET /lti/at/{session}, nobody",
    ]
    assert {address for _, _, address in events} == {"testclient"}


def test_what_fails_is_a_page_and_no_traceback(visitor, caplog, monkeypatch):
    page, path = visitor.enter()

    def fails(*_, **__):
        raise ZeroDivisionError("the answer was 12345.678")

    monkeypatch.setattr(SiteHost, "answer", fails)
    with caplog.at_level(logging.INFO, "coursework.site"):
        answer = visitor.hand_in(path, page, {"e1-rA": "12345.678"})
    assert refused(answer, "failed", 500)
    assert "ZeroDivisionError" in caplog.text
    assert "12345.678" not in caplog.text + answer.text


# ---------------------------------------------------------------------- deep linking


PICKING = {
    "deep_link_return_url": f"{SITE}/return",
    "accept_types": ["ltiResourceLink"],
    "data": "as it came",
}


def pick(visitor, **changed):
    told = {
        "message_type": "LtiDeepLinkingRequest",
        "roles": [f"{MEMBER}Instructor"],
        "resource_link": None,
        f"{DEEP}deep_linking_settings": PICKING,
    }
    return visitor.enter(**{**told, **changed})


def test_a_student_picks_nothing(visitor):
    told = {
        "message_type": "LtiDeepLinkingRequest",
        "resource_link": None,
        f"{DEEP}deep_linking_settings": PICKING,
    }
    assert refused(visitor.launch(**told), "role", 403)


def test_links_are_picked_where_a_platform_asked_for_them_alone(visitor):
    _page, path = visitor.enter(roles=[f"{MEMBER}Instructor"])
    sheet = visitor.browser.get(f"{path}/sheet")
    answer = visitor.browser.post(
        path, data={"_seal": seal(sheet.text), "offer": "exercise:four_bar_motion", "_number": "1"}
    )
    assert answer.status_code in (400, 404)
    assert "JWT" not in answer.text


@each_row(
    ("form", "why"),
    [
        ({"offer": "exercise:nothing"}, "unknown_choice"),
        ({"offer": "file:/etc/passwd"}, "unknown_choice"),
        ({}, "no_choice"),
        ({"offer": "exercise:slotted_mechanism", "points": "-1"}, "no_question"),
        ({"offer": "exercise:slotted_mechanism", "points": "nan"}, "no_question"),
        ({"offer": "exercise:slotted_mechanism", "tries": "0"}, "no_question"),
        ({"offer": "exercise:slotted_mechanism", "counts": "all"}, "no_question"),
        ({"offer": ["exercise:slotted_mechanism", "exercise:four_bar_motion"]}, "too_many"),
    ],
)
def test_a_forged_choice_is_refused(visitor, form, why):
    page, path = pick(visitor)
    assert refused(visitor.browser.post(path, data={"_seal": seal(page.text), **form}), why, 400)


def test_the_way_back_is_the_platform_s_and_no_form_s(visitor):
    page, path = pick(visitor)
    form = {
        "_seal": seal(page.text),
        "offer": "exercise:slotted_mechanism",
        "deep_link_return_url": "https://evil.example.org",
    }
    answer = visitor.browser.post(path, data=form)
    assert 'action="https://learn.example.org/return"' in answer.text
    assert "evil" not in answer.text
    assert refused(visitor.browser.post(path, data={**form, "_seal": "x"}), "form", 403)
