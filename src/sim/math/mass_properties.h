// Mass, center of mass and inertia tensor (notes section 1); of a shape, see sim/geometry/shapes.
#pragma once

#include "core/vector.h"

#include <vector>

namespace tumble {

struct MassProperties {
    double mass = 0.0;                   // kg
    Vec3 center_of_mass = Vec3::Zero();  // m, in the shape's frame
    Mat3 inertia = Mat3::Zero();         // kg m^2, about the center of mass, axes of the shape's frame
};

/// The same body in another frame.
MassProperties placed(const MassProperties& properties, const Vec3& position, const Quat& rotation);

/// Several bodies as one, by the parallel axis theorem (Steiner); all in one frame. Overlaps count twice.
MassProperties sum_of_masses(const std::vector<MassProperties>& parts);

/// The same body with another mass.
MassProperties with_mass(const MassProperties& properties, double mass);

struct PrincipalInertia {
    Vec3 moments = Vec3::Zero();   // kg m^2, in no particular order
    Quat axes = Quat::Identity();  // rotates principal coordinates into the tensor's frame
};

/// tensor = R diag(moments) R^T, by Jacobi's rotations (Golub and Van Loan 2013, "Matrix Computations", section 8.5).
/// A diagonal tensor keeps its axes. Moments that differ only by a mesh's rounding come out equal to the last bit. With
/// three equal moments every axis is principal: the result has the tensor's own axes.
PrincipalInertia principal_inertia(const Mat3& tensor);

}  // namespace tumble
