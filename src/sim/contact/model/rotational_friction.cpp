#include "sim/contact/model/rotational_friction.h"

#include <array>

namespace tumble {
namespace {

/// The shapes that touch in a manifold: of compounds, the parts (numbered by collide()).
std::array<const CollisionShape*, 2> touching_shapes(const Manifold& m, const Body& a, const Body& b) {
    std::array<const CollisionShape*, 2> shapes{&a.collider, &b.collider};
    std::uint32_t place = m.part;
    for (const std::size_t k : {0, 1}) {
        const auto* compound = std::get_if<std::shared_ptr<const Compound>>(shapes[k]);
        if (!compound) continue;
        const std::uint32_t stride = part_count(*shapes[1 - k]);
        shapes[k] = &(*compound)->parts[place / stride].collider;
        place %= stride;
    }
    return shapes;
}

}  // namespace

RotationalFriction rotational_friction(const Manifold& manifold, const Body& a, const Body& b) {
    if (!has_rotational_friction(a) && !has_rotational_friction(b)) return {};
    const PairRule rule = a.pair_rules.friction;
    RotationalFriction resistance{pair_value(rule, a.rolling_friction, b.rolling_friction),
                                  pair_value(rule, a.spinning_friction, b.spinning_friction)};
    if (!(resistance.rolling > 0.0)) return resistance;
    double curvature = 0.0;  // 1/m
    for (const CollisionShape* shape : touching_shapes(manifold, a, b))
        if (const double radius = rolling_radius(*shape); radius > 0.0) curvature += 1.0 / radius;
    resistance.rolling = curvature > 0.0 ? resistance.rolling / curvature : 0.0;
    return resistance;
}

}  // namespace tumble
