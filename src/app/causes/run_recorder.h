// Makes motion records while a clip is simulated.
#pragma once

#include "app/causes/motion_record.h"
#include "app/composition/composition.h"
#include "app/survey/survey.h"
#include "render/camera/camera_animation.h"
#include "scene/description/description.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace tumble {

// -- The described values of a scene as text, by their paths, for motion records.

BodyKind kind_of(const SceneDescription& scene, const BodyDescription& body);

/// Values of the scene without its bodies: light, simulation, forces, ... Without the camera: a record has its views.
ValueMap values_of(const SceneDescription& scene);

/// Size, samples and text of the whole image.
ValueMap values_of(const Composition& composition);

/// Sees the frames of a panel from the first one on.
class PanelRecorder : public SurveyObserver {
public:
    /// `frames`: frames whose poses are recorded, ascending. `length`: frames that will be seen at most.
    PanelRecorder(const ClipPanel& panel, const std::vector<std::int64_t>& frames, std::int64_t length);

    void see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) override;

    /// A panel that has ended before a recorded frame has its last pose there.
    PanelRecord finish();

private:
    void add_pose(const Snapshot& snapshot);
    void add_trace(const Snapshot& snapshot);
    void add_contacts(const Snapshot& snapshot, const ContactRecords& records);

    PanelRecord record_;
    CameraAnimation camera_;
    std::vector<std::int64_t> frames_;
    std::vector<std::size_t> moving_;                            // bodies
    std::vector<std::uint32_t> blocks_;                          // digests of the present block, by moving body
    std::vector<std::pair<std::size_t, std::size_t>> touching_;  // pairs of the frame before, ascending
    Snapshot last_;                                              // seen
    std::int64_t next_ = 0;                                      // frame
    std::size_t next_recorded_ = 0;                              // index into frames_
};

/// The panels of a clip.
class RunRecorder {
public:
    /// `frames`: frames that are drawn, ascending. `length`: frames that the simulation makes.
    RunRecorder(const Composition& composition, std::vector<std::int64_t> frames, std::int64_t length);

    /// Recorder of a plot: its runs are the panels, whose first frame is recorded.
    explicit RunRecorder(const std::vector<SceneDescription>& runs);

    PanelRecorder& panel(std::size_t index) { return panels_[index]; }
    MotionRecord finish();

private:
    MotionRecord record_;
    std::deque<PanelRecorder> panels_;
};

}  // namespace tumble
