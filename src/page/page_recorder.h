// Keeps what a page shows of a run, frame by frame.
#pragma once

#include "overlay/overlay_scales.h"
#include "page/page_run.h"
#include "quantities/quantities.h"
#include "render/camera/camera_animation.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

struct PageRecording {
    std::string label;  // of the run, among several
    // Quantities of plots, separated by commas: the page has all quantities of bodies, and the quantities of joints
    // that are named here.
    std::string plot;
    bool places_camera_later = false;  // the scene's camera is not placed yet: see so_far()
};

class PageRecorder : public SurveyObserver {
public:
    /// The world must record contacts, and must be at its start. Throws InputError for a plot that the scene does not
    /// have.
    PageRecorder(const SceneDescription& scene, const PageRecording& recording, const World& world);
    PageRecorder(const PageRecorder&) = delete;
    PageRecorder& operator=(const PageRecorder&) = delete;

    SurveyNeeds needs() const override;
    void see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) override;

    std::int64_t frames() const { return std::int64_t(run_.energy.size()); }
    /// The whole run.
    PageRun finish();
    /// The run of the frames until now, seen by that camera. Precondition: places_camera_later, and a frame was seen.
    PageRun so_far(const CameraDescription& placed) const;

private:
    void add_bodies(const Snapshot& snapshot);
    void add_camera(const Snapshot& snapshot);
    void add_impacts(const ContactRecords& records);
    void add_contacts(std::vector<ContactRecord> contacts);
    void add_joints(const Snapshot& snapshot, const Survey& survey);
    std::size_t add_event(std::size_t body, const ImpactRecord& impact, const StruckBody& struck, std::size_t& event);
    double acting_time(const ImpactTime& when) const;

    PageRun run_;
    CameraAnimation camera_;
    ScaleSurvey scales_;
    bool places_camera_later_;
    std::vector<Quantity> joint_quantities_;
    std::size_t contacts_a_frame_;
    std::vector<std::size_t> events_;  // of the frame, by struck body: the body's event
    std::vector<Snapshot> snapshots_;  // for a camera that is placed later: the first one, or all if it moves
};

}  // namespace tumble
