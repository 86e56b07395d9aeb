// Small scenes for the tests of the interface.
#pragma once

#include <tumble/tumble.h>

namespace tumble {

/// A crate and a ball that fall on a plane; two seconds at 10 frames/s, 48 x 32 pixels.
inline SceneSpec crate_and_ball() {
    SceneSpec spec;
    spec.simulation.duration = 2.0;
    spec.output = {48, 32, 10.0, 4};
    spec.add(Plane{}, BodyType::fixed);
    Body& crate = spec.add(Box{{1.0, 1.0, 1.0}});
    crate.name = "crate";
    crate.position = {0.0, 3.0, 0.0};
    crate.angular_velocity = {1.0, 2.0, 0.5};
    Body& ball = spec.add(Sphere{0.5});
    ball.position = {2.0, 1.5, 0.0};
    return spec;
}

inline bool same(const Snapshot& a, const Snapshot& b) {
    if (a.frame != b.frame || a.time != b.time || a.bodies.size() != b.bodies.size()) return false;
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        const BodyState &x = a.bodies[i], &y = b.bodies[i];
        if (x.origin != y.origin || x.center_of_mass != y.center_of_mass || x.orientation != y.orientation ||
            x.velocity != y.velocity || x.angular_velocity != y.angular_velocity)
            return false;
    }
    return true;
}

inline Snapshot after(const Scene& scene, int frames, int threads = 1) {
    World world(scene, threads);
    for (int i = 0; i < frames; ++i) world.advance_frame();
    return world.snapshot();
}

}  // namespace tumble
