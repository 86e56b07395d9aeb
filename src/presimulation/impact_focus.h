// Bodies with `focus = "impact"`: their cells are small where the blow that breaks them strikes.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// The scene with those bodies cut about these places. It simulates the scene, from its start for each blow that is
/// harder than those before it, until the blow breaks the body that is cut about its place: the motion before does not
/// depend on the cut. A body that no blow breaks has its hardest blow as its focus. Other scenes are returned at once.
SceneDescription focused_on_impacts(SceneDescription scene);

}  // namespace tumble
