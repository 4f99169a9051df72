"""An exam is secret until it opens: who has the package, the course and every public word draws none of its
papers.

The student of these tests has the public package and all that she may know: the assignment's name, its
exercises, parts, fixed seeds and dates, the names and numbers of the class, and afterwards every sheet with
its code. What she lacks is the secret.
"""

import json
import re
import shutil
from itertools import combinations

import pytest
from secret_words import holds, spelled
from sweeps import whole_course

import coursework
from coursework.cli import run
from coursework.course.secrecy import Secret
from coursework.issuing.assignment import read_assignment
from coursework.issuing.issued import issued_content
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants

COURSE = coursework.open_course()
CLASS = [Student(f"Student {n}", columns={"number": str(4000 + n), "group": "AB"[n % 2]}) for n in range(4)]
ROSTER = "student,number\n" + "".join(f"{s.name},{s.columns['number']}\n" for s in CLASS)
SOME = ("slotted_mechanism", "closed_chain")
_LARGE = 1000  #: so many variants of an exercise that nobody meets one by luck


def stated(folder, names=SOME, head="", each=""):
    """An assignment's file, as the student guesses it but for the line of its secret."""
    folder.mkdir(parents=True, exist_ok=True)
    asked = "".join(f'\n[[exercises]]\nname = "{name}"\n{each}' for name in names)
    path = folder / "exam.toml"
    path.write_text(f'title = "Exam"\nmark = {{ of = 20, step = 0.5 }}\n{head}\n{asked}', "utf-8")
    return path


def papers(content):
    """What was issued, by student, exercise and sitting."""
    return {
        (item.get("student", k), item["record"]["exercise"], item.get("sitting", 1)): item["record"]
        for k, item in enumerate(content["issued"])
    }


def known_by_luck(name):
    """Whether an exercise has so few variants that two draws are often the same."""
    found = COURSE[name].draws.population(_LARGE * 20)
    return found is not None and found < _LARGE


def same(one, other):
    return one["given"] == other["given"]


def drawn_before(issued, guessed):
    """The papers that the student has drawn, of those that are issued; by luck she may have some of the
    smallest exercises."""
    mine, hers = papers(issued), papers(guessed)
    assert mine.keys() == hers.keys()
    return [place for place in mine if same(mine[place], hers[place]) and not known_by_luck(place[1])]


def solved_afterwards(issued):
    """The papers that the public package gives of the code that they print."""
    return [
        place
        for place, record in papers(issued).items()
        if not known_by_luck(record["exercise"])
        and same(COURSE[record["exercise"]].variant(record["seed"]).record, record)
    ]


def dealt(path, before=None, make_up=(), students=CLASS):
    """What an instructor, or the student at home, deals of a file; once and again into one folder."""
    assignment = read_assignment(path, COURSE)
    found = assign_variants(COURSE, assignment, students, ("en",), before, make_up)
    kept = [found.secret] if hasattr(found, "secret") else []
    return json.loads(json.dumps(issued_content(found.issues, assignment, *kept)))


# --------------------------------------------------------------------------- draws


@whole_course
def test_every_exercise_is_drawn_by_the_secret(tmp_path):
    """By its code the public package gives other values, in other orders of choices, and another secret gives
    others too."""
    one, other = Secret.new(), Secret.new()
    shared = []
    for name in (name for name in COURSE.names if not known_by_luck(name)):
        drawn = [COURSE[name].variants(range(8), "en", secret=s) for s in (one, other, None)]
        given = [{tuple(v.given.values()) for v in some} for some in drawn]
        if given[0] & given[1] or given[0] & given[2]:
            shared.append(name)
    assert shared == []
    part = next(p for p in COURSE["grashof"].spec.parts if p.choices)
    orders = [
        [v.cases(part) for v in COURSE["grashof"].variants(range(8), secret=s)] for s in (one, other, None)
    ]
    assert all(a != b for a, b in combinations(orders, 2))


@pytest.mark.slow
@pytest.mark.parametrize("name", COURSE.names)
def test_no_paper_of_an_exercise_is_drawn_before_it_opens_nor_by_its_code_afterwards(tmp_path, name):
    path = stated(tmp_path, [name])
    issued, guessed = (dealt(path, make_up=[CLASS[0].name], students=CLASS[:2]) for _ in range(2))
    assert drawn_before(issued, guessed) == []
    assert solved_afterwards(issued) == []


WAYS = {
    "each": ("", ""),
    "versions": ("versions = 2", ""),
    "one for all": ("versions = 1", ""),
    "a fixed seed": ("", "seed = 12\n"),
}


@pytest.mark.parametrize("way", WAYS)
def test_no_way_of_dealing_is_open_to_who_has_the_package(tmp_path, way):
    path = stated(tmp_path, SOME, *WAYS[way])
    both = []
    for _ in ("the instructor", "the student"):
        first = dealt(path, students=CLASS[:3])
        both.append(dealt(path, first, make_up=[CLASS[1].name]))  # and one who comes late
    assert drawn_before(*both) == []
    assert solved_afterwards(both[0]) == []


