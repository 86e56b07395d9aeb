#include "sim/collision/anchors.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tumble {

Anchors make_anchors(const Manifold& m, const Pose& pose_a, const Pose& pose_b, bool normal_of_b) {
    Anchors anchors;
    anchors.normal_of_b = normal_of_b;
    anchors.normal = (normal_of_b ? pose_b : pose_a).rotation.transpose() * m.normal;
    for (std::size_t i = 0; i < std::size_t(m.count); ++i) {
        const Vec3 half = 0.5 * m.points[i].separation * m.normal;
        anchors.on_a[i] = pose_a.to_body(m.points[i].position - half);
        anchors.on_b[i] = pose_b.to_body(m.points[i].position + half);
    }
    return anchors;
}

void keep_spares(std::span<const ContactPoint> left_out, std::span<const Manifold> kept, const Pose& pose_a, const Pose& pose_b,
                 Anchors& anchors) {
    std::vector<const ContactPoint*> left;
    for (const ContactPoint& p : left_out)
        if (std::none_of(kept.begin(), kept.end(), [&](const Manifold& m) { return m.has(p.feature); })) left.push_back(&p);
    std::vector<Vec3> places;
    for (const Manifold& m : kept)
        for (int i = 0; i < m.count; ++i) places.push_back(m.points[std::size_t(i)].position);
    const auto farness = [&](const ContactPoint* p) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& place : places) nearest = std::min(nearest, (p->position - place).squaredNorm());
        return nearest;
    };
    for (; anchors.spares < Anchors::spare_capacity && !left.empty(); ++anchors.spares) {
        auto next = left.begin();
        if (left.size() > std::size_t(Anchors::spare_capacity - anchors.spares))
            next = std::max_element(left.begin(), left.end(), [&](auto* l, auto* r) { return farness(l) < farness(r); });
        const ContactPoint& p = **next;
        const Vec3 half = 0.5 * p.separation * kept[0].normal;
        const Vec3 on_a = pose_a.to_body(p.position - half), on_b = pose_b.to_body(p.position + half);
        const bool of_b = anchors.normal_of_b;
        anchors.spare[std::size_t(anchors.spares)] = {of_b ? on_a : on_b, anchors.normal.dot(of_b ? on_b : on_a)};
        places.push_back(p.position);
        left.erase(next);
    }
}

double deepest_spare(const Anchors& anchors, const Pose& pose_a, const Pose& pose_b, const Manifold& m) {
    const double between = m.normal.dot(pose_b.position - pose_a.position);
    const Vec3 n = (anchors.normal_of_b ? pose_a : pose_b).rotation.transpose() * m.normal;
    double deepest = std::numeric_limits<double>::infinity();
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
