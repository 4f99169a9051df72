"""A platform of one's own: it signs launches, gives keys and tokens, and takes scores, all within the
test."""

from __future__ import annotations

import json
import secrets
import tempfile
import time
from functools import cache
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import httpx
import jwt
from cryptography.hazmat.primitives.asymmetric import rsa
from jwt.algorithms import RSAAlgorithm
from site_client import Client

from coursework.platforms.lti.keys import KeyFolder
from coursework.platforms.lti.settings import LTIPlatform

LTI = "https://purl.imsglobal.org/spec/lti/claim/"
DEEP = "https://purl.imsglobal.org/spec/lti-dl/claim/"
AGS = "https://purl.imsglobal.org/spec/lti-ags/"
NRPS = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice"
MEMBER = "http://purl.imsglobal.org/vocab/lis/v2/membership#"
SITE, TOOL, CLIENT, DEPLOYMENT = "https://learn.example.org", "https://tool.example.org", "client-7", "3"
ENGLISH = {"Accept-Language": "en"}
SCOPES = [f"{AGS}scope/score", f"{AGS}scope/lineitem"]
STUDENT, TEACHER = [f"{MEMBER}Learner"], [f"{MEMBER}Instructor"]

_KEYS = [rsa.generate_private_key(public_exponent=65537, key_size=2048) for _ in range(3)]

PLATFORM = LTIPlatform(
    "learn",
    SITE,
    CLIENT,
    (DEPLOYMENT,),
    f"{SITE}/auth",
    f"{SITE}/token",
    f"{SITE}/jwks",
    origins=("https://frames.example.org",),
)


def jwk(key, kid):
    return {**RSAAlgorithm.to_jwk(key.public_key(), as_dict=True), "kid": kid, "alg": "RS256", "use": "sig"}


class FakePlatform:
    """Answers what the tool asks; ``down`` is what it answers instead, while it is set."""

    def __init__(self):
        self.private, self.kid = _KEYS[0], "one"
        self.published = {"one": _KEYS[0]}
        self.down = 0
        self.asked = []  #: what was asked, method and path
        self.scores = []  #: as they came
        self.tokens = {}
        self.lines = []
        self.members = []
        self.tool_keys = None  #: a function that gives the keys that the tool publishes

    @property
    def client(self):
        return httpx.Client(transport=httpx.MockTransport(self.answer))

    def asked_for(self, path):
        return sum(one.endswith(path) for one in self.asked)

    def rotate(self, number=1):
        self.kid, self.private = f"key-{number}", _KEYS[number]
        self.published = {self.kid: self.private}

    def answer(self, request):
        path = request.url.path
        self.asked.append(f"{request.method} {path}")
        if self.down:
            if self.down == -1:
                raise httpx.ConnectError("no way", request=request)
            return httpx.Response(self.down)
        if path == "/jwks":
            return httpx.Response(200, json={"keys": [jwk(key, kid) for kid, key in self.published.items()]})
        if path == "/token":
            return self._token(parse_qs(request.content.decode()))
        scopes = self.tokens.get(request.headers.get("authorization", "").removeprefix("Bearer "))
        if scopes is None:
            return httpx.Response(401)
        if path.endswith("/scores"):
            return self._score(json.loads(request.content), request, scopes)
        if path == "/lines":
            return self._line(request)
        if path == "/members":
            return self._roster(request)
        return httpx.Response(404)

    def _token(self, told):
        assertion = told["client_assertion"][0]
        kid = jwt.get_unverified_header(assertion)["kid"]
        stated = next((one for one in self.tool_keys()["keys"] if one["kid"] == kid), None)
        if stated is None:
            return httpx.Response(401)
        claims = jwt.decode(assertion, jwt.PyJWK(stated).key, algorithms=["RS256"], audience=f"{SITE}/token")
        assert claims["iss"] == claims["sub"] == CLIENT
        token = secrets.token_hex(8)
        self.tokens[token] = told["scope"][0].split()
        return httpx.Response(200, json={"access_token": token, "token_type": "Bearer", "expires_in": 3600})

    def _score(self, told, request, scopes):
        assert request.headers["content-type"] == "application/vnd.ims.lis.v1.score+json"
        assert f"{AGS}scope/score" in scopes
        last = [one["timestamp"] for one in self.scores if one["userId"] == told["userId"]]
        if last and told["timestamp"] <= max(last):
            return httpx.Response(409)
        self.scores.append({**told, "line": str(request.url)})
        return httpx.Response(200)

    def _line(self, request):
        if request.method == "GET":
            wanted = request.url.params.get("resource_link_id")
            return httpx.Response(200, json=[one for one in self.lines if one["resourceLinkId"] == wanted])
        made = {**json.loads(request.content), "id": f"{SITE}/lines/{len(self.lines) + 1}?of=7"}
        self.lines.append(made)
        return httpx.Response(201, json=made)

    def _roster(self, request):
        page, size = int(request.url.params.get("Page", 0)), 2
        links = (
            {"Link": f'<{SITE}/members?Page={page + 1}>; rel="next"'}
            if (page + 1) * size < len(self.members)
            else {}
        )
        return httpx.Response(
            200, json={"members": self.members[page * size : (page + 1) * size]}, headers=links
        )

    # -------------------------------------------------------------------- launches

    def claims(self, nonce, **changed):
        """Those of a student's launch; a claim that is None is left out."""
        now = int(time.time())
        told = {
            "iss": SITE,
            "aud": CLIENT,
            "sub": "ada",
            "iat": now,
            "exp": now + 300,
            "nonce": nonce,
            "name": "Ada Byron",
            f"{LTI}message_type": "LtiResourceLinkRequest",
            f"{LTI}version": "1.3.0",
            f"{LTI}deployment_id": DEPLOYMENT,
            f"{LTI}target_link_uri": f"{TOOL}/lti/launch",
            f"{LTI}roles": STUDENT,
            f"{LTI}resource_link": {"id": "link-1", "title": "Week 3"},
            f"{LTI}context": {"id": "course-1", "title": "Mechanics"},
            f"{LTI}launch_presentation": {"locale": "en_GB"},
            f"{LTI}custom": {"exercise": "slotted_mechanism"},
            f"{AGS}claim/endpoint": {
                "scope": SCOPES,
                "lineitem": f"{SITE}/lines/9?of=7",
                "lineitems": f"{SITE}/lines",
            },
            NRPS: {"context_memberships_url": f"{SITE}/members", "service_versions": ["2.0"]},
        }
        named = {
            name if ":" in name or name in (*told, "email") else f"{LTI}{name}": value
            for name, value in changed.items()
        }
        return {name: value for name, value in {**told, **named}.items() if value is not None}

    def signed(self, claims, **headers):
        return jwt.encode(claims, self.private, "RS256", headers={"kid": self.kid, **headers})


