// Settings of each codec for each quality, measured in docs/explanation/output.md.
#pragma once

#include "output/video_format.h"

#include <string>
#include <vector>

namespace tumble {

/// Arguments of the ffmpeg program, from -c:v on. For a GIF they are those of its lossless first stage, the same for
/// each quality.
std::vector<std::string> codec_arguments(VideoKind kind, const ClipOptions& options);

}  // namespace tumble
