#include "page/clip_data.h"

namespace tumble {

ClipData make_clip_data(const PageClip&) { return {}; }

}  // namespace tumble