def test_letters_of_versions_are_dealt_by_the_secret(tmp_path):
    path = stated(tmp_path, ("grashof",), "versions = 4")
    many = [Student(f"Student {n}") for n in range(24)]

    def letters():
        return [item["version"] for item in dealt(path, students=many)["issued"]]

    one, other = letters(), letters()
    assert one != other
    assert {one.count(letter) for letter in "ABCD"} == {6}


def test_a_practice_build_of_the_same_class_is_none_of_an_exam(tmp_path):
    path = stated(tmp_path)
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    issued = papers(dealt(path))
    for seed in ("0", "12"):
        of = [*SOME, "--roster", str(tmp_path / "class.csv"), "--seed", seed, "--formats", "ipynb"]
        assert run(["build", *of, "--out", str(tmp_path / seed)]) == 0
        built = papers(json.loads((tmp_path / seed / "issued.json").read_text("utf-8")))
        assert [place for place in issued if same(issued[place], built[place])] == []


@pytest.mark.e2e
@pytest.mark.parametrize("platform", ["moodle", "qti3"])
def test_no_pool_of_a_platform_is_drawn_by_who_has_the_package(tmp_path, platform):
    path = stated(tmp_path)
    pools = []
    for who in ("instructor", "student"):
        of = [platform, str(path), "--variants", "3", "--lang", "en", "--out", str(tmp_path / who)]
        assert run(["export", *of]) == 0
        pools.append(json.loads((tmp_path / who / "issued.json").read_text("utf-8")))
    mine, hers = ([item["record"]["given"] for item in pool["issued"]] for pool in pools)
    assert [given for given in mine if given in hers] == []
    assert [
        r
        for r in (i["record"] for i in pools[0]["issued"])
        if same(COURSE[r["exercise"]].variant(r["seed"]).record, r)
    ] == []
    again = [platform, str(path), "--variants", "5", "--lang", "en", "--out", str(tmp_path / "instructor")]
    assert run(["export", *again]) == 0
    more = json.loads((tmp_path / "instructor" / "issued.json").read_text("utf-8"))
    assert all(item in more["issued"] for item in pools[0]["issued"])


def test_no_paper_of_a_link_is_drawn_by_who_has_the_package(tmp_path):
    from site_linked import Linked

    from coursework.database.tables import variant

    given = []
    for who in ("instructor", "student"):
        (tmp_path / who).mkdir()
        linked = Linked(tmp_path / who)
        linked.visitor().enter(custom={"exercise": SOME[0]})
        record = linked.one(variant.c.record)[-1].record
        given.append(record["given"])
        assert COURSE[record["exercise"]].variant(record["seed"]).record["given"] != record["given"]
    assert given[0] != given[1]


# ------------------------------------------------------------------ the same bytes


def test_the_same_file_gives_the_same_bytes_and_another_of_its_name_shares_nothing(tmp_path):
    names = {}
    for place in ("one", "other"):
        (tmp_path / place).mkdir()
        assert run(["new", "assignment", str(tmp_path / place / "exam.toml"), *SOME]) == 0
        names[place] = dealt(tmp_path / place / "exam.toml")
    assert names["one"] == dealt(tmp_path / "one" / "exam.toml")
    assert "secret" not in names["one"]  # the file has it
    assert drawn_before(names["one"], names["other"]) == []
    text = (tmp_path / "one" / "exam.toml").read_text("utf-8")
    shutil.copy(tmp_path / "one" / "exam.toml", tmp_path / "one" / "resit.toml")
    assert drawn_before(names["one"], dealt(tmp_path / "one" / "resit.toml")) == []
    assert re.search(r'^# .*\n# .*\nsecret = "[0-9a-f]{32}"$', text, re.MULTILINE)  # told in both languages


@pytest.mark.e2e
def test_a_file_without_a_secret_has_one_beside_it_and_goes_on_with_it(tmp_path, capsys):
    path = stated(tmp_path)
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    build = [
        "build",
        str(path),
        "--roster",
        str(tmp_path / "class.csv"),
        *"--formats ipynb --lang en".split(),
    ]
    assert run([*build, "--out", str(tmp_path / "exam")]) == 0
    kept = tmp_path / "exam" / "issued.json"
    first, said = kept.read_bytes(), capsys.readouterr()
    secret = json.loads(first)["secret"]
    assert "has no secret: one was created" in said.err
    assert secret not in said.err + said.out
    for more in ([], ["--overwrite"]):
        assert run([*build, *more, "--out", str(tmp_path / "exam")]) == 0
        assert kept.read_bytes() == first
        assert "secret" not in capsys.readouterr().err
    (tmp_path / "class.csv").write_text(ROSTER + "Late One,9999\n", "utf-8")
    assert run([*build, "--out", str(tmp_path / "exam"), "--make-up", CLASS[0].name]) == 0
    longer = json.loads(kept.read_bytes())
    assert longer["secret"] == secret
    assert papers(json.loads(first)).items() <= papers(longer).items()
    assert solved_afterwards(longer) == []


