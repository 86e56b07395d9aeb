#include "app/cli/record_clip.h"

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

/// A panel, and the memory of drawing from frame to frame.
struct RecordedPanel {
    RecordedPanel(RenderScenes& scenes, std::size_t index, const ClipRecording& recording)
        : world(scenes.world(index, recording.threads)),
          overlay(scenes.overlay(index)),
          run({world, scenes.ends[index], overlay.get()}, recording.shutter),
          poses(*scenes.composition.panels[index].scene),
          observers(scenes.observers(index)),
          measures(std::ranges::any_of(observers, [](const auto* o) { return o->needs_measurement(); })) {
        if (recording.records && !world.records_contacts()) world.record_contacts();
    }

    void take(std::int64_t frame, std::int64_t clip_end);
    std::vector<std::byte> state() const { return ended ? *ended : run.save(); }

    World world;
    std::unique_ptr<OverlayBuilder> overlay;
    PanelRun run;
    PoseFilter poses;
    std::vector<SurveyObserver*> observers;
    bool measures;
    std::optional<std::vector<std::byte>> ended;  // state before its last frame, which later frames repeat
};

void RecordedPanel::take(std::int64_t frame, std::int64_t clip_end) {
    const bool runs = run.runs(frame);
    if (runs && !run.runs(frame + 1) && frame + 1 < clip_end) ended = run.save();
    const Measurement measurement = runs && measures ? world.measure() : Measurement{};
    PanelPoses samples = run.next(frame);
    if (runs)
        for (SurveyObserver* observer : observers) observer->see(samples.front(), measurement, run.records());
    for (Snapshot& sample : samples) poses.follow(sample);
}

ClipState state_before(std::int64_t frame, const std::vector<std::unique_ptr<RecordedPanel>>& panels) {
    ClipState state{frame, {}, {}};
    for (const auto& panel : panels) {
        state.panels.push_back(panel->state());
        CheckpointWriter writer;
        writer.keep(panel->poses);
        state.poses.emplace_back(writer.bytes().begin(), writer.bytes().end());
    }
    return state;
}

}  // namespace

void record_clip(RenderScenes& scenes, const ClipRecording& recording, CheckpointWriting& checkpoints) {
    std::vector<std::unique_ptr<RecordedPanel>> panels;
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i)
        panels.push_back(std::make_unique<RecordedPanel>(scenes, i, recording));
    const std::int64_t end = scenes.frames.end;
    for (std::int64_t n = 0; n < end; ++n) {
        for (const auto& panel : panels)
            if (panel->run.runs(n)) panel->run.reach_next();
        if (n > 0 && n % recording.every == 0) checkpoints.add(state_before(n, panels));
        recording.each(n, panels.front()->world);
        for (const auto& panel : panels) panel->take(n, end);
    }
    scenes.use_survey();
    checkpoints.finish(scenes.survey_bytes());
}

}  // namespace tumble
