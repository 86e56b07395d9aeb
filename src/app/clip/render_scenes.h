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
#include "scene/load.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"
#include "sound/sound_track.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
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

class RenderScenes {
public:
    /// Loads and checks the scenes. Throws InputError if they do not fit together.
    RenderScenes(const ClipRequest& command, const Shutter& shutter);

    /// Simulates all scenes once, if a plot, the scale of arrows or the sound needs it, and fills them in. Leaves no
    /// thread behind.
    void survey_clip(int threads, Interrupt& interrupt);

    // The same by another run of the simulation, and its result in a checkpoint.

    /// Consumers of a scene that have to see all of its frames, in order.
    std::vector<SurveyObserver*> observers(std::size_t index);
    /// Fills in what the observers have seen.
    void use_survey();
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

private:
    void load(const ClipRequest& command);
    void fill_plots();
    void add_overlays();
    void read_plot(const ClipRequest& command, CompositionOptions& options);

    template <class Archive, class Self>
    static void visit_survey(Archive& archive, Self& self);

    Shutter shutter_;
    double speed_;
    std::vector<PlottedRun> runs_;  // one for each scene if there is a plot
    std::vector<ScaleObserver> scales_;
    std::vector<SoundObserver> sounds_;  // one for each scene if the clip has sound
};

}  // namespace tumble
