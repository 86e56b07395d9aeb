// The tables of a sample: those of `tumble simulate` for its scene.
#pragma once

#include "app/sweep/sample_folder.h"
#include "app/sweep/sweep_plan.h"
#include "scene/description/description.h"

namespace tumble {

/// Simulates the scene and writes the requested tables.
void write_tables(const SceneDescription& scene, const SampleOutputs& outputs, SampleFolder& folder);

}  // namespace tumble
