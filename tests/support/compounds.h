// Compounds built in code.
#pragma once

#include "scene/description/description.h"

#include <memory>
#include <utility>
#include <vector>

namespace tumble::testing {

inline CompoundPart part(const Shape& shape, const Vec3& position, const Quat& rotation = Quat::Identity()) {
    CompoundPart p;
    p.shape = shape;
    p.position = position;
    p.rotation = rotation;
    return p;
}

inline CompoundShape compound_of(std::vector<CompoundPart> parts) {
    return {std::make_shared<const std::vector<CompoundPart>>(std::move(parts))};
}

/// The box of that size, as eight boxes of half its edges.
inline CompoundShape box_of_eight(const Vec3& size) {
    std::vector<CompoundPart> parts;
    for (int i = 0; i < 8; ++i) {
        const Vec3 sign(i & 1 ? 0.25 : -0.25, i & 2 ? 0.25 : -0.25, i & 4 ? 0.25 : -0.25);
        parts.push_back(part(BoxShape{0.5 * size}, sign.cwiseProduct(size)));
    }
    return compound_of(std::move(parts));
}

/// A square frame in the x-y plane about the origin: outer edge `edge`, of square bars `bar` thick.
inline CompoundShape square_link(double edge, double bar) {
    const double at = 0.5 * (edge - bar), inside = edge - 2.0 * bar;
    return compound_of({part(BoxShape{Vec3(edge, bar, bar)}, {0.0, at, 0.0}),
                        part(BoxShape{Vec3(edge, bar, bar)}, {0.0, -at, 0.0}),
                        part(BoxShape{Vec3(bar, inside, bar)}, {at, 0.0, 0.0}),
                        part(BoxShape{Vec3(bar, inside, bar)}, {-at, 0.0, 0.0})});
}

/// A top of 1.6 x 0.1 x 1 m on four legs of 0.8 m; the origin is on the ground in the middle.
inline CompoundShape table() {
    std::vector<CompoundPart> parts{part(BoxShape{Vec3(1.6, 0.1, 1.0)}, {0.0, 0.85, 0.0})};
    for (const double x : {-0.7, 0.7})
        for (const double z : {-0.4, 0.4}) parts.push_back(part(BoxShape{Vec3(0.1, 0.8, 0.1)}, {x, 0.4, z}));
    return compound_of(std::move(parts));
}

}  // namespace tumble::testing