def test_what_was_issued_without_a_secret_goes_on_and_who_comes_later_has_one(tmp_path):
    """Of versions, the late ones have the paper of their letter."""
    from coursework.issuing.issuing import drawn_by

    path = stated(tmp_path, SOME, "versions = 2")
    letters = {s.name: "AB"[n % 2] for n, s in enumerate(CLASS)}
    old = {"format": 1, "roster": True, "assignment": read_assignment(path, COURSE).stated(), "issued": []}
    for name in SOME:
        found, _ = drawn_by("exam", COURSE[name], ["version A", "version B"], "en")
        old["issued"] += [
            {"student": s, "version": letter, "record": found[f"version {letter}"].record}
            for s, letter in letters.items()
        ]
    old["issued"].sort(key=lambda item: item["student"])
    assert dealt(path, old)["issued"] == old["issued"]
    assert "secret" not in dealt(path, old)
    longer = dealt(path, old, students=[*CLASS, Student("Late One")], make_up=[CLASS[0].name])
    assert papers(old).items() <= papers(longer).items()
    records = papers(longer)
    letter = next(item["version"] for item in longer["issued"] if item["student"] == "Late One")
    twin = next(s for s in letters if letters[s] == letter)
    for name in SOME:
        assert records["Late One", name, 1] == records[twin, name, 1]
        made = records[CLASS[0].name, name, 2]
        assert not same(COURSE[name].variant(made["seed"]).record, made)


# -------------------------------------------------------------------------- the file


@pytest.mark.parametrize(
    "line",
    [
        'secret = "abc"',
        'secret = "zz6c5d1f2a9e47388c1fd2b7a4e3905d"',
        "secret = 12",
        'secret = ""',
        'secret = "00000000000000000000000000000000"',
        'secret = ["0b6c5d1f2a9e47388c1fd2b7a4e3905d"]',
    ],
)
def test_a_malformed_secret_is_refused_with_its_line_and_is_not_quoted(tmp_path, line):
    with pytest.raises(coursework.CourseworkError) as fault:
        read_assignment(stated(tmp_path, head=line), COURSE)
    told = str(fault.value)
    assert "exam.toml, line 3: a secret is" in told
    assert not re.search(r"[0-9a-fz]{20}", told.partition("exam.toml")[2])


def test_no_text_of_an_assignment_shows_its_secret(tmp_path):
    head = 'secret = "0b6c5d1f2a9e47388c1fd2b7a4e3905d"'
    one = read_assignment(stated(tmp_path, head=head), COURSE)
    for text in (repr(one), str(one.secret), f"{one.secret!r}", json.dumps(one.stated())):
        assert not holds(text.encode(), spelled(head[10:42])), text


# ------------------------------------------------------------------- where it is not


HEAD = "0b6c5d1f2a9e47388c1fd2b7a4e3905d"


@pytest.mark.e2e
@pytest.mark.parametrize("in_file", [True, False])
def test_nothing_that_is_handed_out_or_only_marks_holds_the_secret(tmp_path, in_file):
    path = stated(tmp_path, SOME[:1], f'secret = "{HEAD}"' if in_file else "")
    (tmp_path / "class.csv").write_text("student,number\nZoe,1\nMax,2\n", "utf-8")
    out, asked = tmp_path / "exam", [str(path), "--roster", str(tmp_path / "class.csv"), "--lang", "en"]
    build = [
        "build",
        *asked,
        *"--formats pdf,ipynb,html,tex,nbgrader --with scan,booklet,no-polygons".split(),
    ]
    assert run([*build, "--out", str(out)]) == 0
    secret = json.loads((out / "issued.json").read_bytes()).get("secret", HEAD)
    assert (secret == HEAD) == in_file
    issued = ["--issued", str(out / "issued.json")]
    assert run(["grade", str(out / "answers.csv"), *issued, "--out", str(tmp_path / "marks")]) == 0
    assert run(["export", "gradescope", *issued, "--out", str(tmp_path / "gradescope")]) == 0
    for platform in ("moodle", "canvas", "stack"):
        export = ["export", platform, str(path), "--variants", "2", "--lang", "en"]
        assert run([*export, "--out", str(tmp_path / platform)]) == 0
    beside = [json.loads((tmp_path / p / "issued.json").read_bytes()) for p in ("moodle", "canvas", "stack")]
    secrets = {secret, *(content["secret"] for content in beside if "secret" in content)}
    ways = set().union(*map(spelled, secrets))
    files = [p for p in tmp_path.rglob("*") if p.is_file() and p != path]
    held = {p.relative_to(tmp_path).as_posix() for p in files if holds(p.read_bytes(), ways)}
    assert held == (set() if in_file else {f"{p}/issued.json" for p in ("exam", "moodle", "canvas", "stack")})
