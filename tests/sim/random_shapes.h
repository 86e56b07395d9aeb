// Random numbers that are the same on every platform, and shapes and poses made of them.
#pragma once

#include "sim/geometry/collide.h"
#include "support/meshes.h"

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace tumble::testing {

/// std's distributions differ between libraries; these do not.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double operator()(double low, double high) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }
    int below(int n) { return int(engine_() % std::uint64_t(n)); }
    Vec3 vector(double size) {
        const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
        return {x, y, z};
    }
    Vec3 direction() {
        while (true) {
            const Vec3 v = vector(1.0);
            if (v.norm() <= 1.0 && v.norm() > 0.1) return v.normalized();
        }
    }
    Quat turn() {
        while (true) {
            const double w = (*this)(-1, 1);
            const Vec3 v = vector(1.0);
            const Quat q(w, v.x(), v.y(), v.z());
            if (q.norm() > 0.1 && q.norm() <= 1.0) return q.normalized();
        }
    }
    Pose pose(double size) {
        const Vec3 at = vector(size);
        return {at, turn().toRotationMatrix()};
    }

private:
    std::mt19937_64 engine_;
};

/// Number of random trials: all n in optimized builds, a tenth of them in the others, which are there for the
/// sanitizers and run fifty times as long.
constexpr int trials(int n) {
#ifdef NDEBUG
    return n;
#else
    return (n + 9) / 10;
#endif
}

using PolyhedronRef = std::shared_ptr<const Polyhedron>;

inline Vec3 mean(const std::vector<Vec3>& points) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points) sum += p;
    return sum / double(points.size());
}

inline PolyhedronRef box_of(const Vec3& size) { return std::make_shared<const Polyhedron>(make_box(size)); }

/// The box as a general polyhedron: without the shortcuts for boxes.
inline PolyhedronRef plain_box(const Vec3& size) {
    Polyhedron p = make_box(size);
    p.is_box = false;
    return std::make_shared<const Polyhedron>(p);
}

/// The hull of points in a ball, scaled by `stretch` along the axes.
inline PolyhedronRef random_hull(Random& random, int points, const Vec3& stretch) {
    std::vector<Vec3> cloud;
    for (int i = 0; i < points; ++i) cloud.push_back(stretch.cwiseProduct(random.direction() * random(0.6, 1.0)));
    return std::make_shared<const Polyhedron>(make_hull(cloud, mean(cloud)));
}

inline std::shared_ptr<const CollisionMesh> surface_of(const TriangleMesh& mesh, const Vec3& origin = Vec3::Zero()) {
    return std::make_shared<const CollisionMesh>(make_collision_mesh(mesh, origin));
}

inline std::vector<Manifold> collide_all(const CollisionShape& a, const Pose& pose_a, const CollisionShape& b,
                                         const Pose& pose_b, double margin) {
    CollisionScratch scratch;
    std::vector<Manifold> out;
    collide(a, b, {pose_a, pose_b, margin, scratch, out});
    return out;
}

inline double deepest(const std::vector<Manifold>& manifolds) {
    double least = std::numeric_limits<double>::infinity();
    for (const Manifold& m : manifolds)
        for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[std::size_t(i)].separation);
    return least;
}

inline Pose after(const Pose& outer, const Pose& inner) {
    return {outer.to_world(inner.position), outer.rotation * inner.rotation};
}

/// Distance (m) of a point (body frame) outside of a polyhedron's planes; negative inside.
inline double outside(const Polyhedron& shape, const Vec3& p) {
    double most = -std::numeric_limits<double>::infinity();
    for (const auto& f : shape.faces) most = std::max(most, f.normal.dot(p) - f.offset);
    return most;
}

}  // namespace tumble::testing
