"""Platforms in a file, keys in a folder, roles that are mapped one by one, and the commands."""

import json
import os
import stat
import subprocess
import sys

import pytest
from lti_platform import PLATFORM
from site_linked import Linked
from tables import each_row

from coursework.cli import run
from coursework.errors import BadInput
from coursework.language.words import words
from coursework.platforms.lti import refusal
from coursework.platforms.lti.keys import KeyFolder
from coursework.platforms.lti.roles import Role, role_of
from coursework.platforms.lti.settings import Settings, as_toml, read_settings, with_platform
from coursework.site.lti import service

MEMBER = "http://purl.imsglobal.org/vocab/lis/v2/membership"
ABOVE = "http://purl.imsglobal.org/vocab/lis/v2/institution/person#"
SYSTEM = "http://purl.imsglobal.org/vocab/lis/v2/system/person#"


@each_row(
    ("stated", "role"),
    [
        ([f"{MEMBER}#Learner"], Role.STUDENT),
        ([f"{MEMBER}#Instructor"], Role.INSTRUCTOR),
        ([f"{MEMBER}#ContentDeveloper"], Role.INSTRUCTOR),
        ([f"{MEMBER}#Administrator"], Role.ADMIN),
        ([f"{MEMBER}#Mentor"], Role.OBSERVER),
        ([f"{MEMBER}#Mentor", f"{MEMBER}#Learner"], Role.OBSERVER),
        ([f"{MEMBER}/Instructor#TeachingAssistant"], Role.ASSISTANT),
        ([f"{MEMBER}#Instructor", f"{MEMBER}/Instructor#TeachingAssistant"], Role.ASSISTANT),
        (["Learner"], Role.STUDENT),
        (["Instructor"], Role.INSTRUCTOR),
        ([f"{MEMBER}#Learner", f"{ABOVE}Student", f"{SYSTEM}User"], Role.STUDENT),
        ([f"{MEMBER}#Instructor", f"{SYSTEM}Administrator"], Role.INSTRUCTOR),
        ([f"{SYSTEM}Administrator"], Role.ADMIN),
        ([f"{ABOVE}Administrator"], Role.ADMIN),
        ([f"{MEMBER}#Learner", f"{ABOVE}Administrator"], Role.STUDENT),
        ([f"{MEMBER}#Member", f"{ABOVE}Administrator"], Role.NOBODY),
        ([f"{ABOVE}Instructor"], Role.NOBODY),  # a teacher, though not of this course
        ([f"{ABOVE}Student"], Role.NOBODY),
        ([f"{MEMBER}#Boss"], Role.NOBODY),
        (["urn:lti:role:ims/lis/Instructor"], Role.NOBODY),
        (["https://evil.example.org/membership#Instructor"], Role.NOBODY),
        ([f"{MEMBER}#instructor"], Role.NOBODY),
        ([], Role.NOBODY),
    ],
)
def test_roles_are_mapped_one_by_one_and_unknown_ones_give_nothing(stated, role):
    assert role_of(stated) is role


def test_who_may_what():
    assert [role for role in Role if role.sees_class] == [Role.INSTRUCTOR, Role.ASSISTANT, Role.ADMIN]
    assert [role for role in Role if role.picks] == [Role.INSTRUCTOR, Role.ADMIN]


# ----------------------------------------------------------------------- settings


def test_settings_are_read_as_they_were_written(tmp_path):
    told = with_platform(Settings(tmp_path, "https://tool.example.org", (), 7200.0), PLATFORM)
    (tmp_path / "platforms.toml").write_text(as_toml(told), "utf-8")
    assert read_settings(tmp_path) == told


def test_a_platform_that_is_told_again_takes_its_own_place():
    from dataclasses import replace

    once = with_platform(Settings(None), PLATFORM)
    assert with_platform(once, replace(PLATFORM, deployments=("8",))).platforms == (
        replace(PLATFORM, deployments=("8",)),
    )


@each_row(
    ("change", "said"),
    [
        (("client_id = ", "client = "), "no key 'client' in [[platforms]]; did you mean 'client_id'?"),
        (('auth_url = "https', 'auth_url = "http'), "plain http"),
        (('auth_url = "https://', 'auth_url = "'), "is an address such as"),
        (('deployments = ["3"]', "deployments = 3"), "deployments is a list"),
        (('deployments = ["3"]', "deployments = []"), "a platform needs deployments"),
        (("[service]", "[serivce]"), "no key 'serivce'"),
        (("[service]", "[service]\nsession_hours = 0"), "session_hours"),
        (("[[platforms]]", "[[platforms]"), "found [[platforms]"),
    ],
)
def test_what_makes_no_sense_is_told_with_its_line(tmp_path, change, said):
    text = as_toml(with_platform(Settings(tmp_path, "https://tool.example.org"), PLATFORM))
    assert change[0] in text
    (tmp_path / "platforms.toml").write_text(text.replace(*change), "utf-8")
    with pytest.raises(BadInput) as told:
        read_settings(tmp_path)
    assert said in str(told.value)
    assert "line" in str(told.value)


def test_of_two_clients_of_one_issuer_the_one_that_is_named_is_found():
    from dataclasses import replace

    other = replace(PLATFORM, client_id="client-8")
    settings = with_platform(with_platform(Settings(None), PLATFORM), other)
    assert settings.platform(PLATFORM.issuer, "client-8") == other
    assert settings.platform(PLATFORM.issuer) is None


# --------------------------------------------------------------------------- keys


