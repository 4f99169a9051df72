"""Structure of a mechanism: solution. Count the bodies and the pairs; the formulas do the rest."""

from coursework.quantities.columns import each
from coursework.solution import given, mistake
from coursework.structure.joints import FRAME, JointGraph, copied
from coursework.structure.library import LIBRARY
from coursework.structure.numbered import to_count
from coursework.structure.picture import kinematic_graph

STRUCTURES = ("joints",)


def joints(mechanism):
    """The list of the statement."""
    return each(lambda number: copied(to_count(int(number))), mechanism)


def _graph(joints):
    return each(JointGraph.of, joints)


def n(_graph):
    """Bodies but the frame."""
    return each(lambda graph: len(graph.moving), _graph, dtype=int)


def b(_graph):
    """Pivots and slides, a pivot of k bodies as k - 1."""
    return each(lambda graph: graph.counts.b, _graph, dtype=int)


def h(_graph):
    """Contacts at a point or along a line."""
    return each(lambda graph: graph.counts.h, _graph, dtype=int)


def w(n, b, h):
    return 3 * n - 2 * b - h


def L(b, h):
    return b + h


def N(n):
    return n + 1


def gamma(L, N):
    return L - N + 1


@mistake("n", "N")
def frame_counted(N):
    return N, N


@mistake("N", kind="count")
def notes_N_without_frame(n):
    return n


@mistake("b")
def multiple_pivot_once(_graph):
    return each(lambda graph: sum(j.kind != "higher" for j in graph.joints), _graph, dtype=int)


@mistake("b")
def multiple_pivot_as_many_as_bodies(_graph):
    """k bodies on a pivot taken for k pairs."""

    def count(graph):
        return sum(j.pairs + (len(j.bodies) > 2) for j in graph.joints if j.kind != "higher")

    return each(count, _graph, dtype=int)


@mistake("b")
def slides_forgotten(_graph):
    return each(lambda graph: sum(j.pairs for j in graph.joints if j.kind == "revolute"), _graph, dtype=int)


@mistake("b", "h")
def kinds_exchanged(b, h):
    return h, b


@mistake("w")
def higher_as_lower(n, b, h):
    return 3 * n - 2 * (b + h)


@mistake("w")
def higher_left_out(n, b):
    return 3 * n - 2 * b


@mistake("gamma", kind="count")
def joint_count_minus(L, N):
    return L - N


def figure(joints):
    """The joint graph of the scheme."""
    return kinematic_graph(joints)


def residual(joints, n, b, h, w, gamma):
    """Bodies and pairs counted off the records; freedoms by cycles (each pair gives, each cycle takes three);
    cycles as the pairs that join what was joined already."""

    def differences(records, n, b, h, w, gamma):
        records = JointGraph.of(records).records()
        leaders = {FRAME: FRAME}

        def leader(body):
            while leaders.setdefault(body, body) != body:
                body = leaders[body]
            return body

        lower = higher = closing = 0
        for record in records:
            first, *others = record["between"]
            for other in others:
                lower += record["kind"] != "higher"
                higher += record["kind"] == "higher"
                one, two = leader(first), leader(other)
                closing += one == two
                leaders[one] = two
        wrong = (n - len(leaders) + 1, b - lower, h - higher, w - (lower + 2 * higher - 3 * closing))
        return float(any(wrong) or gamma != closing)

    return each(differences, joints, n, b, h, w, gamma, dtype=float)


def _known(figure, **counts):
    return given(joints=LIBRARY[figure].records()).gives(**counts)


KNOWN = (
    _known("figure_3", n=3, b=4, h=0, w=1, L=4, N=4, gamma=1),
    _known("figure_4", n=3, b=4, w=1, gamma=1),
    _known("figure_5", n=3, b=4, w=1, gamma=1),
    _known("figure_6_cam", n=2, b=2, h=1, w=1, L=3, N=3, gamma=1),
    _known("figure_8a_motor", n=1, b=1, h=0, w=1, L=1, N=2, gamma=0),
    # The notes print 7 - 5 + 1 = 3 cycles: they leave the frame out of N.
    _known("figure_13", n=5, b=7, h=0, w=1, L=7, N=6, gamma=2),
    _known("figure_14", n=7, b=10, h=0, w=1, L=10, N=8, gamma=3),
    # Three bodies on one pivot.
    _known("figure_27", n=5, b=7, h=0, w=1, L=7, N=6, gamma=2),
    given(
        joints=[
            {"between": [1, 2], "kind": "revolute", "at": "O"},
            {"between": [3, 4], "kind": "revolute", "at": "A"},
            {"between": [3, 2], "kind": "revolute", "at": "A"},
            {"between": [3, 1], "kind": "higher"},
            {"between": [4, 1], "kind": "prismatic"},
        ]
    ).gives(n=3, b=4, h=1, w=0, L=5, N=4, gamma=2),
)
