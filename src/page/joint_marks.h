// Joints over a run, for the overlay of the page: their sketches, and by frame whether they hold, their limits, forces
// and torques.
#pragma once

#include "page/array_store.h"
#include "page/page_run.h"

namespace tumble {

/// Empty where a page has no room for so many joints and frames.
ArrayStore::Json make_joint_marks(const PageRun& run, ArrayStore& arrays);

}  // namespace tumble
