// The motion of all bodies as numbers of the clip data: each body as the smallest of a single pose ("still"), moments
// with exact motion between them ("keys"), and quantized frames ("frames").
#pragma once

#include "page/array_store.h"
#include "page/frame_channels.h"
#include "page/page_run.h"

namespace tumble {

// NOLINTNEXTLINE(bugprone-exception-escape): the move of a JSON value, which does not throw
struct MotionData {
    ArrayStore::Json json;
    MotionErrors errors;
};

/// `budget`: bytes after compression. The quanta of the frames are the finest that it allows. `events`: whether the
/// bodies' events are part of the data; without them a body with impacts has no keys.
MotionData make_motion_data(const PageRun& run, std::size_t budget, bool events, ArrayStore& arrays);

}  // namespace tumble