@pytest.mark.skipif(os.name != "posix", reason="modes of files are POSIX's")
def test_private_keys_are_their_owner_s_alone(tmp_path):
    folder = KeyFolder(tmp_path / "keys")
    key = folder.new()
    assert folder.secret == folder.secret
    assert {stat.S_IMODE(path.stat().st_mode) for path in folder.folder.iterdir()} == {0o600}
    assert stat.S_IMODE(folder.folder.stat().st_mode) == 0o700
    key.path.chmod(0o640)
    with pytest.raises(BadInput, match="chmod 600"):
        _ = key.private


def test_the_key_that_signs_is_not_retired(tmp_path):
    folder = KeyFolder(tmp_path / "keys")
    first, second = folder.new(), folder.new()
    assert [key.kid for key in folder.keys] == [first.kid, second.kid]
    with pytest.raises(BadInput, match="rotate"):
        folder.retire(second.kid)
    with pytest.raises(BadInput, match="does not name exactly one key"):
        folder.retire("")
    assert folder.retire(first.kid).kid == first.kid


# ----------------------------------------------------------------------- commands


@pytest.fixture
def lti(tmp_path, monkeypatch, capsys):
    """The command in an empty folder: its status and what it says."""
    monkeypatch.chdir(tmp_path)

    def ran(*arguments):
        status = run(["lti", *arguments])
        told = capsys.readouterr()
        return status, told.out + told.err

    return ran


def test_a_platform_is_written_in_two_steps(lti, tmp_path):
    status, told = lti(
        "platform", "moodle", "https://moodle.example.org/", "--url", "https://tool.example.org"
    )
    assert status == 0
    for line in (
        "https://tool.example.org/launch",
        "https://tool.example.org/login",
        "https://tool.example.org/jwks",
    ):
        assert line in told
    status, _ = lti(
        "platform", "moodle", "https://moodle.example.org/", "--client-id", "abc", "--deployment", "1"
    )
    assert status == 0
    (platform,) = read_settings(tmp_path / "lti").platforms
    assert platform.issuer == "https://moodle.example.org"
    assert platform.auth_url == "https://moodle.example.org/mod/lti/auth.php"
    assert read_settings(tmp_path / "lti").url == "https://tool.example.org"
    status, told = lti("platform", "--json")
    assert json.loads(told)[0]["client_id"] == "abc"


def test_a_canvas_has_one_issuer_and_its_own_frames(lti, tmp_path):
    lti(
        "platform",
        "canvas",
        "https://school.instructure.com",
        "--client-id",
        "10000000000001",
        "--deployment",
        "1:a",
    )
    (platform,) = read_settings(tmp_path / "lti").platforms
    assert platform.issuer == "https://canvas.instructure.com"
    assert "https://school.instructure.com" in platform.frames


@each_row(
    ("arguments", "said"),
    [
        (["platform", "moddle", "https://x.example.org"], "did you mean 'moodle'?"),
        (["platform", "moodle"], "state its address"),
        (["platform", "moodle", "http://x.example.org"], "plain http"),
        (["platform", "moodle", "https://x.example.org", "--client-id", "1"], "--deployment"),
        (
            ["platform", "other", "https://x.example.org", "--client-id", "1", "--deployment", "1"],
            "--auth-url is missing",
        ),
        (["keys", "turn"], "keys takes list, new, rotate or retire"),
        (["keys", "retire"], "state the key"),
        (["keys", "retire", "abc"], "'abc' does not name exactly one key"),
        (["roster", "Mechanics"], "no database"),
    ],
)
def test_a_mistake_is_one_line(lti, arguments, said):
    status, told = lti(*arguments)
    assert status == 2
    assert said in told
    assert told.startswith("coursework: ")
    assert told.count("\n") == 1


def test_keys_are_made_rotated_and_listed(lti):
    assert lti("keys")[1].startswith("no key in")
    assert "signs from now on" in lti("keys", "new")[1]
    assert lti("keys", "new")[0] == 2
    assert lti("keys", "rotate")[0] == 0
    listed = json.loads(lti("keys", "--json")[1])
    assert [one["signs"] for one in listed] == ["", "yes"]
    assert lti("keys", "retire", listed[0]["key"])[0] == 0


def test_scores_that_wait_are_listed(lti, tmp_path):
    linked = Linked(tmp_path)
    db = ["--db", str(tmp_path / "site.db")]
    assert lti("scores", *db)[0] == 0
    visitor, page, path = linked.enter()
    visitor.hand_in(path, page, linked.right("Ada Byron"))
    status, told = lti("scores", "--send", *db)
    assert status == 1
    assert "Ada Byron" in told
    assert "no longer in the settings" in " ".join(told.split())
    assert lti("roster", *db)[1].startswith("Mechanics  (https://learn.example.org)")
    assert "0 courses begin with 'Statics'" in lti("roster", "Statics", *db)[1]
    assert "is no longer in" in lti("roster", "Mech", *db)[1]


def test_the_libraries_of_the_service_are_not_loaded_by_other_commands():
    code = "import sys; from coursework.cli import run; run(['list']); print('loaded', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    modules = set(done.stdout.rpartition("loaded ")[2].split())
    assert not modules & {
        "jwt",
        "cryptography",
        "starlette",
        "uvicorn",
        "httpx",
        "coursework.cli.lti",
        "coursework.platforms.lti",
    }


# -------------------------------------------------------------------------- words


def test_every_refusal_has_its_sentence():
    import re
    from pathlib import Path

    homes = Path(refusal.__file__).parent, Path(service.__file__).parent
    used = {
        why
        for home in homes
        for file in home.glob("*.py")
        for why in re.findall(r'LTIRefusal\(\s*"(\w+)"', file.read_text("utf-8"))
    }
    used |= {"expired", "not_yet", "audience", "issuer", "claim", "signature", "method", "page"}
    for lang in ("en", "fr"):
        assert used <= set(words(lang)["lti"]["refused"])
