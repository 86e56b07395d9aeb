// Raw pictures with time stamps, as a Matroska stream (RFC 9559) for ffmpeg's standard input: what rawvideo and
// yuv4mpeg lack are the time stamps, by which a picture that stays is sent once and shown longer.
#pragma once

#include "output/video_format.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Everything before the first frame. `width` and `height` in pixels, as the frames have them.
std::vector<std::byte> matroska_head(PixelForm form, int width, int height, const FrameRate& rate);

/// What goes before the pixels of the frame that is shown from n / rate on; they take `bytes`.
std::vector<std::byte> matroska_frame_head(std::int64_t n, const FrameRate& rate, std::size_t bytes);

}  // namespace tumble
