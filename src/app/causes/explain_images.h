// Causes of the differences of compared images: from motion records where both sides have one, otherwise from the
// pixels.
#pragma once

#include "app/causes/motion_record.h"
#include "compare/comparison.h"

#include <cstdint>

namespace tumble {

/// Fills in the causes of an image that is `different`. `frame`: its number in both records.
void explain_image(const MotionRecord& before, const MotionRecord& after, std::int64_t frame, ImageResult& result);

/// The same for frames (frame_000041.png) of which both folders have a record, frames.motion.json. A frame that is
/// another one of the reference is named without records. A damaged record is as good as none.
void explain_frames(SetResult& result);

}  // namespace tumble
