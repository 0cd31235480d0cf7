"""Tolerances of contact and of the steps that use it: what each is measured by, what it means, and
why it has this size.

Lengths are over the width of the foot, so that a larger structure gives the same answer.
"""

# --- Contact problem of a step
# --------------------------------------------------------------------------------------------------
#: Gap under the present forces below which a point takes part in the contact problem: some times
#: what a change of force in a step moves a stiff foot by. All that a point costs grows with it; one
#: that is missed shows below the base and is taken in by the next iteration.
NEAR = 3e-6
#: Height over the base up to which a point's static displacement, and with it its gap, is found:
#: above what the base dips beside a point that carries.
CLOSE = 4e-5
#: Residual of the contact laws at which a step is solved: a thousandth of the elastic indentation
#: of a standing steel column.
SOLVED = 1e-11
#: Force over the strongest one that a residual may stand for, where that is less: the same
#: thousandth, which a stiff, light or short-stepped foot passes within a far shorter length.
FORCE_SHARE = 1e-3
#: Residual that is always small enough: 400 times the rounding of a position, so that a column
#: twenty times as high as wide reaches it.
EXACT = 1e-13
#: Residual to which a contact problem is solved, over that at which a step is: so that what the
#: motion adds to it may be as large as it is.
SHARP = 0.1
#: Residual of a contact problem that may still be used to go on from; above it the step has failed.
USABLE = 1e-9
#: Height of a face over another, over its larger side, from which on a joint of two sides has no
#: points, beside twice the way that its bodies make in the step: ten times what a body of any shape
#: falls in a step of 1e-3 s over its size, were it 5 mm small.
APART = 1e-2
#: Points up to which compliance is taken node by node; of more, whole lines of the gathered
#: compliance are beside each other in memory.
FEW_SIDES = 8
#: Iterations of a step: Newton takes two to five, more where points come and go.
ITERATIONS = 25
#: Iterations, and share of the last residual that is left, from which on a step has stalled: Newton
#: on the slips of feet that stand goes round and round, as in thin rings, whose points depend on
#: one another; then the other ways of the friction solver are tried.
STALLED, STALLED_BY = 4, 0.5

# --- Friction solver: steps of Newton, then other ways; found by trial on 10^5 problems of rocking
# columns ------------------------------------
#: Active sets of the frictionless problem that are tried: most are found within six.
ACTIVE_SETS = 20
#: Newton steps from a good guess, and without a better residual, after which another way is tried.
NEWTON_STEPS, NEWTON_STALLED = 25, 6
#: The same from frictionless forces, from where Newton finds its way late rather than never.
FAR_STEPS, FAR_STALLED = 60, 15
#: Points above which those that carry are solved for alone; iterations of an interior point before
#: Newton's first try, between two tries, and at most.
FEW_POINTS, INSIDE_FIRST, INSIDE_TURN, INSIDE_MOST = 4, 8, 4, 60
#: Compliance against a change of force in a Newton step from inside, over the softest point's own:
#: forces that W leaves open stay, others converge by this over their own compliance in a step.
GIVE = 1e-9
#: The same from a good guess, where Newton without it fails; growth of the residual in a step at
#: which it has: slips that depend on one another make W singular, as the three at a node of two
#: bodies beside each other on the ground, and forces without any bound then leave them as they are.
NEAR_GIVE, SINGULAR = 1e-7, 1e6
#: The same of the proximal point, its Newton steps and those without a better residual: stiff
#: bodies in many contacts, whose forces W hardly tells apart (1e-6), need some fifty.
HELD_GIVE, HELD_STEPS, HELD_STALLED = 1e-4, 200, 60
#: The same with slips frozen from solution to solution: points at most, of more a shorter step
#: costs less; solutions, of which one on 18 points needed 70; and iterations of the interior point
#: for each, some 25 but where rounding rules.
FROZEN_POINTS, FROZEN_TURNS, FROZEN_INSIDE = 40, 200, 60
#: Points of rigid bodies above which frozen slips are tried first, by levers, and the whole matrix
#: is never made: a solution by it takes seconds of a wall of thirty stones, a shorter step
#: hundredths.
MANY_POINTS = 150
#: Points taken in one by one at most, and times that each is let go again: problems of the soak
#: which no other way had solved needed 7 to 46.
ONE_BY_ONE, LET_GO = 60, 2
#: Share of the way to the boundary of the cones in an interior iteration, that below which it gets
#: no farther, and gap and residual, over the first ones, at which it is at its end: a point at the
#: brink of slip has force and slip of the size of the gap's root, 1e-10 of the first.
INSIDE_WAY, INSIDE_JAMMED, INSIDE_END = 0.9, 1e-4, 1e-20
#: Least share of the middle of the cones that an interior iteration aims at, and the length that
#: rounds the kink of |s_t|, over the mean length that is left to go: a hundredth hardly moves the
#: slip of any point that slides.
INSIDE_CENTRED, INSIDE_SMOOTH = 1e-4, 0.01
#: Sweeps of Gauss-Seidel: the first try, each next takes four times as many, and the largest.
SWEEPS_FIRST, SWEEPS_MOST = 50, 800

