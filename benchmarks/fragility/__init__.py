"""Fragility of drums on one another, of the monolith of their size, of a trilith and of a frame,
with exact friction: who overturns, and by how much drums are shifted for good.

motions      near-fault motions of drawn magnitude, distance and peak velocity
structures   the structures, of rigid bodies and of elastic ones
run          their analyses, a study each
report       fragility surfaces over PGV and pulse period, drums beside the monolith
figure       their figure
"""
