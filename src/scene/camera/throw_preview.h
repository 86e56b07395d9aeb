// Approximate trajectories of thrown bodies, for the default camera.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// Points around the trajectories of bodies with an initial velocity in the first `seconds`. Each body is simulated
/// alone, as a ball that flies, bounces off planes and fixed bodies, slides with friction (balls roll), and stops at
/// another moving body. A trajectory ends where the body would be small on the screen. Empty if very many bodies are
/// thrown.
std::vector<Vec3> flight_points(const SceneDescription& scene, double seconds);

}  // namespace tumble
