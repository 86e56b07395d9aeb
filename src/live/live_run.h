// A run that a page makes itself: from the text of a scene to the data of a clip, piece by piece.
//
//     LiveRun run("ball.toml", text, {"body.ball.restitution=0.65"});
//     while (run.frames() < run.all_frames()) {
//         run.advance(30);
//         show(run.data());
//     }
//
// The data of a whole run is what `tumble page ball.toml --set body.ball.restitution=0.65` puts into its page, before
// compression.
#pragma once

#include "page/clip_data.h"
#include "page/page_recorder.h"
#include "presimulation/motion_camera.h"
#include "scene/description/description.h"
#include "sim/frames/frame_sequence.h"
#include "sim/world.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

class LiveRun {
public:
    /// `name`: of the scene file, for messages and the list of sources. `settings`: "PATH=VALUE", as of --set. Throws
    /// InputError.
    LiveRun(const std::string& name, const std::string& text, const std::vector<std::string>& settings);

    std::int64_t all_frames() const { return scene_.frame_count(); }
    std::int64_t frames() const { return recorder_.frames(); }
    /// Simulates up to `frames` more frames. Throws RunError where the simulation fails: the frames until then remain.
    void advance(std::int64_t frames);
    /// The data of the frames until now, as decode_clip() of the player reads it. Precondition: frames() > 0.
    std::vector<std::byte> data() const;

private:
    SceneDescription scene_;
    std::vector<PageSource> sources_;
    World world_;
    FrameSequence sequence_;
    PageRecorder recorder_;
    MotionCamera motion_camera_;
};

}  // namespace tumble
