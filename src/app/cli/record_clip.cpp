#include "app/cli/record_clip.h"

#include "app/checkpoints/frame_record.h"
#include "app/pipeline/panel_run.h"
#include "render/scene/pose_filter.h"
#include "sim/checkpoint/archive.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr std::size_t most_motion = std::size_t(64) << 20;  // bytes of a panel that are kept until they are written

/// A panel, and the memory of drawing from frame to frame.
struct RecordedPanel {
    RecordedPanel(RenderScenes& scenes, std::size_t index, const ClipRecording& recording)
        : world(scenes.world(index, recording.threads)),
          overlay(scenes.overlay(index)),
          run({.world = &world, .end = scenes.ends[index], .overlay = overlay.get()}, recording.shutter),
          poses(*scenes.composition.panels[index].scene),
          observers(scenes.observers(index)),
          needs(needs_of(observers)) {
        if (recording.motion) motion.emplace(overlay ? MotionDetail::states : MotionDetail::poses);
        if (recording.records && !world.records_contacts()) world.record_contacts();
    }

    void take(std::int64_t frame, std::int64_t clip_end);
    PanelState state() const;

    World world;
    std::unique_ptr<OverlayBuilder> overlay;
    PanelRun run;
    std::optional<FrameRecorder> motion;
    PoseFilter poses;
    std::vector<SurveyObserver*> observers;
    SurveyNeeds needs;
    std::optional<PanelState> ended;  // state before its last frame, which later frames repeat
};

void RecordedPanel::take(std::int64_t frame, std::int64_t clip_end) {
    const bool runs = run.runs(frame);
    if (runs && !run.runs(frame + 1) && frame + 1 < clip_end) ended = run.save();
    const Survey survey = runs ? Survey(world, needs) : Survey();
    PanelPoses moments = run.next(frame);
    if (runs)
        for (SurveyObserver* observer : observers) observer->see(moments.front(), survey, run.records());
    if (runs && motion) motion->add(moments, run.records());
    for (Snapshot& moment : drawn_moments(moments)) poses.follow(moment);
}

PanelState RecordedPanel::state() const {
    PanelState state = ended ? *ended : run.save();
    CheckpointWriter writer;
    writer.keep(poses);
    state.poses.assign(writer.bytes().begin(), writer.bytes().end());
    return state;
}

using RecordedPanels = std::vector<std::unique_ptr<RecordedPanel>>;

/// Writes the motion since `first`. A panel that has ended has none.
void add_motion(std::int64_t first, const RecordedPanels& panels, CheckpointWriting& checkpoints) {
    for (std::size_t i = 0; i < panels.size(); ++i)
        if (panels[i]->run.runs(first)) checkpoints.add_motion(first, i, panels[i]->motion->take());
}

}  // namespace

void record_clip(RenderScenes& scenes, const ClipRecording& recording, CheckpointWriting& checkpoints) {
    RecordedPanels panels;
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i)
        panels.push_back(std::make_unique<RecordedPanel>(scenes, i, recording));
    const std::int64_t end = scenes.clip_frames;
    std::int64_t first = 0;  // of the motion that is not written yet
    for (std::int64_t n = 0; n < end; ++n) {
        for (const auto& panel : panels)
            if (panel->run.runs(n)) panel->run.reach_next();
        if (n > 0 && n % recording.every == 0) {
            ClipState state{n, {}};
            for (const auto& panel : panels) state.panels.push_back(panel->state());
            checkpoints.add(state);
        }
        const bool full =
            std::ranges::any_of(panels, [](const auto& p) { return p->motion && p->motion->size() > most_motion; });
        if (recording.motion && n > 0 && (n % recording.every == 0 || full))
            add_motion(std::exchange(first, n), panels, checkpoints);
        recording.each(n, panels.front()->world);
        for (const auto& panel : panels) panel->take(n, end);
    }
    if (recording.motion) {
        // The motion of the last frame's surfaces ends at the frame after it.
        if (panels.size() == 1) panels.front()->motion->add({panels.front()->run.next_start()}, nullptr);
        add_motion(first, panels, checkpoints);
    }
    scenes.use_survey();
    checkpoints.finish(scenes.survey_bytes());
}

}  // namespace tumble