# --- Stick operator: how far a foot may move until its compliance is found anew
# -----------------------------------------------------------------
#: Rotation [rad] and horizontal way, within which the compliance of a foot changes by 1e-4 of
#: itself.
STICK_TURN, STICK_WAY = 1e-4, 5e-5
#: Several elastic bodies bend at their joints by more. Their operator serves within so many times
#: that turn and way, but tells only how forces change: displacement and laws are found where the
#: points are, so that a step's answer does not depend on when the operator was found. What an
#: iteration then leaves always lies the same way: it ends at this share of what is allowed, or one
#: iteration later. Where one leaves more than the last share of what the one before left, the
#: operator is found anew: as long as some eight iterations.
IN_PLACE_TURN, IN_PLACE_LEFT, IN_PLACE_SLOW = 10.0, 0.05, 0.3
#: Cosine of the angle between the normal of a face and the vertical from which on it is level.
LEVEL = 0.999999999
#: Rotation [rad] on a pad, whose springs are nearly all of the compliance and the same everywhere.
PAD_TURN = 5e-3
#: Compliance of a pad that yields over that of its springs in a step: what it bears then exceeds
#: its yield force by the settlement of one step over so many indentations, a millionth.
YIELDED_GIVES = 1e4
#: A foot that in one step moves by less than this share of the above will stay long enough for the
#: operator to pay.
STICK_STAYS = 0.2
#: Largest entry of a compliance times that of its inverse from which points that stand have no
#: stick operator: some move by fewer ways than they have, as those of a stone that bears on two.
#: Feet on their nodes have 1e2 to 1e5.
HARDLY_REGULAR = 1e9

# --- Bodies that do not deform
# --------------------------------------------------------------------------------------------------
#: Compliance of their contact points over the mobility of the body's points within a step, so that
#: many points share forces in one way only. In the step of a landing it stores a quarter of this
#: share of the kinetic energy that goes, whatever the step; below a body that weighs more it is
#: more by the ratio of the masses.
RIGID_GIVE = 1e-3

