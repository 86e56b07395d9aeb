// Every tuning constant of the simulation, with its unit and its reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble::tuning {

/// Two surfaces touch when nearer than this part of the smaller body's radius: far above rounding, far below sight.
inline constexpr double touch = 1e-6;

/// Edges closer to parallel than this (squared sine) give no separating axis of their own: a face normal covers the case.
inline constexpr double parallel_edges = 1e-8;

/// Contact points are kept up to this part of the smaller body's radius apart (and as far as the bodies can come in a
/// step), so that a rocking box already knows the corners it will land on.
inline constexpr double speculative = 0.02;

/// A contact point takes over the impulse of a point this part of the smaller body's radius away, when no point has the same
/// features: corners that swap places on a rocking box carry the same load.
inline constexpr double carry_reach = 0.1;

/// A point that a manifold of four leaves out is missed where it overlaps by more than the first part of the smaller radius,
/// and lies deeper than the deepest of the four by more than that and by the second part of their depth. Taken in sooner,
/// heaps of boxes in rows have a third more manifolds; later, boxes rock before it.
inline constexpr double sunk_overlap = 1e-5;
inline constexpr double sunk_share = 0.1;

/// What passes an edge on a curve may overlap by this part of the smaller radius on its way: as far as tiles may have sunk into what
/// they lie on. More is a hit.
inline constexpr double passing_overlap = 2e-3;

/// Bodies that turn by more than this (rad) in a step may roll over several of their corners in it: those of cylinders of 200 corners.
inline constexpr double swing_turn = 0.03;
/// And by more than this over those of 64: of such bodies the points on a plane are those that they roll on.
inline constexpr double rolling_turn = 0.1;

/// Two bodies that moved by less than this part of the smaller one's radius against each other keep their manifold: points
/// may lie that far from where a search would put them, separations are exact all the same.
inline constexpr double reuse_motion = 2e-3;

/// Shapes of many corners are asked whether points were missed where they moved by less than this part of the radius since the last
/// search: what rocks. What rolls over its corners has others in every step.
inline constexpr double missed_motion = 0.05;

/// Bounds in the broad phase are grown by this part of a body's radius, and ahead by its way in so many steps: a search in
/// the tree every few steps for falling bodies, none for resting ones. Measured on heaps of 1000 boxes: twice as much trebles
/// the pairs of neighbours that do not touch, half as much the searches.
inline constexpr double fat_bounds = 0.05;
inline constexpr double fat_steps = 8.0;

/// The velocity of a kinematic body changes evenly over a step where the mean of it is that of beginning and end, to this part
/// of the change: far more than a smooth path leaves (h^2 of it), less than most bends.
inline constexpr double kinematic_bend = 0.1;

/// Slower approaches than this times |g| h do not bounce. A resting contact meets gravity's own g h each step;
/// twice that is told apart from it.
inline constexpr double restitution_threshold = 2.0;
/// Nor, when stepped, does what would come back slower than this times |g| h, in a hop of two steps. Left to overlap for such a bounce it
/// would stay there, and be lifted out for nothing.
inline constexpr double restitution_rebound = 1.0;

