// How each codec is told to encode, for each quality: what is measured in docs/output.md.
#pragma once

#include "output/video_format.h"

#include <string>
#include <vector>

namespace tumble {

/// Arguments of the ffmpeg program, from -c:v on. Of a GIF they are those of its lossless first stage.
std::vector<std::string> codec_arguments(VideoKind kind, const ClipOptions& options);

/// The filters that choose a GIF's colors and map its pixels to them; the input is there twice.
std::string palette_filter(VideoQuality quality);

}  // namespace tumble
