"""Links of a folder that others filled: whatever reads a folder reads nothing outside of it, and quotes
nothing of it."""

import csv
import io
import json
import os
import shutil
import zipfile

import click
import pytest

from coursework import cli
from coursework.cli.options import FilePath
from coursework.database.store import Store
from coursework.errors import BadInput
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import find, read_file
from coursework.scanning.sources import scans
from coursework.system import links
from coursework.system.unzipping import unpack

SECRET = "root:x:0:0:planted"
ANSWERS = "student,exercise,seed,part,answer\n"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A folder that ``build`` wrote."""
    folder = tmp_path_factory.mktemp("links") / "built"
    assert cli.run(["build", "grashof", "--variants", "1", "--formats", "ipynb", "--out", str(folder)]) == 0
    return folder


@pytest.fixture
def folder(tmp_path):
    """A folder beside which a secret lies, with a link of each sort that leads to it; what may be read is
    ``good``."""
    outside, inside = tmp_path / "outside", tmp_path / "handed in"
    (outside / "deep").mkdir(parents=True)
    inside.mkdir()
    for place in (outside, outside / "deep"):
        for name in (
            "secret.csv",
            "secret.json",
            "secret.ipynb",
            "secret.pdf",
            "secret.png",
            "secret.zip",
            "passwd",
        ):
            (place / name).write_text(f"{ANSWERS}{SECRET},{SECRET},1,{SECRET},{SECRET}\n")
    for ending in ("csv", "json", "ipynb", "pdf", "png", "zip"):
        (inside / f"straight.{ending}").symlink_to(outside / f"secret.{ending}")
        (inside / f"by passwd.{ending}").symlink_to(outside / "passwd")
        (inside / f"relative.{ending}").symlink_to(f"../outside/secret.{ending}")
        (inside / f"chain 1.{ending}").symlink_to(inside / f"chain 2.{ending}")
        (inside / f"chain 2.{ending}").symlink_to(outside / f"secret.{ending}")
        (inside / f"by folder.{ending}").symlink_to(f"door/secret.{ending}")
        (inside / f"nowhere.{ending}").symlink_to(inside / f"nothing.{ending}")
        (inside / f"ring.{ending}").symlink_to(inside / f"ring.{ending}")
    (inside / "door").symlink_to(outside)
    (inside / "up").symlink_to("..")
    return inside


def everything_in(folder):
    """The text of all files below a folder."""
    return "\n".join(
        p.read_text("utf-8", "replace") for p in folder.rglob("*") if p.is_file() and not p.is_symlink()
    )


# ---------------------------------------------------------------------------- commands

#: What a command does with a folder that it takes: walks it and reads what others put there; reads files of
#: known names in it; writes it; or takes what runs or stands for the person's own work: a course, which is
#: code, a list of platforms.
WALKS, READS, WRITES, OWN = "walks", "reads", "writes", "own"
FOLDERS = {
    "grade submissions": WALKS,
    "scan scans": WALKS,
    "report folder": READS,
    "gradebook marks": READS,
    "database restore folder": READS,
    "database dump folder": WRITES,
    "new folder": WRITES,
    "progress folder": OWN,
}


def folders_of_commands():
    """What commands take that may be a folder which somebody else filled: by the command's and its own
    name."""

    def all_of(group, names=()):
        context = click.Context(group)
        for name in group.list_commands(context):
            one = group.get_command(context, name)
            if isinstance(one, click.Group):
                yield from all_of(one, (*names, name))
            else:
                yield " ".join((*names, name)), one

    for name, command in all_of(cli.commands):
        for one in command.params:
            if isinstance(one, click.Argument) and isinstance(one.type, FilePath) and one.type.dir_okay:
                yield f"{name} {one.name}"


def test_each_command_that_takes_a_folder_is_tried_here():
    """A new command needs its line in FOLDERS; where it walks or reads what others wrote, its trial below."""
    assert sorted(folders_of_commands()) == sorted(FOLDERS)


def test_a_report_reads_no_marks_out_of_its_folder(folder, capfd):
    for name in ("marks.csv", "summary.csv", "rejected.csv"):
        own = folder.parent / f"marks with {name}"
        own.mkdir()
        (own / "marks.csv").write_text("student,exercise,seed,part,verdict,points,out_of\n")
        (own / name).unlink(missing_ok=True)
        (own / name).symlink_to(folder.parent / "outside" / "secret.csv")
        assert cli.run(["report", str(own)]) != 0
        told = "".join(capfd.readouterr())
        assert (name in told, links.LEADS_OUT in told, SECRET in told) == (True, True, False)


def test_a_gradebook_is_filled_from_its_folder_alone(folder, tmp_path, capfd):
    (tmp_path / "marks").mkdir()
    (tmp_path / "marks" / "summary.csv").symlink_to(folder.parent / "outside" / "secret.csv")
    out = str(tmp_path / "out.xml")
    assert cli.run(["gradebook", "moodle", str(tmp_path / "marks"), "--item", "x", "--out", out]) != 0
    told = "".join(capfd.readouterr())
    assert ("summary.csv" in told, links.LEADS_OUT in told, SECRET in told) == (True, True, False)


def test_a_dump_is_restored_from_its_folder_alone(folder, tmp_path, capfd):
    db, made = f"sqlite:///{tmp_path}/a.db", tmp_path / "dump"
    Store(db).close()
    assert cli.run(["database", "dump", db, str(made)]) == 0
    for path in sorted(made.iterdir()):
        kept = path.rename(tmp_path / "kept")
        path.symlink_to(folder.parent / "outside" / "secret.csv")
        assert cli.run(["database", "restore", str(made), f"sqlite:///{tmp_path}/b.db"]) != 0
        told = "".join(capfd.readouterr())
        assert (path.name in told, links.LEADS_OUT in told, SECRET in told) == (True, True, False)
        path.unlink()
        kept.rename(path)


@pytest.mark.parametrize("command", ["grade", "scan"])
def test_nothing_behind_a_link_is_told(command, built, folder, tmp_path, capfd):
    out = tmp_path / "out"
    cli.run([command, str(folder), "--issued", str(built / "issued.json"), "--out", str(out)])
    told = "".join(capfd.readouterr()) + everything_in(out)
    assert SECRET not in told
    assert "planted" not in told


@pytest.mark.parametrize("command", ["grade", "scan"])
def test_each_link_is_refused_by_its_name(command, built, folder, tmp_path):
    own = (built / "answers.csv").read_text("utf-8-sig").splitlines()
    (folder / "mine.csv").write_text("\n".join([own[0], f"Zoé{own[1]}1"]))
    out = tmp_path / "out"
    cli.run([command, str(folder), "--issued", str(built / "issued.json"), "--out", str(out)])
    rows = list(csv.DictReader(io.StringIO((out / "rejected.csv").read_text("utf-8-sig"))))
    refused = {
        os.path.basename(row.get("source") or row["file"]) for row in rows if links.LEADS_OUT in row["reason"]
    }
    assert {path.name for path in folder.iterdir() if path.is_symlink()} - refused == set()


def test_the_site_tells_nothing_of_a_link_in_an_archive(tmp_path):
    """An archive can hold links, and places above: a link becomes a file that holds its own name."""
    path, inside = tmp_path / "a.zip", tmp_path / "inside"
    with zipfile.ZipFile(path, "w") as archive:
        link = zipfile.ZipInfo("link.csv")
        link.external_attr = 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
    unpack(path, inside)
    assert not (inside / "link.csv").is_symlink()
    for name in ("../up.csv", "/etc/up.csv", "a/../../up.csv", "..\\up.csv", "C:\\up.csv"):
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(name, SECRET)
        with pytest.raises(BadInput):
            unpack(path, tmp_path / "other")
    assert not list(tmp_path.glob("up*"))


# ----------------------------------------------------------------------------- readers


def test_links_within_the_folder_are_followed(tmp_path):
    folder = tmp_path / "handed in"
    (folder / "below").mkdir(parents=True)
    (folder / "below" / "a.csv").write_text(ANSWERS + "Zoé,grashof,0,x,1\n")
    (folder / "b.csv").symlink_to("below/a.csv")
    (folder / "again").symlink_to("below")
    named = tmp_path / "named"
    named.symlink_to(folder)
    for given in (folder, named):
        rows = [row for found in find([given]) for row in read_file(found, [given])]
        assert [row.answer for row in rows if isinstance(row, AnswerRow)] == ["1", "1"]


def test_what_somebody_names_is_read_though_it_is_a_link(tmp_path):
    (tmp_path / "a.csv").write_text(ANSWERS + "Zoé,grashof,0,x,1\n")
    named = tmp_path / "b.csv"
    named.symlink_to("a.csv")
    assert [row.answer for found in find([named]) for row in read_file(found, [named])] == ["1"]


def swapped_for_link(path, target):
    path.unlink()
    path.symlink_to(target)


def swapped_for_folder(path, target):
    shutil.rmtree(path.parent)
    path.parent.symlink_to(target.parent)


def swapped_for_pipe(path, target):
    path.unlink()
    os.mkfifo(path)


@pytest.mark.parametrize("swap", [swapped_for_link, swapped_for_folder, swapped_for_pipe])
def test_what_becomes_a_link_behind_the_walk_is_not_read(tmp_path, swap):
    """Folders of an exchange are the students' own: what is looked at and what is read later may differ."""
    folder, secret = tmp_path / "handed in" / "zoe", tmp_path / "outside" / "a.csv"
    folder.mkdir(parents=True)
    secret.parent.mkdir()
    secret.write_text(f"{ANSWERS}{SECRET},x,1,x,1\n")
    (folder / "a.csv").write_text(ANSWERS + "Zoé,grashof,0,x,1\n")
    given = [folder.parent]
    (found,) = find(given)
    swap(folder / "a.csv", secret)
    (row,) = read_file(found, given)
    assert isinstance(row, Rejected)
    assert (row.reason, row.row) == (links.LEADS_OUT, {})


def test_a_time_beside_a_notebook_is_no_link(tmp_path):
    place = tmp_path / "submitted" / "zoe" / "week3"
    place.mkdir(parents=True)
    (tmp_path / "passwd").write_text(SECRET)
    (place / "timestamp.txt").symlink_to(tmp_path / "passwd")
    (place / "week3.ipynb").write_text(
        json.dumps({"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5})
    )
    rows = [
        row
        for found in find([tmp_path / "submitted"])
        for row in ([found] if isinstance(found, Rejected) else read_file(found, [tmp_path / "submitted"]))
    ]
    assert len(rows) > 1
    assert SECRET not in repr(rows)


def test_scans_are_digested_in_the_folder_alone(folder, tmp_path):
    found = scans([folder], tmp_path / "unpacked")
    assert found
    assert {one.fault for one in found} == {links.LEADS_OUT}