/// The soft contact solver's substep, s: 8 in a step of 1/60 s hold a heap of a thousand boxes with overlaps below a
/// thousandth of their size. Overlaps go with its square: short steps are cut too, for what they are taken for.
inline constexpr double soft_substep = 1.0 / 480.0;
inline constexpr int soft_least_substeps = 4;
inline constexpr int soft_most_substeps = 64;
/// Piles of more levels than this get substeps half as long, or a quarter: high piles of soft contacts would buckle.
inline constexpr int soft_high_pile = 32;
inline constexpr int soft_very_high_pile = 64;
/// And where a body would sink in by more than this part of its radius under its own weight: g d^2 in a substep d.
inline constexpr double soft_sag = 3e-3;
/// Islands in which bodies overlap by this part of the smaller radius began so, or landed fast: they are lifted apart for nothing.
inline constexpr double soft_energy_deep = 0.25;
/// Energy of what floats that is too much by less than this part of it is rounding.
inline constexpr double soft_energy_rounding = 1e-9;
/// In islands of so many bodies the ways are held to the energy there is, where soft contacts may spin something up: a body that
/// turns by more than this in a substep, rad; or has moments of inertia in such a ratio, as a needle of 1 : 45.
inline constexpr std::size_t soft_energy_bodies = 32;
inline constexpr double soft_energy_turn = 0.1;
inline constexpr double soft_energy_slender = 1e3;
/// Steps for which the load of an island that is solved softly is taken to hold.
inline constexpr int soft_load_age = 8;
/// Stiffness of its contacts, cycles in a substep, and their damping ratio: between bodies; between those of which one is
/// heavier by more than the factor; against what does not move. Stiffer ones are more than one sweep a substep can follow: heaps
/// rock for ever (of 576 heaps of 27 boxes 6 are awake after 8 s; 0.25 for all: 52), a pyramid of 100 rows creeps (0.22: by 0.13 m
/// in 60 s, 0.16: 3 mm). Softer ones sink in: overlaps go with the inverse square.
inline constexpr double soft_frequency = 0.16;
inline constexpr double soft_frequency_of_unlike = 0.14;
inline constexpr double soft_unlike_masses = 2.0;
inline constexpr double soft_frequency_of_fixed = 0.2;
/// An overlap of this part of the smaller radius is pushed out twice as fast for its depth, but between unlike masses: the chains
/// of force through a heap end on single corners that carry 90 bodies.
inline constexpr double soft_twice_as_stiff = 1e-2;
inline constexpr double soft_damping = 2.0;
/// Deeper than push_limit allows they give way by no less than this part of their softness: bodies of millimetres still carry
/// many of their weights, and what a press squeezes still gives way.
inline constexpr double soft_least_give = 0.25;
/// Overlaps below this part of the smaller radius are not pushed out: they keep the contact alive.
inline constexpr double soft_slop = 2e-5;
/// Friction acts at the centroid of the points nearer than this part of the smaller radius; farther ones count little.
inline constexpr double friction_near = 2e-3;
inline constexpr double friction_far_weight = 0.01;
/// The twist shares friction's limit where the area around it slips, at its mean distance, by more than this part of what it slips itself.
/// Below, a spin is stopped by all the twist there is: acting at one place, though the load lies to one side of it, friction would turn
/// what slides.
inline constexpr double spin_share = 0.2;
/// Masses (kg) that it counts in kilograms; beyond, in a unit of the scene's own.
inline constexpr double soft_least_mass = 1e-9;
inline constexpr double soft_most_mass = 1e9;
/// Manifolds from which on several threads share one island: below, meeting twice a sweep costs more.
inline constexpr std::size_t soft_team_manifolds = 500;
/// Manifolds of small islands that are solved together, through all substeps, before the next: their rows stay in a core's
/// second cache (360 bytes each).
inline constexpr std::size_t soft_part_manifolds = 256;
/// Bodies of a block that one thread keeps to: their states fill a core's first cache (64 bytes each).
inline constexpr std::size_t soft_block_bodies = 512;
/// Steps for which manifolds keep their places side by side, by what they cost when these were found. No result depends on it.
inline constexpr int soft_layout_steps = 32;
/// Groups of manifolds between blocks from which on the threads share them too, meeting at every colour.
inline constexpr std::size_t soft_shared_groups = 24;

/// The direct contact solver's compliance of normal contact, over the island's mass: small enough for a few rounds, large
/// enough for masses of 1 : 1e6 in double precision. Friction begins softer by a factor, without which Newton's method
/// stalls on the edges of the discs, and stiffens from round to round down to as stiff.
inline constexpr double direct_compliance = 1e-3;
inline constexpr double direct_friction_soft = 1e4;
inline constexpr double direct_friction_stiffening = 0.3;
inline constexpr double direct_friction_stiff = 1.0;
/// A body lands where a gap closes within the step, later than after this part of it: no rounding of what rests.
inline constexpr double direct_landing = 0.02;
/// Convergence of its Newton steps and of its rounds, relative to the step's own change of velocity and to the impulses.
inline constexpr double direct_tolerance = 1e-9;
/// Speeds below this part of the fastest body's are rounding, which the stiffness of the contacts magnifies.
inline constexpr double direct_rounding = 1e-12;
inline constexpr double direct_round_tolerance = 1e-4;
inline constexpr int direct_first_newton_steps = 40;   // after a landing, every contact of a stack of 30 changes its mind
inline constexpr int direct_newton_steps = 12;
inline constexpr int direct_rounds = 12;
inline constexpr int direct_line_search = 25;
/// A contact this near to closing or opening (of the speed scale) counts as closed in the second derivatives.
inline constexpr double direct_tie = 1e-10;
/// Friction may pass its cone by this factor while its limit still follows the load.
inline constexpr double direct_cone = 1.05;
/// What its solution may leave a contact closing by, of the speed scale.
inline constexpr double direct_closing = 1e-3;
/// Overlaps below this part of the smaller radius are not pushed out: under a micrometre for metre-sized bodies.
inline constexpr double direct_slop = 1e-6;
/// Compliance of its push-out, over the island's mass, and how stiff it is across the normals against that.
inline constexpr double direct_push_compliance = 1e-2;
inline constexpr double direct_push_across = 0.03;

