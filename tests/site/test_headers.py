"""One policy on every response of the whole application: pages, files, refusals, faults, and the mounted
service of platforms."""

import re

import pytest
from lti_platform import SITE
from lti_platform import TEACHER as TEACHES
from site_linked import Linked
from site_people import HOME, TEACHER
from site_policy import POLICY, faults_of, policy_of
from starlette.applications import Starlette
from starlette.routing import Mount, Route
from starlette.testclient import TestClient

from coursework.system.headers import Guarded

FRAMES = f"{SITE} https://frames.example.org"
#: Of pages that a platform frames: who may, and where their forms lead by a redirect.
FRAMED = {**POLICY, "frame-ancestors": FRAMES, "form-action": f"'self' {FRAMES}"}


@pytest.fixture(scope="module")
def linked(tmp_path_factory):
    folder = tmp_path_factory.mktemp("headers")
    return Linked(folder)


def addresses(routes, before=""):
    for one in routes:
        if isinstance(one, Mount):
            yield from addresses(one.routes, before + one.path)
        else:
            yield re.sub(r"\{\w+(:\w+)?\}", "1", before + one.path)


@pytest.mark.e2e
def test_every_response_has_the_same_policy(linked):
    asked, lacking = 0, {}
    places = [*addresses(linked.app.routes), *"/no/such/page /lti /lti/ /lti/no/such/page // /desk/".split()]
    assert "/lti/launch" in places
    assert "/static/1" in places
    for name in (None, TEACHER):
        browser = linked.browser(name)
        # What an administrator is shown of the site itself: test_who_may_what.py.
        for place in places if name is None else [one for one in places if one.startswith("/lti")]:
            for method, more in (
                ("GET", {}),
                ("POST", {}),
                ("PUT", {}),
                ("HEAD", {}),
                ("OPTIONS", {}),
                ("GET", {"headers": {"host": "evil.example"}}),
            ):
                reply = browser.request(method, place, **more)
                found = faults_of(reply, FRAMED if place.startswith("/lti/") else POLICY)
                asked += 1
                if found:
                    lacking[method, place, reply.status_code] = found
    assert not lacking
    assert asked > 500


def test_pages_in_a_frame_have_the_same_policy_and_only_their_platform_frames_them(linked):
    visitor = linked.visitor()
    page, path = visitor.enter()
    assert page.status_code == 200
    assert faults_of(page, FRAMED) == []
    assert page.headers["strict-transport-security"].startswith("max-age=")
    assert faults_of(visitor.hand_in(path, page, {"e1-rA": "1"}), FRAMED) == []


def test_the_one_script_of_a_page_in_a_frame_is_told_by_its_digest(linked):
    from lti_platform import DEEP, LTI, seal

    visitor = linked.visitor()
    settings = {
        "deep_link_return_url": "https://back.example.org/return",
        "accept_types": ["ltiResourceLink"],
        "accept_presentation_document_targets": ["iframe"],
    }
    page, path = visitor.enter(
        roles=TEACHES,
        **{
            f"{LTI}message_type": "LtiDeepLinkingRequest",
            f"{DEEP}deep_linking_settings": settings,
            f"{LTI}resource_link": None,
        },
    )
    reply = visitor.browser.post(path, data={"_seal": seal(page.text), "cancel": "1"})
    policy = policy_of(reply)
    assert re.fullmatch(r"'self' 'sha256-[\w+/]+='", policy["script-src"])
    within = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', reply.text)[1]
    assert policy["script-src"].removeprefix("'self' ") in within
    assert policy["form-action"].endswith("https://back.example.org")


def test_what_nobody_answers_for_has_the_policy_too():
    """A fault outside of all pages, and an application that thinks of nothing."""

    async def broken(request):
        raise ZeroDivisionError

    app = Starlette(routes=[Route("/broken", broken)])
    app.add_middleware(Guarded, is_secure=lambda: True)
    client = TestClient(app, base_url=HOME, raise_server_exceptions=False)
    for place, status in (("/broken", 500), ("/", 404)):
        reply = client.get(place)
        assert reply.status_code == status
        assert faults_of(reply, POLICY) == []
        assert "max-age=" in reply.headers["strict-transport-security"]
