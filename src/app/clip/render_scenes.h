// The scenes of a clip, their place in the frame, and the frames of the clip.
#pragma once

#include "app/checkpoints/checkpoint_file.h"
#include "app/clip/clip_request.h"
#include "app/composition/make_composition.h"
#include "app/files/frame_set.h"
#include "app/plots/plotted_run.h"
#include "app/survey/survey.h"
#include "app/threads/interrupt.h"
#include "overlay/overlay_builder.h"
#include "overlay/overlay_scales.h"
#include "presimulation/follow_path.h"
#include "presimulation/motion_camera.h"
#include "scene/load.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"
#include "sound/sound_track.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// The sizes of arrows over a clip, for their scales.
struct ScaleObserver : SurveyObserver {
    explicit ScaleObserver(const SceneDescription& scene) : sizes(scene) {}
    void see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) override {
        sizes.add(snapshot, records);
    }
    ScaleSurvey sizes;
};

/// The impacts and contacts of a clip, for its sound.
struct SoundObserver : SurveyObserver {
    explicit SoundObserver(const SceneDescription& scene) : track(scene) {}
    void see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) override {
        track.see(snapshot, *records);
    }
    SoundTrack track;
};

/// The motion of a clip, for its camera.
struct CameraObserver : SurveyObserver {
    explicit CameraObserver(const SceneDescription& scene) : motion(scene) {}
    void see(const Snapshot& snapshot, const Survey&, const ContactRecords*) override { motion.see(snapshot); }
    MotionCamera motion;
};

/// The motion of a clip, for cameras that come up with a body.
struct FollowObserver : SurveyObserver {
    explicit FollowObserver(const SceneDescription& scene) : path(scene.camera) {}
    void see(const Snapshot& snapshot, const Survey&, const ContactRecords*) override { path.see(snapshot); }
    FollowPath path;
};

/// A scene that survey_clip() has simulated with all of its frames kept.
struct SurveyedRun {
    std::unique_ptr<World> world;  // at the end
    std::unique_ptr<SurveyedFrames> frames;
};

/// How a clip is surveyed.
struct SurveyWork {
    int threads = 1;
    bool image = true;        // otherwise AOVs alone are drawn
    std::size_t to_keep = 0;  // bytes of frames that may be kept for the drawing; 0: none
    std::function<void(std::size_t, const World&)> at_start = {};  // called for each scene that is simulated
};

class RenderScenes {
public:
    /// Loads and checks the scenes. Throws InputError if they do not fit together.
    RenderScenes(const ClipRequest& command, const Shutter& shutter);

    /// Simulates the scenes once of which a plot, the scale of arrows, the sound or the camera needs it, and fills them
    /// in. Leaves no thread behind.
    void survey_clip(const SurveyWork& work, Interrupt& interrupt);
    /// The run of a scene that survey_clip() has kept; empty where the scene is to be simulated.
    SurveyedRun take_run(std::size_t index) { return std::move(kept_[index]); }

    // The same by another run of the simulation, and its result in a checkpoint.

    /// Finds the paths of cameras that come up with a body, by runs of their own. Before observers(). Replaces scenes
    /// of the composition.
    void find_paths(int threads, Interrupt& interrupt);
    /// Consumers of a scene that have to see all of its frames, in order.
    std::vector<SurveyObserver*> observers(std::size_t index);
    /// Fills in what the observers have seen. Replaces scenes of the composition.
    void use_survey(int threads);
    std::vector<std::byte> survey_bytes() const;
    /// Throws InputError where the bytes are not of such a survey.
    void take_survey(std::span<const std::byte> bytes);
    /// The settings that the state of the clip depends on.
    CheckpointIdentity identity() const;

    const SceneDescription& first() const { return *scenes.front().scene; }
    std::size_t bodies() const;
    World world(std::size_t index, int threads) const;
    /// True if a panel shows dirty regions, which only a single render process knows.
    bool shows_damage() const;
    /// The maker of a panel's overlay; null without one. Valid after survey_clip().
    std::unique_ptr<OverlayBuilder> overlay(std::size_t index) const;
    /// The sound of the frames as a WAV file: of all panels together. Valid after survey_clip().
    std::vector<std::byte> sound() const;

    ClipRequest request;
    std::vector<ClipScene> scenes;   // the timing is that of the simulation, with the intervals of the shutter
    std::vector<std::int64_t> ends;  // one after the last frame of each scene
    FileList inputs;
    FrameSet frames;               // that the command asks for
    std::int64_t clip_frames = 0;  // of the longest scene
    Composition composition;
    std::string notes;  // for the user, a line each

private:
    void load(const ClipRequest& command);
    /// s, scene time that a frame shows.
    double time_of(std::size_t scene, std::int64_t frame) const;
    /// s, of a step in each interval of the shutter.
    double time_of_step(std::size_t scene) const;
    FrameSet frames_from(std::size_t scene, double start) const;
    std::vector<double> warped_sound(std::size_t index, std::int64_t last) const;
    void fill_plots();
    bool sees_for_camera(std::size_t index, const SurveyObserver* observer) const;
    void frame_motion(int threads);
    void place_cameras();
    void add_overlays();
    void read_plot(const ClipRequest& command, CompositionOptions& options);

    template <class Archive, class Self>
    static void visit_survey(Archive& archive, Self& self);

    Shutter shutter_;
    double speed_;
    std::vector<PlottedRun> runs_;  // one for each scene if there is a plot
    std::vector<ScaleObserver> scales_;
    std::vector<SoundObserver> sounds_;  // one for each scene if the clip has sound
    std::vector<CameraObserver> motions_;
    std::vector<FollowObserver> follows_;
    std::vector<CameraDescription> cameras_;  // by scene; the survey places each camera that shows the motion
    std::vector<SurveyedRun> kept_;
};

}  // namespace tumble