# --- Impact and end of slip
# --------------------------------------------------------------------------------------------------
#: Height at the start of a step above which a point that touches at its end has landed: far above
#: that to which laws are obeyed, far below any flight.
OPEN = 1e-8
#: Way by which a point comes down in a step to the surface, just at its end, that lands in the next
#: one: far above what points of a standing foot open and close by.
ARRIVES = 1e-5
#: Way of a sticking point within which it keeps its anchor to the last digit, so that stick does
#: not creep.
STUCK = 1e-10
#: Way of a point in a step above which it slides as part of the body: ten times the elastic slip of
#: a standing foot.
SLIDE = 1e-7
#: Share by which a friction force may miss Coulomb's limit and still be sliding: rounding of the
#: solver.
FULL_FRICTION = 1e-9
#: Residual velocity of an impact over the largest velocity of its points, and the least such
#: velocity [m/s], below which nothing moves.
IMPACT_SOLVED, IMPACT_LEAST = 1e-8, 1e-3
#: What a point gives against its impulse over its own mobility, in one solution of an impact after
#: the other: without it a stiff foot's many impulses are not unique. What the first one leaves
#: closing is up to 4e-2 of the approach below a heavy slab, 6e-4 at a column's foot; each further
#: one leaves as little of that. It ends where a solution changes velocities by less than this share
#: of the largest: without impulses where points land, at the ends of the step where slip ends. Of
#: 105 recorded impacts none then closes by more than 6e-4 of its approach.
IMPACT_GIVES, IMPACT_LEFT = (1e-4, 1e-4, 1e-5, 1e-5, 1e-5), 1e-4
#: What a solution by frozen slips may miss Coulomb's law by, over the largest velocity of the
#: points, or over that which the step's contact gives them where it is larger: momentum and the
#: cone are exact, and it takes energy, whatever it misses. And the share of that at which its
#: rounds end: nine of ten get there. Ended at the whole of it, a shaken temple column was 0.8 % off
#: at its third impact; so it is 2e-7.
IMPACT_MISSED, FROZEN_ENDS = 1e-3, 1e-2
#: Of impacts by frozen slips (`contact.frozen_slips`): rounds, Newton steps in one, searches along
#: a step. An impact of shaken drums that Newton alone does not solve takes ten rounds in the mean,
#: of 30 steps the first one, of one to ten the others. Share of what is still missed, of the
#: largest velocity at first, to which a round is solved; slope along a step, over that at its
#: start, at which a search ends.
FROZEN_ROUNDS, FROZEN_STEPS, FROZEN_SEARCHES = 12, 60, 30
#: Rounds more where slips go to and fro, in which they go half the way: of six made-up impacts
#: of 289 points of a wall five came to a thousandth with half ways from the fourth round on, one to
#: 4e-3; without, most stayed at a hundredth. Of the forces
#: of a step they go half the way from the second number of rounds on. What the laws of an impact of
#: more than MANY_POINTS may be missed by, over what they else are, where all rounds are spent.
FROZEN_MORE, FROZEN_HALVED, MANY_MISSED = 24, 4, 10.0
FROZEN_SHARE, FROZEN_SLOPE = 0.1, 0.2
#: Way along which slips are extrapolated in every second round, over that of the round, at most: of
#: 60 impacts of shaken elastic drums two are left to the slower ways, and seven without. One part
#: of it at least: chosen.
FROZEN_FARTHEST = 10.0
#: Share of the largest of a body's mobilities at its contact nodes below which columns of the
#: factor of the mobility are left out: rounding. Of 100 modes of a column 21 to 25 are left.
MOBILITY_LEFT = 1e-14
#: Points, over the columns of their levers, rigid motion and modes of one body or two, from which
#: an impact of elastic bodies is solved by levers and not by the whole matrix: both cost the same
#: there.
POINTS_A_LEVER = 0.75
#: For the energy that impacts take over that of rigid bodies (`reduced.rigid_loss`). Approach, over
#: the largest before the impact, below which points no longer approach. Duration of an impact over
#: the time until then: elastic faces give back for longer than they store. Least rigid loss that
#: counts, over the least weight of a body and width of a foot: that of a column which rocks at a
#: thousandth of its critical tilt.
APPROACH_LEFT, IMPACT_LASTS, LOSS_COUNTS = 0.1, 4.0, 1e-5
#: Height above those that carry up to which a point counts as landing with them in the loss of
#: rigid bodies: two thousand times what a standing steel column sinks in, far below any flight.
LANDS_TOO = 2e-5
#: What the impulses of the rigid loss may miss the laws by, over the largest velocity: they move
#: nothing, and energy is off by less.
IMPACT_TOLD = 1e-3

