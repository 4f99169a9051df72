"""The numeric core: plane linkages from their numbers, one configuration or a million.

Plane xy, x to the right, angles in radians from +x, anticlockwise positive; lengths in one common
unit; points are complex numbers. Every argument is a scalar or an array and all broadcast. A
function computes what it is asked for and nothing beyond: rates only when rates are asked.

``four_bar``      the cranked four-bar: positions, rates, accelerations, jerks, transmission angle
``slider_crank``  the same for the slider-crank, with strokes and quick return
``slotted_guide`` a crank pin in a turning slot
``dyads``         the Assour groups RRR, RRP, RPR, PRP, RPP in any orientation, and the drivers
``chains``        any closed chain, by Newton's method with a certificate
``cycle``         turning points over one turn
``rocker_slider`` a slider moved by the rocker of a four-bar: where it turns back
``cams``          laws of motion of a follower: rise, dwell, return
``triangles``     sides and angles, of flat triangles too

They rest on ``angles`` (crank angles as exact sines and cosines), ``elementary`` (tangent and arctangent,
fast on every processor), ``margins`` and ``closing`` (by how much a loop closes, without rounding),
``vectors``, ``scaling`` (exact powers of two) and ``blocks`` (long arrays in pieces that fit the cache).
"""
