#include "sim/geometry/persistent_manifold.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tumble {

namespace {

// Ends of a point on the surfaces of A and B, body frames.
struct Ends {
    Vec3 on_a, on_b;
};

Ends ends_of(const ContactPoint& p, const Vec3& normal, const Pose& pose_a, const Pose& pose_b) {
    const Vec3 half = 0.5 * p.separation * normal;
    return {pose_a.to_body(p.position - half), pose_b.to_body(p.position + half)};
}

}  // namespace

PersistentManifold make_persistent_manifold(const Manifold& m, const Pose& pose_a, const Pose& pose_b,
                                            bool normal_of_b) {
    PersistentManifold persistent;
    persistent.normal_of_b = normal_of_b;
    persistent.normal = (normal_of_b ? pose_b : pose_a).rotation.transpose() * m.normal;
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
        const Ends ends = ends_of(m.points[i], m.normal, pose_a, pose_b);
        persistent.feet.set(i, normal_of_b ? ends.on_b : ends.on_a);
        persistent.corners.set(i, normal_of_b ? ends.on_a : ends.on_b);
    }
    return persistent;
}

void keep_reduced_points(std::span<const ContactPoint> reduced, std::span<const Manifold> kept, const Pose& pose_a,
                         const Pose& pose_b, PersistentManifold& persistent) {
    const auto add = [&, of_b = persistent.normal_of_b](const ContactPoint& p) {
        const auto [on_a, on_b] = ends_of(p, kept[0].normal, pose_a, pose_b);
        const Vec3 point = of_b ? on_a : on_b;
        persistent.reduced[std::size_t(persistent.reduced_count++)] = {
            {float(point.x()), float(point.y()), float(point.z())}, float(persistent.normal.dot(of_b ? on_b : on_a))};
    };
    if (reduced.size() <= PersistentManifold::reduced_capacity) {
        std::for_each(reduced.begin(), reduced.end(), add);
        return;
    }
    std::vector<double> farness;  // squared distance from the nearest point that is kept or chosen
    for (const ContactPoint& p : reduced) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Manifold& m : kept)
            for (int i = 0; i < m.count; ++i)
                nearest = std::min(nearest, (m.points[std::size_t(i)].position - p.position).squaredNorm());
        farness.push_back(nearest);
    }
    while (persistent.reduced_count < int(PersistentManifold::reduced_capacity)) {
        const auto next = std::size_t(std::max_element(farness.begin(), farness.end()) - farness.begin());
        add(reduced[next]);
        for (std::size_t i = 0; i < reduced.size(); ++i)
            farness[i] = std::min(farness[i], (reduced[i].position - reduced[next].position).squaredNorm());
    }
}

double deepest_reduced_point(const PersistentManifold& persistent, const Pose& pose_a, const Pose& pose_b,
                             const Manifold& m) {
    double deepest = std::numeric_limits<double>::infinity();
    if (persistent.reduced_count == 0) return deepest;  // the most frequent case
    const double between = m.normal.dot(pose_b.position - pose_a.position);
    const Vec3 n = (persistent.normal_of_b ? pose_a : pose_b).rotation.transpose() * m.normal;
    for (std::size_t i = 0; i < std::size_t(persistent.reduced_count); ++i) {
        const PersistentManifold::ReducedPoint& reduced = persistent.reduced[i];
        const double height = n.dot(Vec3(reduced.point[0], reduced.point[1], reduced.point[2])), face = reduced.face;
        deepest = std::min(deepest, between + (persistent.normal_of_b ? face - height : height - face));
    }
    return deepest;
}

