// The faces between the cells of bodies with `fracture`, for the overlay of the page.
#pragma once

#include "page/array_store.h"
#include "scene/description/description.h"

namespace tumble {

/// Empty where overlays show no body that is cut.
ArrayStore::Json make_crack_marks(const SceneDescription& scene, ArrayStore& arrays);

}  // namespace tumble
