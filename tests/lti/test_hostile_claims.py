"""A platform that is registered and says odd things: each launch is opened or refused in a sentence, and people stay apart."""

import json
import math

import jwt
import pytest
from lti_platform import LTI

ODD = (
    None, True, 0, -1, 1.5, 10**400, math.nan, math.inf, "", " ", "x" * 5000, "\x00", "\ud800", "\u202e", "<script>alert(1)</script>", "{0.__class__}",
    "../../x", [], ["x"] * 500, {}, {"id": {}}, {"id": "\x00<script>"}, {"x" * 500: "y"}, [[[[]]]],
)  # fmt: skip


def claims_of(tool):
    return sorted(tool.platform.claims("nonce"))


def signed(platform, claims):
    """A token of any claims: what libraries refuse to sign as well."""
    return jwt.api_jws.encode(json.dumps(claims).encode(), platform.private, "RS256", {"kid": platform.kid})


def test_no_claim_breaks_a_launch(tool):
    """No status of a fault, and no text as HTML, whatever a signed claim holds."""
    tried = 0
    visitor = tool.visitor()
    for place, name in enumerate(
        [
            *claims_of(tool),
            "name",
            "given_name",
            "email",
            f"{LTI}custom",
            f"{LTI}lis",
            f"{LTI}launch_presentation",
            "azp",
            "nbf",
        ]
    ):
        for odd in ODD[place % 4 :: 4]:
            asked = visitor.login()
            token = signed(tool.platform, {**tool.platform.claims(asked["nonce"]), name: odd})
            reply = visitor.browser.post("/launch", data={"state": asked["state"], "id_token": token})
            tried += 1
            assert reply.status_code < 500, (name, odd)
            if reply.status_code == 303:
                page = visitor.browser.get(reply.headers["location"])
                assert page.status_code < 500, (name, odd)
                assert "<script>alert" not in page.text, (name, odd)
    assert tried > 100


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("x" * 4000 + "a", "x" * 4000 + "b"),
        ("é", "e\u0301"),
        ("Ada", "ada"),
        ("ada", "ada "),
        ("a\u200bda", "ada"),
        ("1", "1.0"),
        ("K", "\u212a"),
    ],
    ids=lambda told: f"{told[-2:]!a}",
)
def test_two_people_are_never_one(tool, one, other):
    """What a platform calls people is kept to the letter; what is too long to be kept is refused."""
    opened = []
    for person in (one, other):
        visitor = tool.visitor()
        asked = visitor.login()
        token = signed(tool.platform, {**tool.platform.claims(asked["nonce"]), "sub": person})
        reply = visitor.browser.post("/launch", data={"state": asked["state"], "id_token": token})
        assert reply.status_code in (303, 400)
        if reply.status_code == 303:
            visitor.browser.get(reply.headers["location"])
            opened.append(person)
    with tool.storage._open() as file:
        kept = [row[0] for row in file.execute("SELECT DISTINCT person FROM papers")]
    assert len(kept) == len(opened)