# --- Rolling rim
# --------------------------------------------------------------------------------------------------
#: Tilt [rad] below which the points stay where they are on the rim: circle and polygon are then
#: less than a nanometre apart.
FLAT = 1e-5
#: Angle [rad] by which the lowest point may move along the rim in a step and still be the contact
#: that rolls on.
ROLL = 0.8
#: Angle [rad] by which it may run there in a step at the fastest rate in it; a step in which it
#: would run farther is made in parts.
ROLL_STEP = 0.1
#: Parts of a step at most, a power of two.
PARTS = 64
#: Points so many sectors before and behind the lowest one belong to the same contact.
REACH = 2
#: Work of contact, over weight and foot's width, above which a step, or a part of it, is made again
#: with the rim's points at rest: the most energy that contact can make in it. A traction along the
#: rim shifts the pressure to the side, where it pushes a foot on that rolls; most of it comes back.
#: Ten times less, and a column that wobbles at a small tilt would lose a tenth of its energy in a
#: few revolutions to points at rest.
CREATED = 1e-6
#: Nodes that count as a circle: so many at least, their distances from its centre and their sectors
#: equal up to this share.
ROUND_NODES, ROUND = 12, 1e-6

# --- Start from rest
# --------------------------------------------------------------------------------------------------
#: Inertia of the iteration to equilibrium over the rate of falling, squared: it only holds what
#: contact and friction leave free. The contact's compliance leaves out that a tilt moves the
#: weight; the iteration that corrects this converges with the inverse as its factor.
FIRMNESS = 10.0
#: Times that the inertia is made ten times as large where the iteration diverges. About the
#: vertical it is a slender column's smallest, and horizontal forces on a wide flange, which the
#: compliance keeps where they are, turn it further. More often where that is less than the inertia
#: of a step, to which the give of rigid bodies is fitted.
FIRMER_TIMES = 2
#: The same inertia over the square of the fastest frequency of the links: these answer the motion
#: of an iteration at once, and it must not answer them as strongly.
LINKS_FIRM = 4.0
#: Stretch of a link over how far from the origin it is: the least of which the force counts where
#: changes of the links' forces are judged. The rounding of a position is 2e-8 of it. The force of
#: stiff glue that carries nothing is rounding alone, and changes by its size.
LEAST_STRETCH = 1e-8
#: Displacement of an iteration, over the column's height, below which the column is at rest: ten
#: thousand times the rounding of a position.
REST_WAY = 1e-11
#: Forces that are not balanced at rest, over the weight of all bodies: reactions are then as exact.
#: An iteration of much inertia moves a body by little wherever it is. Where bodies move by less
#: than that way and so many iterations do not halve what is not balanced, it is what contact and
#: links are solved to, if it is less than the second share, a tenth of FORCE_SHARE, to which each
#: point is solved: glue of 1e10 N/m3 leaves 2e-6, a waxed vase of 3 kg on 81 stiff points 1.2e-5.
BALANCED, BALANCED_AT_LEAST, BALANCE_HALVES = 1e-10, 1e-4, 10
#: Iteration to equilibrium from which on points that slide are held by those of their joint that
#: stick: a bent with a damper on soil had crept for 6,000 and was not there.
HOLDS_FROM = 1000
#: Iteration to equilibrium from which on the next begins where Newton's step with the stiffness of
#: modes, links and contact leads: most structures are at rest by then. Times that the way there is
#: tried, each half as long as the last; inertia beside that stiffness, over that of the iteration,
#: for what nothing holds; compliance of contact in it, over the largest, where that is rounding.
HASTEN_FROM, HASTEN_TRIES, LEAST_FIRM, LEAST_COMPLIANCE = 8, 4, 1e-9, 1e-9
#: Gap over the height of a structure below which faces touch as they are drawn, and are expected to
#: carry at rest.
TOUCHES = 1e-8
#: Iterations to equilibrium within which the displacement of one must fall to this share, else none
#: is found: a slender column needs a pad whose stiffness against tilting is 1.6 times its weight
#: times the height of its centre.
REST_ITERATIONS, REST_PROGRESS = 50, 0.5
#: The same where links hold bodies: a soft link of a block that nothing else holds along its base
#: brings it back slowly, in steps that are small from the first.
LINKS_PROGRESS = 0.99
#: Iterations of full order between two that begin ahead, and how steady the share of a step in the
#: one before must be for that, over what it lacks of 1: what is slow alone is left by then.
AHEAD_AFTER, AHEAD_STEADY = 5, 0.02
#: Iterations after which points keep the slides that they have made. Until then friction is that of
#: a point's whole way, whatever the iterations did. Where all points of a joint slide, as of a
#: light stone that a heavy one spreads below it, friction of 1.5 makes that balance unstable and
#: the body goes to and fro; with slides kept, what goes back sticks. Most structures are at rest
#: after four.
SLIDES_KEPT = 20