/// Islands in which a body turns farther than this (rad) in a step are left to the substeps. Not those that touch nothing
/// fixed: the direct solve keeps their angular momentum, poses and all.
inline constexpr double direct_turn = 0.03;
/// Single bodies are solved directly; and all islands of a scene with so few pairs of bodies in contact.
inline constexpr std::size_t direct_few_pairs = 32;
/// Larger ones when a body carries so many times its own mass, and up to so many bodies.
inline constexpr double direct_load_ratio = 16.0;
/// Once solved directly, to this part of it.
inline constexpr double direct_stay = 0.8;
/// In scenes of many manifolds only for more: hundreds of columns of 20 stand softly, too, in half the time.
inline constexpr std::size_t direct_many_manifolds = 4096;
inline constexpr double direct_load_ratio_of_many = 64.0;
inline constexpr std::size_t direct_most_bodies = 512;
/// Block operations (6 x 6, some 0.1 microseconds) of one factorisation that an island may take, by manifold and in any
/// case; and what all islands together may take in a step: a millisecond.
inline constexpr std::size_t direct_work_each = 30;
inline constexpr std::size_t direct_work_free = 50;
inline constexpr std::size_t direct_budget = 8000;
/// Steps until an island is tried again after a failure, doubled with every further one so many times.
inline constexpr int direct_wait = 6;
inline constexpr int direct_most_failures = 8;
/// Impulses handed to the soft solver: at most so many times what the step's forces give the lighter body.
inline constexpr double direct_handover = 20.0;
inline constexpr std::size_t direct_parallel_grain = 4;

/// Share of an overlap that is pushed out in a step. Less leaves boxes sunk after a hard landing, more makes heaps tremble.
inline constexpr double push_share = 0.2;
/// Fastest push-out, in radii per second: deep overlaps at the start dissolve visibly, not with a bang.
inline constexpr double push_limit = 5.0;

/// Contacts of an impact that are projected exactly together: the cost grows with the cube of the contacts held, 1 ms at
/// 100, 30 ms at 256, 0.3 s at 512. The sweeps taken beyond that stop short of the solution in long chains.
inline constexpr std::size_t projection_contacts = 512;
/// In the passes of a propagating impact the sweeps win in run time from fewer on (heaps of 216 bouncing boxes: half the
/// time of 256), and a pass need not be exact: it keeps the energy whatever the sweeps leave over.
inline constexpr std::size_t pass_contacts = 64;
/// Approaches below this part of the restitution threshold, a quarter of what gravity adds in a step, take no part in the
/// impacts of more contacts than that: a sixth of a heap's approaching contacts is left, in small parts that are exact.
inline constexpr double impact_slow = 0.125;
/// A unit row is dependent on others when less than this is left of it: masses of 1 : 1e8 in one contact leave 1e-4.
inline constexpr double projection_dependent = 1e-8;
/// Impulses are spread over contacts whose rows depend on each other to this (the rounding of arms of some hundred
/// metres), or clearly do not: in between the even shares would be those of rounding.
inline constexpr double projection_spread_dependent = 1e-12;
inline constexpr double projection_spread_independent = 1e-3;
/// A row whose multiplier falls slower than this against the one that rises does not block it: rounding.
inline constexpr double projection_weight = 1e-13;
/// Sweeps of the projection by Gauss-Seidel, and the relative change at which it has converged.
inline constexpr int projection_sweeps = 400;
inline constexpr double projection_sweep_tolerance = 1e-14;

