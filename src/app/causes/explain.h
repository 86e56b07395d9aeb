// Names the causes of differences between images by their motion records.
#pragma once

#include "app/causes/motion_record.h"
#include "compare/comparison.h"
#include "core/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

/// Sentences about one frame, worst first and few: "crate.17 moved by 3 px (first differing frame 41, first differing
/// contact at 0.68 s)", "color of floor (#808080 to #828282)", "camera (...)". `changed`: bounds of the differing
/// pixels. Empty if the records do not differ in what the frame shows, or if one of them is not of this frame.
std::vector<std::string> causes_between(const MotionRecord& before, const MotionRecord& after, std::int64_t frame,
                                        const Rectangle& changed);

// -- Causes of the differences of compared images: from motion records where both sides have one, otherwise from the
// pixels.

/// Fills in the causes of an image that is `different`. `frame`: its number in both records.
void explain_image(const MotionRecord& before, const MotionRecord& after, std::int64_t frame, ImageResult& result);

/// The same for frames (frame_000041.png) of which both folders have a record, frames.motion.json. A frame that is
/// another one of the reference is named without records. A damaged record is as good as none.
void explain_frames(SetResult& result);

}  // namespace tumble