// All slots are computed side by side, unused ones too: loops of fixed length become vector code.
void refresh(const PersistentManifold& persistent, const Pose& pose_a, const Pose& pose_b, Manifold& m) {
    const Pose &of_face = persistent.normal_of_b ? pose_b : pose_a, &other = persistent.normal_of_b ? pose_a : pose_b;
    const Vec3 between = other.position - of_face.position;  // the difference first: digits far from the origin
    const Vec3 n = of_face.rotation * persistent.normal;
    const auto &foot = persistent.feet.coordinate, &corner = persistent.corners.coordinate;
    constexpr int points = Manifold::capacity;
    double arm[3][points], height[points];  // m, of the corners, from the center of the face's body and over the feet
    for (int k = 0; k < 3; ++k) {
        const double r0 = other.rotation(k, 0), r1 = other.rotation(k, 1), r2 = other.rotation(k, 2);
        for (int i = 0; i < points; ++i)
            arm[k][i] = between[k] + (r0 * corner[0][i] + r1 * corner[1][i] + r2 * corner[2][i]);
    }
    for (int i = 0; i < points; ++i)
        height[i] =
            (n[0] * arm[0][i] + n[1] * arm[1][i] + n[2] * arm[2][i]) -
            (persistent.normal[0] * foot[0][i] + persistent.normal[1] * foot[1][i] + persistent.normal[2] * foot[2][i]);
    // The corner slides over the face, and lever arms follow it.
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < points; ++i) arm[k][i] = of_face.position[k] + (arm[k][i] - 0.5 * height[i] * n[k]);
    m.normal = n;
    const double sign = persistent.normal_of_b ? -1.0 : 1.0;  // the normal points from A to B
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
        m.points[i].separation = sign * height[i];
        m.points[i].position = {arm[0][i], arm[1][i], arm[2][i]};
    }
}

namespace {

constexpr double same_side = 0.9;  // cosine of the angle between the normals of two steps: 26 degrees

// The load must not be lost where the points have changed: remaining impulses go to the nearest points.
void transfer_impulses(const Manifold& old, const bool (&taken)[Manifold::capacity], Manifold& m) {
    if (old.normal.dot(m.normal) < same_side) return;
    for (int k = 0; k < old.count; ++k) {
        const ContactPoint& before = old.points[std::size_t(k)];
        if (taken[k] || before.impulse == 0.0) continue;
        const auto distance = [&](const ContactPoint& p) { return (p.position - before.position).squaredNorm(); };
        const auto nearest =
            std::min_element(m.points.begin(), m.points.begin() + m.count,
                             [&](const ContactPoint& l, const ContactPoint& r) { return distance(l) < distance(r); });
        nearest->impulse += before.impulse;
    }
}

}  // namespace

void match_impulses(const Manifold& old, double reach, Manifold& m) {
    m.tangent = old.tangent;
    std::copy_n(old.friction, 2, m.friction);
    m.torsion = old.torsion;
    std::copy_n(old.rolling, 2, m.rolling);
    m.solved_by = old.solved_by;
    bool taken[Manifold::capacity] = {}, found[Manifold::capacity] = {};
    for (int i = 0; i < m.count; ++i) {
        ContactPoint& point = m.points[std::size_t(i)];
        for (int k = 0; k < old.count; ++k) {
            const ContactPoint& before = old.points[std::size_t(k)];
            if (taken[k] || before.feature != point.feature) continue;
            point.impulse = before.impulse;
            taken[k] = found[i] = true;
            break;
        }
    }
    for (int i = 0; i < m.count; ++i) {
        if (found[i]) continue;
        ContactPoint& point = m.points[std::size_t(i)];
        double nearest = reach * reach;
        int best = -1;
        for (int k = 0; k < old.count; ++k) {
            const double square = (old.points[std::size_t(k)].position - point.position).squaredNorm();
            if (taken[k] || square >= nearest) continue;
            nearest = square;
            best = k;
        }
        if (best < 0) continue;
        point.impulse = old.points[std::size_t(best)].impulse;
        taken[best] = true;
    }
    transfer_impulses(old, taken, m);
}

void transfer_impulses(const Manifold& old, Manifold& m) { transfer_impulses(old, {}, m); }

}  // namespace tumble
