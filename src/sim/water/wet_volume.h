// The part of a solid below a plane: its volume and the center of that volume.
//
// Polyhedra and closed meshes: faces are clipped, and tetrahedra from a point of the plane to them are summed; the face
// in the plane adds nothing. Balls and ellipsoids: the cap of a ball. Other curved bodies: segments of discs across
// their axis, integrated along it by Gauss's rule in parts, each adaptively, to 1e-14 of the whole. Compounds: the sum
// of their parts, overlaps count twice, as for masses.
#pragma once

#include "core/triangle_mesh.h"
#include "sim/geometry/shapes/shape.h"

namespace tumble {

/// Water is where normal . p < offset.
struct WaterPlane {
    Vec3 normal = Vec3::UnitY();  // unit
    double offset = 0.0;          // m
};

/// The same plane in the frame of a pose.
inline WaterPlane seen_from(const Pose& pose, const WaterPlane& plane) {
    return {pose.rotation.transpose() * plane.normal, plane.offset - plane.normal.dot(pose.position)};
}

struct WetPart {
    double volume = 0.0;         // m^3
    Vec3 moment = Vec3::Zero();  // m^4, the volume times its center

    Vec3 center() const { return volume > 0.0 ? Vec3(moment / volume) : Vec3(Vec3::Zero()); }
};

/// In the frame of the shape, as the plane. A half-space and a collision mesh have none.
WetPart wet_part(const CollisionShape& shape, const WaterPlane& plane);
/// The same for the solid inside a closed mesh.
WetPart wet_part(const TriangleMesh& mesh, const WaterPlane& plane);

}  // namespace tumble
