// Recorded bodies on the screen.
#pragma once

#include "app/causes/motion_record.h"
#include "render/camera/camera.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

/// A panel at one of its recorded frames.
class PanelView {
public:
    /// `changed`: the part of the image that counts; all of it if empty.
    PanelView(const PanelRecord& panel, std::size_t recorded, const Rectangle& changed = {});

    const PanelRecord& panel() const { return panel_; }
    const RecordedView& view() const { return panel_.views[recorded_]; }
    double time() const { return panel_.times[recorded_]; }  // s
    const RecordedPose& pose(std::size_t body) const;

    /// Bounds of a body on the screen, in pixels of the image, cut at the panel; empty without a part in view. The
    /// whole panel for a body without bounds, and for one that reaches behind the eye.
    Rectangle bounds(std::size_t body) const;

    /// Pixels of these bounds in the part of the image that counts.
    double changed_pixels(std::size_t body) const;

    /// Largest distance between the places of a point of the body in two poses, pixels; infinity if a point is behind
    /// the eye.
    double distance(std::size_t body, const RecordedPose& a, const RecordedPose& b) const;
    /// The same of the center of its bounds.
    double center_distance(std::size_t body, const RecordedPose& a, const RecordedPose& b) const;

private:
    std::optional<Eigen::Vector2d> pixel(const Vec3& world) const;

    const PanelRecord& panel_;
    std::size_t recorded_;
    Rectangle changed_;
    Camera camera_;
    std::vector<std::size_t> moving_index_;  // by body: index into the poses of a frame, if it moves
};

/// The place of a frame in the recorded ones.
std::optional<std::size_t> recorded_index(const MotionRecord& record, std::int64_t frame);

}  // namespace tumble
