// Constants of event-driven motion (impacts = "exact").
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::tuning {

/// A touching contact that does not approach is no event while its overlap is below this share of the smaller body.
/// Not fitted: a tenth of the tolerance of resting contact. Tests: those of tests/sim/time_of_impact_test.cpp.
inline constexpr double impact_harmless = 1e-7;

/// Hops shorter than this, s, are not followed (Zeno limit): the contact closes. A bouncing ball comes to rest
/// within this over 1 - e of its closed-form time; its remaining speed is below g times this. Related test:
/// SettlingBall.RestsAtItsTimeAtAnyStep and bench_accuracy "ball coming to rest".
inline constexpr double shortest_hop = 1e-7;

/// Impacts at intervals below this, s, are in a row. After `impacts_before_zeno_growth` of them a body is coming to
/// rest: the shortest hop that is followed doubles with every eight impacts. e = 0.9 needs about 90 from a
/// millisecond down. Related tests: Zeno.TiltedBoxesComeToRestOnAFace and Zeno.FlatBoxRestsWhenABallDoes.
inline constexpr double impact_row_interval = 1e-3;
inline constexpr int impacts_before_zeno_growth = 128;

/// Impacts in a row from which on hops of invisible size count as contact. Related: the same tests.
inline constexpr int impacts_before_zeno_check = 16;

/// Impacts of a resting body with others within a step at their own times, once it was hit. A body that turns about
/// a contact closes it repeatedly, by less each time. Not fitted: a bound of the cost. Related test:
/// BothRegimes.SeeSawGainsNothing.
inline constexpr int meetings_in_step = 8;

/// A group of joined bodies is at rest, and stepped, if gravity gives its fastest point less than this share of g h in a
/// step. Not fitted: rounding of a hanging chain against the first step of a pendulum.
inline constexpr double group_rest = 0.01;

/// Half the length, in steps, of the first path on which a flying group's time of impact is found again, and the factor to
/// a longer one. The path's error is of the order of the fourth power of its length. Not fitted.
inline constexpr double refine_first = 1e-3;
inline constexpr double refine_longer = 30.0;

/// A contact is neutral if its relative acceleration, and its relative velocity over the step, are below this share of the
/// acceleration that presses its held body. Not fitted: above rounding and the speed that a landing leaves, far below a
/// motion. Tests: tests/physics/pressed_row_test.cpp.
inline constexpr double neutral_share = 1e-3;

/// Largest number of impacts in a frame per body: far beyond any clip (a million hits of each body per second). Not
/// fitted.
inline constexpr std::int64_t impacts_in_frame = 20000;

/// The box of a ballistic body in the neighbor search covers a displacement between these bounds, radii,
inline constexpr double shortest_box_displacement = 0.75;
inline constexpr double longest_box_displacement = 40.0;

/// according to the number of neighbors that it then has,
inline constexpr std::size_t few_neighbors = 6;

/// and this margin, radii. Measured on 216 balls, crowded and scattered (bench_accuracy "crowds").
inline constexpr double box_margin = 0.3;

}  // namespace tumble::tuning
