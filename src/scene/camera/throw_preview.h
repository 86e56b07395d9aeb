// Where thrown bodies will be, roughly: for a camera that is to show them.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// Points around the ways that bodies with a velocity take in the first `seconds`: each by itself, as a ball that flies, bounces
/// off planes and fixed bodies, slides on with friction (balls roll) and ends where it meets another moving body. What goes far
/// away is left to go: a way ends where the body would be small in the picture. None where very many bodies are thrown.
std::vector<Vec3> flight_points(const SceneDescription& scene, double seconds);

}  // namespace tumble
