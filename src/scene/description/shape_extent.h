// The extent of a shape as balls and points whose convex hull contains it.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// Calls visit(center, radius) for balls, most of them points, whose convex hull contains the shape. Not for planes.
template <class Visit>
void visit_extent(const Shape& shape, const Vec3& position, const Quat& rotation, const Visit& visit) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            visit(Vec3(position + rotation * sign.cwiseProduct(box->size)), 0.0);
        }
    } else if (const auto* ball = std::get_if<SphereShape>(&shape)) {
        visit(position, ball->radius);
    } else if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
        for (const Vec3& v : mesh->asset->surface.vertices) visit(Vec3(position + rotation * v), 0.0);
    } else if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        for (const CompoundPart& part : *compound->parts)
            visit_extent(part.shape, position + rotation * part.position, rotation * part.rotation, visit);
    }
}

}  // namespace tumble
