#include "sim/collision/anchors.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tumble {
namespace {

// A point's ends on the surfaces of A and B, body frames.
struct Ends {
    Vec3 on_a, on_b;
};

Ends ends_of(const ContactPoint& p, const Vec3& normal, const Pose& pose_a, const Pose& pose_b) {
    const Vec3 half = 0.5 * p.separation * normal;
    return {pose_a.to_body(p.position - half), pose_b.to_body(p.position + half)};
}

}  // namespace

Anchors make_anchors(const Manifold& m, const Pose& pose_a, const Pose& pose_b, bool normal_of_b) {
    Anchors anchors;
    anchors.normal_of_b = normal_of_b;
    anchors.normal = (normal_of_b ? pose_b : pose_a).rotation.transpose() * m.normal;
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
        const Ends ends = ends_of(m.points[i], m.normal, pose_a, pose_b);
        anchors.on_a[i] = ends.on_a;
        anchors.on_b[i] = ends.on_b;
    }
    return anchors;
}

void keep_spares(std::span<const ContactPoint> left_out, std::span<const Manifold> kept, const Pose& pose_a, const Pose& pose_b,
                 Anchors& anchors) {
    const auto add = [&, of_b = anchors.normal_of_b](const ContactPoint& p) {
        const auto [on_a, on_b] = ends_of(p, kept[0].normal, pose_a, pose_b);
        anchors.spare[std::size_t(anchors.spares++)] = {of_b ? on_a : on_b, anchors.normal.dot(of_b ? on_b : on_a)};
    };
    if (left_out.size() <= Anchors::spare_capacity) {
        std::for_each(left_out.begin(), left_out.end(), add);
        return;
    }
    std::vector<double> farness;   // squared distance from the nearest that is kept or chosen
    for (const ContactPoint& p : left_out) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Manifold& m : kept)
            for (int i = 0; i < m.count; ++i) nearest = std::min(nearest, (m.points[std::size_t(i)].position - p.position).squaredNorm());
        farness.push_back(nearest);
    }
    while (anchors.spares < int(Anchors::spare_capacity)) {
        const auto next = std::size_t(std::max_element(farness.begin(), farness.end()) - farness.begin());
        add(left_out[next]);
        for (std::size_t i = 0; i < left_out.size(); ++i)
            farness[i] = std::min(farness[i], (left_out[i].position - left_out[next].position).squaredNorm());
    }
}

double deepest_spare(const Anchors& anchors, const Pose& pose_a, const Pose& pose_b, const Manifold& m) {
    double deepest = std::numeric_limits<double>::infinity();
    if (anchors.spares == 0) return deepest;   // the most part
    const double between = m.normal.dot(pose_b.position - pose_a.position);
    const Vec3 n = (anchors.normal_of_b ? pose_a : pose_b).rotation.transpose() * m.normal;
    for (std::size_t i = 0; i < std::size_t(anchors.spares); ++i) {
        const Anchors::Spare& spare = anchors.spare[i];
        const double height = n.dot(spare.point);
        deepest = std::min(deepest, between + (anchors.normal_of_b ? spare.face - height : height - spare.face));
    }
    return deepest;
}

void follow(const Anchors& anchors, const Pose& pose_a, const Pose& pose_b, Manifold& m) {
    m.normal = (anchors.normal_of_b ? pose_b : pose_a).rotation * anchors.normal;
    const Vec3 between = pose_b.position - pose_a.position;   // the difference first: digits far from the origin
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
        const Vec3 arm_a = pose_a.rotation * anchors.on_a[i], arm_b = between + pose_b.rotation * anchors.on_b[i];
        const double separation = m.normal.dot(arm_b - arm_a);
        m.points[i].separation = separation;
        // The corner is the other body's: it slides over the face, and lever arms follow it.
        m.points[i].position = pose_a.position + (anchors.normal_of_b ? Vec3(arm_a + 0.5 * separation * m.normal)
                                                                      : Vec3(arm_b - 0.5 * separation * m.normal));
    }
}

}  // namespace tumble
