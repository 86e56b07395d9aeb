// Mass and center of mass of a described body.
#pragma once

#include "scene/description/description.h"

namespace tumble {

struct MassCenter {
    double mass = 0.0;           // kg
    Vec3 center = Vec3::Zero();  // body frame, from the body's origin
};

/// Mass and center of mass of a body with a closed shape, with its densities or its mass.
MassCenter mass_center(const BodyDescription& body);

}  // namespace tumble