class Visitor:
    """A browser that follows links from the platform."""

    def __init__(self, app, platform, base="/lti"):
        self.platform, self.base = platform, base
        self.browser = Client(app, base_url=TOOL, headers=ENGLISH)

    def login(self, **changed):
        """What the tool asks the platform for: the parameters of the authentication request."""
        told = {
            "iss": SITE,
            "login_hint": "ada",
            "target_link_uri": f"{TOOL}/lti/launch",
            "client_id": CLIENT,
            **changed,
        }
        answer = self.browser.get(f"{self.base}/login", params=told)
        assert answer.status_code == 302, answer.text
        assert answer.headers["location"].startswith(f"{SITE}/auth?")
        return {
            name: values[0] for name, values in parse_qs(urlsplit(answer.headers["location"]).query).items()
        }

    def told(self, sign=None, **changed):
        """What the browser brings back from the platform after a login; ``sign`` makes the token of the
        claims."""
        asked = self.login()
        token = (sign or self.platform.signed)(self.platform.claims(asked["nonce"], **changed))
        return {"state": asked["state"], "id_token": token}

    def returned(self, told):
        """The tool's answer to what a browser brings back."""
        return self.browser.post(f"{self.base}/launch", data=told)

    def launch(self, *, sign=None, **changed):
        """The tool's answer to a launch."""
        return self.returned(self.told(sign, **changed))

    def enter(self, **changed):
        """The first page after a launch, and its path."""
        answer = self.launch(**changed)
        assert answer.status_code == 303, answer.text
        path = urlsplit(answer.headers["location"]).path
        return self.browser.get(path), path

    def hand_in(self, path, page, answers, **more):
        fields = {"_seal": seal(page.text), "_number": field(page.text, "_number"), **answers, **more}
        return self.browser.post(path, data=fields)


def field(html, name):
    return html.split(f'name="{name}" value="')[1].split('"')[0]


def seal(html):
    return field(html, "_seal")


@cache
def _made_keys():
    """A folder with a key of the tool, made once."""
    folder = Path(tempfile.mkdtemp()) / "keys"
    KeyFolder(folder).new()
    return folder
