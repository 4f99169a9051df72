"""The joint graph: solution. Each pair of the scheme is an edge; vertices, edges and cycles are counted on
it."""

from coursework.quantities.columns import each
from coursework.solution import given, mistake
from coursework.structure.joints import FRAME, JointGraph, PlaneJoint, copied
from coursework.structure.library import LIBRARY
from coursework.structure.numbered import to_count
from coursework.structure.picture import kinematic_graph

STRUCTURES = ("joints",)


def joints(mechanism):
    """The list of the scheme's joints."""
    return each(lambda number: copied(to_count(int(number))), mechanism)


def _graph(joints):
    return each(JointGraph.of, joints)


def graph(_graph):
    """The edges in one text; a shared pivot with all its bodies."""
    return each(lambda graph: graph.text, _graph, dtype=str)


def N(_graph):
    """Vertices: all bodies."""
    return each(lambda graph: len(graph.bodies), _graph, dtype=int)


def L(_graph):
    """Edges: all pairs, a pivot of k bodies as k - 1."""
    return each(lambda graph: graph.counts.L, _graph, dtype=int)


def gamma(L, N):
    return L - N + 1


def _text(joints):
    return JointGraph(tuple(joints)).text


@mistake("graph", "L")
def every_pair_of_a_shared_pivot(_graph):
    """k bodies on a pivot taken for a joint of each two."""

    def joints(graph):
        for joint in graph.joints:
            bodies = joint.bodies
            yield from (PlaneJoint((a, b), joint.kind) for n, a in enumerate(bodies) for b in bodies[n + 1 :])

    texts = each(lambda graph: _text(joints(graph)), _graph, dtype=str)
    return texts, each(lambda graph: len(list(joints(graph))), _graph, dtype=int)


@mistake("graph")
def slides_as_pivots(_graph):
    def turned(graph):
        return _text(j._replace(kind="revolute") if j.kind == "prismatic" else j for j in graph.joints)

    return each(turned, _graph, dtype=str)


@mistake("graph")
def contacts_as_pivots(_graph):
    def turned(graph):
        return _text(j._replace(kind="revolute") if j.kind == "higher" else j for j in graph.joints)

    return each(turned, _graph, dtype=str)


@mistake("graph", "L", "N")
def frame_left_out(_graph):
    """The frame taken for no body: its joints are lost, or join only those that it holds."""

    def inner(graph):
        kept = [j._replace(bodies=tuple(b for b in j.bodies if b != FRAME)) for j in graph.joints]
        return [j for j in kept if len(j.bodies) > 1] or list(graph.joints)

    texts = each(lambda graph: _text(inner(graph)), _graph, dtype=str)
    pairs = each(lambda graph: sum(j.pairs for j in inner(graph)), _graph, dtype=int)
    return texts, pairs, each(lambda graph: len(graph.moving), _graph, dtype=int)


@mistake("L")
def shared_pivot_once(_graph):
    return each(lambda graph: len(graph.joints), _graph, dtype=int)


@mistake("L")
def only_lower_pairs(_graph):
    return each(lambda graph: graph.counts.b, _graph, dtype=int)


@mistake("N", kind="count")
def notes_N_without_frame(N):
    return N - 1


@mistake("gamma", kind="count")
def joint_count_minus(L, N):
    return L - N


def figure(joints):
    """The joint graph of the scheme."""
    return kinematic_graph(joints)


def residual(joints, graph, N, L, gamma):
    """The text taken apart again: its joints are the records', and its edges close as many cycles as are
    counted."""

    def wrong(records, text, N, L, gamma):
        left = [(set(r["between"]), r["kind"]) for r in JointGraph.of(records).records()]
        clusters, edges, closing = [], 0, 0
        for word in text.split(", "):
            names, kind = word.split()
            bodies = [int(name) for name in names.split("-")]
            if (set(bodies), kind) not in left:
                return 1.0
            left.remove((set(bodies), kind))
            edges += len(bodies) - 1
            touched = [c for c in clusters if c & set(bodies)]
            closing += sum(len(c & set(bodies)) - 1 for c in touched)
            clusters = [c for c in clusters if c not in touched] + [set(bodies).union(*touched)]
        return float(bool(left) or clusters != [set(range(1, N + 1))] or edges != L or closing != gamma)

    return each(wrong, joints, graph, N, L, gamma, dtype=float)


def _known(figure, **found):
    return given(joints=LIBRARY[figure].records()).gives(**found)


KNOWN = (
    _known("figure_3", graph="1-2 revolute, 1-4 revolute, 2-3 revolute, 3-4 revolute", N=4, L=4, gamma=1),
    _known("figure_6_cam", graph="1-2 revolute, 1-3 prismatic, 2-3 higher", N=3, L=3, gamma=1),
    # The notes print 7 - 5 + 1 = 3 cycles: they leave the frame out of N.
    _known("figure_13", N=6, L=7, gamma=2),
    _known("figure_14", N=8, L=10, gamma=3),
    # Three bodies on one pivot.
    _known(
        "figure_27",
        N=6,
        L=7,
        gamma=2,
        graph="1-2 revolute, 1-4 revolute, 1-6 prismatic, 2-3 revolute, 3-4-5 revolute, 5-6 revolute",
    ),
)
