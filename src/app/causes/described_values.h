// The described values of a scene as text, by their paths, for motion records.
#pragma once

#include "app/causes/motion_record.h"
#include "app/composition/composition.h"
#include "scene/description/description.h"

namespace tumble {

BodyKind kind_of(const SceneDescription& scene, const BodyDescription& body);

/// Values of the scene without its bodies: light, simulation, forces, ... Without the camera: a record has its views.
ValueMap values_of(const SceneDescription& scene);

/// Size, samples and text of the whole image.
ValueMap values_of(const Composition& composition);

}  // namespace tumble