# --- Bodies that stand on moving ones
# --------------------------------------------------------------------------------------------------
#: Way beyond the outline of a surface, over the width of the foot on it, within which a point still
#: stands on it: feet as wide as what they stand on would else lose their outline to the first slip.
#: On a base plate over the width of its last brick.
EDGE_REACH = 2e-3
#: Depth of a point that comes over an outline, over the most that those which carry between the
#: same bodies give alone, up to which it takes part as they do: pressure that rises in a straight
#: line towards an edge is at most twice that beside it.
GIVES_MORE = 2.0

# --- Joints with two sides, over the larger side of the slave's face
# ----------------------------------------------------------------------------
#: Outlines closer than this are one: of two equal faces the points are nodes of the slave. Far
#: below any slide, far above rounding.
SAME_OUTLINE = 1e-9
#: From this share of it on, the corners where two outlines cross are looked for: no corner of the
#: region is lost to rounding where a face sticks out by SAME_OUTLINE exactly.
CROSSES_FROM = 0.5
#: Corners of the region nearer than this are one.
ONE_CORNER = 1e-7
#: Way beyond an outline within which a point stays with the body it belongs to, though it is laid
#: on the edge exactly: while a structure stands, elastic shear moves outlines over one another by a
#: hundredth of it, and points would change bodies in each step.
OUTLINE_BAND = 1e-4
#: Way of a corner of the region within a step in which it is still the same one; two points nearer
#: than the second stand for one, of which the corner stays.
SAME_CORNER, SAME_POINT = 0.05, 1e-3

# --- Geometry and overturning
# --------------------------------------------------------------------------------------------------
#: Nodes are at the same place up to this share of the foot's width or the body's size: rounding of
#: a mesh file.
SAME_PLACE = 1e-9
#: Share of the largest friction force below which an edge sticks: the force of one that slides
#: meets it to 1e-6.
STICKS = 0.999
#: Corners that stand for a round rim when overturning is judged; its radius comes out 1e-5 too
#: small between them.
ROUND_CORNERS = 720

# --- Contact found between convex bodies, over the thickness of the thinner one
# --------------------------------------------------------------------------------------------------
#: Corners are on one plane of a hull up to this share of the body's size, as a mesh file that has
#: six digits says them; share of its hull's volume that a body may lack and still be convex.
SAME_FACE, SAME_HULL = 1e-6, 1e-5
#: How much farther apart bodies must be along another axis than along that of the step before, or
#: than along a face where it is one of two edges, for it to be the axis of contact: what changes by
#: less would make the axis of bodies at rest on one another change in each step.
OTHER_AXIS = 1e-4
#: Sine of the angle between two edges below which no axis is taken from them, and below which the
#: axis is so inexact that the distance along it is measured to all corners.
PARALLEL, NEARLY_PARALLEL = 1e-10, 1e-4
#: Way of a point of contact within a step in which it is still the same one though it has another
#: name: a corner that comes to an edge, as SAME_CORNER.
SAME_POINT_BY_PLACE = 0.02
#: Depth at which bodies have come through each other: far above what contact leaves, far below
#: what can be overlooked.
THROUGH = 1e-3
#: Distance, over the thickness of the thinnest body and beside twice the longest way in the step,
#: within which the places of a pair are found: those of bodies at rest stay the same from step to
#: step.
FOUND_NEAR = 1e-2
#: Share of its lift that a place which was found below the surface, or a point that came over an
#: outline there, keeps from step to step: it comes out within some hundred steps, at a hundredth
#: of the depth in each.
STAYS_DEEP = 0.99
#: Places of a pair that take part, at most; pairs for which there is room at first, for each body:
#: a block in a wall is near to six others. There is more room when it is wanted.
FOUND_SLOTS, FOUND_ROWS = 8, 4