/// Approaches below this part of the cluster's largest relative speed are rounding, or below that of its largest speed.
inline constexpr double approach_relative = 1e-13;
inline constexpr double approach_rounding = 4e-15;
/// Passes of a propagating impact. Most end within some three a contact. Where more are needed (a light ball between a
/// heavy one and a wall, 31415 for masses of 1 : 1e8) their number goes with the inverse margin of the contacts; sets
/// without a margin are jammed and never end.
inline constexpr int impact_passes_each = 3;
inline constexpr int impact_passes_more = 10;
inline constexpr double impact_passes_margin = 4.0;
inline constexpr int impact_passes_limit = 100000;
/// Between walls that move nothing is thrown faster than by so many times their speed: a wedge of some 20 degrees.
inline constexpr double impact_wedge = 3.0;
/// Contacts whose margin is below one over this are jammed where walls move: the two sides of a box in a press.
inline constexpr double impact_deepest = 100.0;
/// Sum over the passes of the squared number of contacts in each: some 50 ms. What goes on longer is a slow inelastic
/// approach of many contacts to one common speed. Elastic passes come to an end, and count for a tenth.
inline constexpr double impact_work = 3e5;
inline constexpr double impact_elastic_work = 0.1;

/// Rounds of friction and what it makes approach again: first with restitution, then without.
inline constexpr int friction_bounces = 4;
inline constexpr int friction_rounds = 12;
/// Sweeps of friction over a cluster, and the change of speed, relative to the slip, at which it has converged. Large
/// clusters (heaps) get so many relaxations of a contact in all: every sweep lowers the energy, none has to be the last.
inline constexpr int friction_sweeps = 400;
inline constexpr int friction_work = 400;
inline constexpr int friction_least_sweeps = 2;
inline constexpr double friction_tolerance = 1e-14;
inline constexpr double friction_tolerance_step = 1e-5;   // at a step, whose own error is larger by far
/// Contacts with friction up to which the last digits are sought; beyond, the second tolerance holds.
inline constexpr std::size_t friction_few = 8;
inline constexpr double friction_tolerance_many = 1e-6;
/// Newton steps to the edge of a friction disc: it converges quadratically, in 4 to 8 whatever the compliances.
inline constexpr int friction_newton = 50;

/// Exact impacts. Gaps below this part of the bodies' sizes are rounding, plus a few last digits of their places.
inline constexpr double impact_gap = 1e-13;
inline constexpr double impact_position_rounding = 1e-15;
/// Approaches slower than this part of the bodies' own speeds are rounding.
inline constexpr double impact_speed_rounding = 1e-14;
/// Nearer than this part of the smaller body, the axis is taken from the features that meet; points within the second
/// part of it belong to a feature. Between the rounding of a search for the nearest points and its use.
inline constexpr double impact_near = 1e-7;
inline constexpr double impact_feature = 1e-8;
/// Shortest step of the search for an impact, s.
inline constexpr double impact_time = 1e-15;
/// Poses a search looks at before it hands back what it has: 4 to 70 are the rule (spins to 100 rad/s).
inline constexpr int impact_evaluations = 400;

/// Contacts nearer than this part of the smaller body take part in one impact; and with them those of the same faces that touch.
inline constexpr double impact_touch = 1e-9;
/// What touches without approaching is left alone for as long as it overlaps by no more than this part of the smaller body.
inline constexpr double impact_harmless = 1e-7;
/// Hops shorter than this (s) are not followed: the contact holds. A bouncing ball then rests within this over 1 - e of
/// its closed-form time, and what it still had is below g times this.
inline constexpr double shortest_hop = 1e-7;
/// Impacts less than this (s) apart are in a row. After so many in a row a body is taken to be coming to rest, and the
/// shortest hop followed doubles every eight impacts: e = 0.9 needs about 90 from a millisecond down.
inline constexpr double in_a_row = 1e-3;
inline constexpr int impacts_before_landing = 128;
/// Impacts in a row before hops that move nothing visibly count as contact.
inline constexpr int impacts_before_stutter = 16;
/// Times in a step that a held body, once struck, meets others at their own time: what turns about a contact closes it again
/// and again, by less each time.
inline constexpr int meetings_in_step = 8;
/// Impacts in a frame, times the number of bodies: far beyond any clip (a million hits of each body a second).
inline constexpr std::int64_t impacts_in_frame = 20000;
/// Accelerations of touching points against each other below this part of what they are the difference of are rounding.
inline constexpr double pressing_rounding = 1e-12;
/// A flying body's box in the search for neighbours: its way of so many radii, by how many neighbours it then has, and so
/// much around it (measured on 216 balls, crowded and scattered).
inline constexpr double shortest_box_way = 0.75;
inline constexpr double longest_box_way = 40.0;
inline constexpr std::size_t few_neighbours = 6;
inline constexpr double box_margin = 0.3;

