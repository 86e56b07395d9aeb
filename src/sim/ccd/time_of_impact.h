// Time of the first touch of two moving bodies. Balls against balls and planes by the roots of a quadratic; every other
// pair by conservative advancement along separating axes (separation.h), which never misses a first contact and
// ends within 1e-13 s, or at the limit of rounding.
#pragma once

#include "sim/ccd/separation.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/collide.h"
#include "sim/geometry/shapes/shape.h"

#include <vector>

namespace tumble {

/// A body in motion: its trajectory, and the time since its start when the search begins.
struct MovingBody {
    const Body* body = nullptr;
    const Trajectory* path = nullptr;
    double since = 0.0;                    // s
    const Compound::Part* part = nullptr;  // part of a compound that is searched; none: the whole body
};

/// Rounding error (m) of the gaps of the body's pairs at this position.
double gap_rounding(const Body& body, const Vec3& position);

struct TimeOfImpact {
    enum class Kind {
        none,    // apart up to the horizon
        impact,  // touching and approaching at `time`
        check,   // apart up to `time`, where the search must be resumed: it has used up its evaluations
    };
    Kind kind = Kind::none;
    double time = 0.0;  // s from the start of the search
};

class ImpactSearch {
public:
    ImpactSearch() { scratch_.choice = AxisChoice::nearest; }

    /// Bodies that touch at the start and part, or rest against each other, have no impact there. `overlap` (m):
    /// allowed overlap before an impact counts.
    TimeOfImpact find(const MovingBody& a, const MovingBody& b, double horizon, double overlap = 0.0);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [a, b, last_axis, normals, scratch, manifolds, candidates, part_pairs] = self;
        archive.keep(last_axis, scratch);
        archive.scratch(a, b, normals, manifolds, candidates, part_pairs);
    }

private:
    struct Pair;
    TimeOfImpact search(const Pair& pair, double from, double horizon);
    TimeOfImpact search_parts(const MovingBody& a, const MovingBody& b, double horizon, double overlap);
    TimeOfImpact search_mesh(const MovingBody& mesh, const MovingBody& other, double horizon, double overlap);
    void propose(const Pair& pair, const Motion& a, const Motion& b, double near);
    void propose_triangle_axes(const Polyhedron& shape, const Mat3& rotation);

    SupportPoints a_, b_;
    Vec3 last_axis_ = Vec3::UnitY();
    std::vector<Vec3> normals_;  // proposed, from A to B
    CollisionScratch scratch_;
    std::vector<Manifold> manifolds_;
    std::vector<std::uint32_t> candidates_;  // triangle indices
    struct PartPair {
        double from;  // s, before which they certainly stay apart
        MovingBody a, b;
    };
    std::vector<PartPair> part_pairs_;
};

}  // namespace tumble
