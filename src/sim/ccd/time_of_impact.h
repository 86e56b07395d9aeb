// When do two moving bodies first touch? Balls against balls and planes by the roots of a quadratic; every other pair by
// conservative advancement along separating axes (separation_bound.h), which never misses a first contact and ends
// within 1e-13 s, or where rounding ends.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/collide.h"
#include "sim/geometry/compound.h"
#include "sim/ccd/support_points.h"

#include <vector>

namespace tumble {

/// A body on its way: its path, and how long it has been on it when the search begins.
struct Traveller {
    const Body* body = nullptr;
    const Trajectory* path = nullptr;
    double since = 0.0;   // s
    const Compound::Part* part = nullptr;   // of a compound, the part that is searched for
};

/// What the body, there, adds (m) to the gaps of its pairs that are rounding.
double gap_rounding(const Body& body, const Vec3& position);

struct TimeOfImpact {
    enum class Kind {
        none,    // apart up to the horizon
        impact,  // touching and approaching at `time`
        check,   // apart up to `time`, and the search is to be taken up from there: it had used up its evaluations
    };
    Kind kind = Kind::none;
    double time = 0.0;   // s from the search's beginning
};

class ImpactSearch {
public:
    ImpactSearch() { scratch_.choice = AxisChoice::nearest; }

    /// Bodies that touch at the beginning and part, or rest against each other, have no impact there.
    /// `overlap` (m): so deep they may come into each other before it counts.
    TimeOfImpact find(const Traveller& a, const Traveller& b, double horizon, double overlap = 0.0);

private:
    struct Pair;
    TimeOfImpact search(const Pair& pair, double from, double horizon);
    TimeOfImpact search_parts(const Traveller& a, const Traveller& b, double horizon, double overlap);
    TimeOfImpact search_surface(const Traveller& surface, const Traveller& other, double horizon, double overlap);
    void propose(const Pair& pair, const Motion& a, const Motion& b, double near);
    void propose_triangle_axes(const Polyhedron& shape, const Mat3& rotation);

    SupportPoints a_, b_;
    Vec3 last_axis_ = Vec3::UnitY();
    std::vector<Vec3> normals_;          // proposed, from A to B
    CollisionScratch scratch_;
    std::vector<Manifold> manifolds_;
    std::vector<std::uint32_t> candidates_;   // triangles
    struct PartPair {
        double from;   // s, before which they certainly stay apart
        Traveller a, b;
    };
    std::vector<PartPair> part_pairs_;
};

}  // namespace tumble
