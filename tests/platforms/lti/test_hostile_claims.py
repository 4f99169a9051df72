"""A platform that is registered and says odd things: each launch is opened or refused in a sentence, and
people stay apart."""

import json
import math

import jwt
import pytest
from lti_platform import LTI
from sweeps import slow
from tables import each_row

from coursework.database.tables import identity

ODD = (
    None,
    True,
    0,
    -1,
    1.5,
    10**400,
    math.nan,
    math.inf,
    "",
    " ",
    "x" * 5000,
    "\x00",
    "\ud800",
    "\u202e",
    "<script>alert(1)</script>",
    "{0.__class__}",
    "../../x",
    [],
    ["x"] * 500,
    {},
    {"id": {}},
    {"id": "\x00<script>"},
    {"x" * 500: "y"},
    [[[[]]]],
)


def claims_of(tool):
    return sorted(tool.platform.claims("nonce"))


def signed(platform, claims):
    """A token of any claims: what libraries refuse to sign as well."""
    return jwt.api_jws.encode(json.dumps(claims).encode(), platform.private, "RS256", {"kid": platform.kid})


@pytest.mark.parametrize("step", [8, pytest.param(4, marks=slow)])
@pytest.mark.e2e
def test_no_claim_breaks_a_launch(tool, step):
    """No status of a fault, and no text as HTML, whatever a signed claim holds."""
    tried = 0
    visitor = tool.visitor()
    more = [
        "name",
        "given_name",
        "email",
        "azp",
        "nbf",
        *(f"{LTI}{name}" for name in ("custom", "lis", "launch_presentation")),
    ]
    for place, name in enumerate([*claims_of(tool), *more]):
        for odd in ODD[place % step :: step]:
            visitor.browser.cookies.clear()  # one of each launch is all that is looked at
            reply = visitor.launch(sign=lambda claims: signed(tool.platform, {**claims, name: odd}))  # noqa: B023
            tried += 1
            assert reply.status_code < 500, (name, odd)
            if reply.status_code == 303:
                page = visitor.browser.get(reply.headers["location"])
                assert page.status_code < 500, (name, odd)
                assert "<script>alert" not in page.text, (name, odd)
    assert tried > 400 / step


@each_row(
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
)
@pytest.mark.e2e
def test_two_people_are_never_one(tool, one, other):
    """What a platform calls people is kept to the letter; what is too long to be kept is refused."""
    before = {subject for (subject,) in tool.one(identity.c.subject)}
    opened = set()
    for subject in (one, other):
        visitor = tool.visitor()
        reply = visitor.launch(sign=lambda claims: signed(tool.platform, {**claims, "sub": subject}))  # noqa: B023
        assert reply.status_code in (303, 400)
        if reply.status_code == 303:
            assert visitor.browser.get(reply.headers["location"]).status_code == 200
            opened.add(subject)
    assert {subject for (subject,) in tool.one(identity.c.subject)} == before | opened
