"""Structure of plane mechanisms: the joint graph, independent of all lengths.

A mechanism is a list of joints, records ``{"between": [i, j], "kind": "revolute" | "prismatic" | "higher",
"at": label}``; bodies are numbered from 1, the frame is 1. Whole numbers and sets throughout: nothing is
rounded.

``joints``   the joint graph, its counts (mobility formula, independent cycles) and a basis of cycles
``assour``   Assour groups behind a driver, their classes, the class of the mechanism
``grashof``  the type of a four-bar, exact on the printed lengths
``growing``  mechanisms grown group by group from a whole number, the same for ever
``numbered`` those that exercises hand out, by number
``library``  the mechanisms of the course's figures
``picture``  the joint graph as a figure
``scheme``   the kinematic scheme as a figure: bars, plates, blocks, wheels, on a hatched frame
``layout``   where the joints of a scheme are drawn
``likeness`` whether a mechanism is one of the course's, under other numbers and letters
``columns``  functions of one mechanism, applied to many
"""

from coursework.structure.assour import AssourGroup, Decomposition, decompose
from coursework.structure.grashof import linkage_type
from coursework.structure.growing import GeneratedMechanism, grow
from coursework.structure.joints import FRAME, Counts, JointGraph, PlaneJoint
from coursework.structure.library import LIBRARY

__all__ = [
    "FRAME",
    "LIBRARY",
    "AssourGroup",
    "Counts",
    "Decomposition",
    "GeneratedMechanism",
    "JointGraph",
    "PlaneJoint",
    "decompose",
    "grow",
    "linkage_type",
]