/// A way in a step longer than this part of both bodies' inner radii together is looked along (impacts = "stepped"): less
/// than the whole of them is still pushed out of the right side.
inline constexpr double fast_share = 0.5;
/// And one longer than this part of the smaller inner radius: what is not stopped overlaps by as much for a step.
inline constexpr double fast_deepest = 0.9;
/// What touches when the step begins may come to an overlap of the first part of it, or deeper by the second: the contact
/// solver leaves small approaches, which must not hold fast bodies up.
inline constexpr double fast_overlap = 0.05;
inline constexpr double fast_deeper = 0.01;
/// Rounds in which bodies that stop one another are looked at again.
inline constexpr int motion_limit_rounds = 8;

/// Phase (rad) that a step of the extrapolation of tenth order may cover: its error is then about 1e-14.
inline constexpr double extrapolation_phase = 0.2;
/// Drag |u| u is not smooth where the body comes to rest in the air: the time to get there counts for so much phase, until
/// the force is below this part of what changes the velocity.
inline constexpr double extrapolation_rest_in_air = 2.0;
inline constexpr double extrapolation_no_drag = 1e-14;
/// Its steps at most in a span, half a second of computing: what asks for more is lighter than the air it pushes by far.
inline constexpr int most_substeps = 200000;

/// Growth of a body's spin energy in the turn of one step from which on the change of omega in the step counts: over 1e5 steps nothing
/// to be seen. What lies in heaps stays below.
inline constexpr double spin_steady = 1e-9;
/// And that is let pass in contact.
inline constexpr double spin_growth = 0.01;
/// Turns of a step, rad, up to which the mean of omega follows from a series (its error: 1e-5 of the turn), and from which on it is
/// not looked for: the tangent that gives it gets long.
inline constexpr double spin_series_turn = 0.1;
inline constexpr double spin_largest_turn = 0.7;

/// A body is at rest when its surface strayed, in one of these spans (s), by less than if it gathered speed at this rate
/// (radii/s^2): 3e-6 radii in the shortest, 2e-4 in the longest. What slides off at a thousandth past the angle of friction
/// gathers 0.01 sin(angle) m/s^2.
inline constexpr std::array<double, 4> sleep_times = {0.5, 1.0, 2.0, 4.0};
inline constexpr double sleep_acceleration = 2.5e-5;
inline constexpr double sleep_drift(double span) { return 0.5 * sleep_acceleration * span * span; }   // radii

/// Slower than that a body gathers speed unseen by its way, the more so the larger it is, but not by its velocity. It is looked at
/// every so many seconds, at most each step, and is under way when so many looks in a row found its velocity to have grown, or to
/// have changed the way that it did before, by no less than this share: what settles within a second changes by less each time.
/// Two looks are as good for heaps: what trembles turns round sooner.
inline constexpr double sleep_look = sleep_times.front() / 16.0;
inline constexpr int sleep_looks = 4;
inline constexpr double sleep_steady = 0.97;
/// Changes of velocity between two looks that are the contact solver's rounding: in shares of what gravity adds in a step.
inline constexpr double sleep_rounding = 1e-10;

/// A contact of a part of a compound is inside the body, a seam, when this share of the part's size out along its normal all
/// points lie in other parts, or no farther outside them than the second share: far above rounding, below any real edge.
inline constexpr double seam_probe = 1e-3;
inline constexpr double seam_tolerance = 1e-5;

/// Moving bodies from which on they lie in memory by where they are (memory_order.h), and how many of them lie there by height.
inline constexpr std::size_t ordered_bodies = 512;
inline constexpr std::size_t ordered_column = 32;

/// Fewer pairs or islands than this are not worth waking the other threads for.
inline constexpr std::size_t parallel_grain = 64;
/// Fewer bodies whose pairs are looked for: some microseconds each.
inline constexpr std::size_t parallel_searches = 16;
/// The same for bodies whose forces are applied or poses moved.
inline constexpr std::size_t parallel_bodies = 512;

}  // namespace tumble::tuning
