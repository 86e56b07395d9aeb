#include "sim/collision/anchors.h"

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
