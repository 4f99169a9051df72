"""Verification of a platform's token: its signature, its audience, and its time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import jwt

from coursework.platforms.lti.key_sets import KeySets
from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.settings import LTIPlatform, Settings

_DEPLOYMENT = "https://purl.imsglobal.org/spec/lti/claim/deployment_id"
_SLACK = 60  #: seconds that clocks may differ
_NEEDED = ["iss", "sub", "aud", "exp", "iat", "nonce"]
_LONGEST = 64 * 1024

#: Sentence and status for each error; the first match counts.
_FAULTS: tuple[tuple[type[Exception], str, int], ...] = (
    (jwt.ExpiredSignatureError, "expired", 401),
    (jwt.ImmatureSignatureError, "not_yet", 401),
    (jwt.InvalidIssuedAtError, "not_yet", 401),
    (jwt.InvalidAudienceError, "audience", 403),
    (jwt.InvalidIssuerError, "issuer", 403),
    (jwt.MissingRequiredClaimError, "claim", 400),
    (jwt.PyJWTError, "signature", 401),
)


def verified(token: str, settings: Settings, keys: KeySets, expected: LTIPlatform) -> Mapping[str, Any]:
    """Return the claims of a token from the ``expected`` platform, with ``client_id`` among them.

    Only RS256 is accepted; a token without a signature, or signed with a public value, is refused.

    Raises
    ------
    LTIRefusal
        The token is forged, expired, for another client, or from an unknown deployment.
    """
    if len(token) > _LONGEST:
        raise LTIRefusal("too_large", 413, "token")
    try:
        header = jwt.get_unverified_header(token)
        if header.get("alg") != "RS256":
            raise LTIRefusal("signature", 401, f"signed by {str(header.get('alg'))[:20]!r}")
        key = keys.key(expected, str(header.get("kid", "")))
        claims = jwt.decode(
            token,
            key,
            algorithms=["RS256"],
            audience=expected.client_id,
            issuer=expected.issuer,
            leeway=_SLACK,
            options={"require": _NEEDED},
        )
    except jwt.PyJWTError as fault:
        why, status = next((why, status) for kind, why, status in _FAULTS if isinstance(fault, kind))
        raise LTIRefusal(why, status, f"{expected.name}: {type(fault).__name__}") from None
    _check_party(claims, expected)
    if str(claims.get(_DEPLOYMENT, "")) not in expected.deployments:
        raise LTIRefusal(
            "deployment", 403, f"{expected.name}: deployment {str(claims.get(_DEPLOYMENT))[:60]!r}"
        )
    return {**claims, "client_id": expected.client_id}


def _check_party(claims: Mapping[str, Any], expected: LTIPlatform) -> None:
    """Check that a token for several tools was issued to this one."""
    party, audience = claims.get("azp"), claims["aud"]
    several = isinstance(audience, list) and len(audience) > 1
    if (party is not None or several) and party != expected.client_id:
        raise LTIRefusal("audience", 403, f"{expected.name}: asked for by another party")
