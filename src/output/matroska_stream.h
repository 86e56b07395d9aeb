// Raw images with time stamps, as a Matroska stream (RFC 9559) for ffmpeg's standard input. Unlike rawvideo and
// yuv4mpeg it has time stamps, so that an unchanged image is sent once and shown longer.
#pragma once

#include "output/video_format.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// The stream up to the first frame. `width` and `height`: pixels of the frames.
std::vector<std::byte> matroska_head(PixelFormat form, int width, int height, const FrameRate& rate);

/// Header of the frame that is shown from n / rate on, before its pixels, which take `bytes`.
std::vector<std::byte> matroska_frame_head(std::int64_t n, const FrameRate& rate, std::size_t bytes);

}  // namespace tumble
