"""Assour groups: solution. Take the driver away, then the smallest sets that their pairs hold, one after
another."""

from functools import lru_cache

from coursework.quantities.columns import each
from coursework.solution import given, mistake
from coursework.structure import assour
from coursework.structure.joints import FRAME, JointGraph, copied
from coursework.structure.library import LIBRARY
from coursework.structure.numbered import last_body, to_decompose
from coursework.structure.picture import kinematic_graph

STRUCTURES = ("joints", "driver", "groups")
SYMBOLS = {"body": "j"}
_HIGHEST = 4  #: class among the choices

_decompose = lru_cache(maxsize=8192)(assour.decompose)


def joints(mechanism):
    """The list of the statement."""
    return each(lambda number: copied(to_decompose(int(number)).joints), mechanism)


def driver(mechanism):
    """The frame and the body that it drives."""
    return each(lambda number: to_decompose(int(number)).driver, mechanism)


def _graph(joints):
    return each(JointGraph.of, joints)


def body(_graph, driver):
    """The body that the statement names: the last one that is not driven."""
    return each(last_body, _graph, driver, dtype=int)


def groups(_graph, driver):
    """Records of the bodies and the class of each group, in the order of assembly."""
    return each(lambda graph, pair: _records(_decompose(graph, pair).groups), _graph, driver)


def group_count(groups):
    return each(len, groups, dtype=int)


def group_size(groups, body):
    """Number of bodies in the named body's group; 1 for the driver alone."""
    return each(lambda found, one: len(_group(found, one)["bodies"]), groups, body, dtype=int)


def group_class(groups, body):
    return each(lambda found, one: _group(found, one)["class"], groups, body, dtype=str)


def assour_class(groups):
    """Class of the highest group; I where there is none."""
    return each(lambda found: assour.roman(max(map(_rank, found), default=1)), groups, dtype=str)


def _records(groups):
    return tuple({"bodies": list(group.bodies), "class": group.class_name} for group in groups)


def _group(found, body):
    alone = {"bodies": [body], "class": "I"}
    return next((record for record in found if body in record["bodies"]), alone)


def _rank(record):
    return _RANKS[record["class"]]


_RANKS = {assour.roman(rank): rank for rank in range(1, 40)}


def _named(rank):
    """A class among the choices."""
    return assour.roman(min(max(rank, 1), _HIGHEST))


@mistake("groups")
def not_taken_apart(_graph, driver):
    """All that is left of the driver as one group."""

    def whole(graph, pair):
        placed = set(pair)
        rest = tuple(body for body in graph.bodies if body not in placed)
        rank = min(assour.class_of(graph, rest, placed), _HIGHEST)
        return _records([assour.AssourGroup(rest, rank)])

    return each(whole, _graph, driver)


@mistake("driver")
def other_driver(_graph, driver):
    """Another body joined to the frame taken for the driver, where one can be."""

    def another(graph, pair):
        for body in assour.drivers(graph):
            if body not in pair and _drives(graph, body):
                return FRAME, body
        return pair

    return each(another, _graph, driver)


def _drives(graph, body):
    try:
        return _decompose(graph, (FRAME, body)).rank <= _HIGHEST
    except assour.Undefined:
        return False


@mistake("groups")
def multiple_pivot_as_ternary(_graph, driver):
    """Each pair of a shared pivot taken for a corner of its own."""

    def ranks(graph, pair):
        placed, found = set(pair), []
        for group in _decompose(graph, pair).groups:
            known = placed | set(group.bodies)
            corners = [
                sum(len(known & set(joint.bodies)) - 1 for joint in graph.joints_of(body))
                for body in group.bodies
            ]
            found.append(assour.AssourGroup(group.bodies, min(max(group.rank, *corners), _HIGHEST)))
            placed = known
        return _records(found)

    return each(ranks, _graph, driver)


@mistake("group_class", "assour_class")
def class_by_bodies(groups, body):
    """The class taken for the number of bodies."""
    sizes = each(
        lambda found: _named(max(len(r["bodies"]) for r in found) if found else 1), groups, dtype=str
    )
    own = each(lambda found, one: _named(len(_group(found, one)["bodies"])), groups, body, dtype=str)
    return own, sizes


@mistake("group_count", kind="count")
def driver_as_group(group_count):
    return group_count + 1


@mistake("group_class", "assour_class")
def frame_in_the_loop(_graph):
    """The longest loop of the whole mechanism, frame and driver among its sides."""

    def sides(graph):
        return _named(assour.longest_loop([set(joint.bodies) for joint in graph.joints], graph.bodies))

    found = each(sides, _graph, dtype=str)
    return found, found


@mistake("assour_class")
def lowest_group(groups):
    return each(lambda found: assour.roman(min(map(_rank, found), default=1)), groups, dtype=str)


def figure(joints):
    """The joint graph of the scheme."""
    return kinematic_graph(joints)


def residual(_graph, driver, groups):
    """Every body but frame and driver in one group; each group held by its pairs, three conditions a body
    halved into pairs, and no part of it held alone."""

    def wrong(graph, pair, found):
        placed, seen = set(pair), []
        for record in found:
            own = record["bodies"]
            seen += own
            if 2 * _held(graph, own, placed) != 3 * len(own):
                return 1.0
            if any(2 * _held(graph, [x for x in own if x != b], placed) >= 3 * (len(own) - 1) for b in own):
                return 1.0
            placed.update(own)
        return float(sorted(seen) != [b for b in graph.bodies if b not in pair])

    return each(wrong, _graph, driver, groups, dtype=float)


def _held(graph, own, placed):
    total = 0
    for joint in graph.joints:
        inside, outside = set(joint.bodies) & set(own), set(joint.bodies) & set(placed)
        total += len(inside) - (not outside) if inside else 0
    return total


def _known(figure, driven, **classes):
    return given(joints=LIBRARY[figure].records(), driver=[1, driven]).gives(**classes)


KNOWN = (
    _known("figure_3", 2, group_count=1, group_size=2, group_class="II", assour_class="II"),
    _known("figure_8a_motor", 2, group_count=0, assour_class="I"),
    _known("figure_8b_engine", 2, assour_class="II"),
    _known("figure_8c_shaper", 2, group_count=1, group_size=4, assour_class="III"),
    _known("figure_8d", 2, group_count=1, group_size=4, group_class="IV", assour_class="IV"),
    _known("figure_13", 2, group_count=2, assour_class="II"),
    # The driver chosen changes the class.
    _known("figure_14", 2, group_count=3, assour_class="II"),
    _known("figure_14", 4, group_count=3, assour_class="II"),
    _known("figure_14", 5, group_count=2, group_size=2, group_class="II", assour_class="III"),
    _known("figure_27", 2, group_count=2, assour_class="II"),
)
