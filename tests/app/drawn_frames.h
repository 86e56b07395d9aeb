// The frames that a render pool delivers.
#pragma once

#include "app/workers/render_pool.h"

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace tumble {

struct Seen {
    std::int64_t number;
    bool repeated;
    std::vector<std::byte> video, png, aovs;
    friend bool operator==(const Seen&, const Seen&) = default;
};

/// Draws this many frames, with `video_bytes` each; `meanwhile` is called with the number of each finished frame.
inline std::vector<Seen> draw_frames(
    RenderPool& render_pool, std::size_t video_bytes, std::int64_t frames,
    const std::function<MotionBlurFrame(std::int64_t)>& frame_poses, std::int64_t first = 0,
    const std::function<void(std::int64_t)>& meanwhile = [](std::int64_t) {}) {
    BoundedQueue<MotionBlurFrame> poses(4);
    std::thread simulation([&] {
        for (std::int64_t n = 0; n < frames; ++n)
            if (!poses.push(frame_poses(n))) return;
        poses.close();
    });
    std::vector<Seen> seen;
    DrawingTimes times;
    try {
        render_pool.run(poses,
                        [&](const Frame& frame) {
                            seen.push_back({frame.number,
                                            frame.repeated,
                                            {},
                                            {frame.png.begin(), frame.png.end()},
                                            {frame.aovs.begin(), frame.aovs.end()}});
                            if (frame.video)
                                seen.back().video.assign(frame.video.get(), frame.video.get() + video_bytes);
                            meanwhile(frame.number);
                            return true;
                        },
                        times, {first, frames});
    } catch (...) {
        simulation.join();
        throw;
    }
    simulation.join();
    return seen;
}

}  // namespace tumble
