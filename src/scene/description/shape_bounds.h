// Bounds of shapes in their own frame; planes are infinite and have none.
#pragma once

#include "scene/description/description.h"

namespace tumble {

struct BoundingSphere {
    Vec3 center = Vec3::Zero();  // body frame
    double radius = 0.0;         // m
};

/// Address of the shared data of a mesh or a compound; null for other shapes.
const void* shared_data(const Shape& shape);

/// The axis-aligned bounding box of the shape; empty for a plane.
Bounds local_bounds(const Shape& shape);

/// A bounding sphere, exact for boxes and spheres; about the center of its bounds for meshes and compounds. Not for
/// planes.
BoundingSphere bounding_sphere(const Shape& shape);

}  // namespace tumble
