#include "sim/collision/collide.h"

#include <type_traits>

namespace tumble {
namespace {

using PolyhedronRef = std::shared_ptr<const Polyhedron>;
using SurfaceRef = std::shared_ptr<const TriangleSurface>;

// The pairs that have a routine of their own, in the order it takes them.
struct Pair {
    const Pose &pose_a, &pose_b;
    double margin;
    CollisionScratch& scratch;
    std::vector<Manifold>& out;

    void operator()(const HalfSpace& a, const Ball& b) const { collide_half_space_ball(a, pose_a, b, pose_b, margin, out); }
    void operator()(const HalfSpace& a, const PolyhedronRef& b) const {
        collide_half_space_polyhedron(a, pose_a, *b, pose_b, margin, scratch, out);
    }
    void operator()(const Ball& a, const Ball& b) const { collide_balls(a, pose_a, b, pose_b, margin, out); }
    void operator()(const PolyhedronRef& a, const Ball& b) const {
        collide_polyhedron_ball(*a, pose_a, b, pose_b, margin, out);
    }
    void operator()(const PolyhedronRef& a, const PolyhedronRef& b) const {
        collide_polyhedra(*a, pose_a, *b, pose_b, margin, scratch, out);
    }
    void operator()(const SurfaceRef& a, const Ball& b) const {
        collide_surface_ball(*a, pose_a, b, pose_b, margin, scratch, out);
    }
    void operator()(const SurfaceRef& a, const PolyhedronRef& b) const {
        collide_surface_polyhedron(*a, pose_a, *b, pose_b, margin, scratch, out);
    }
};

// Neither shape can be on a moving body.
template <class T>
constexpr bool immovable = std::is_same_v<T, HalfSpace> || std::is_same_v<T, SurfaceRef>;

}  // namespace

void collide(const Collider& a, const Pose& pose_a, const Collider& b, const Pose& pose_b, double margin,
             CollisionScratch& scratch, std::vector<Manifold>& out) {
    std::visit(
        [&](const auto& shape_a, const auto& shape_b) {
            using A = std::decay_t<decltype(shape_a)>;
            using B = std::decay_t<decltype(shape_b)>;
            if constexpr (immovable<A> && immovable<B>) {
                return;
            } else if constexpr (std::is_invocable_v<Pair, const A&, const B&>) {
                Pair{pose_a, pose_b, margin, scratch, out}(shape_a, shape_b);
            } else {   // the same pair the other way round: swap, collide, turn the normals
                const std::size_t first = out.size();
                Pair{pose_b, pose_a, margin, scratch, out}(shape_b, shape_a);
                for (std::size_t i = first; i < out.size(); ++i) out[i].normal = -out[i].normal;
            }
        },
        a, b);
}

}  // namespace tumble
