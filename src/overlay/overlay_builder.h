// Makes the shapes of each frame from the state of the bodies and the log of contacts. It keeps the history that
// trails, ghosts and visible impulses need, so frames are given in order and once each.
#pragma once

#include "overlay/body_labels.h"
#include "overlay/crack_sketch.h"
#include "overlay/joint_sketch.h"
#include "overlay/overlay_frame.h"
#include "overlay/overlay_scales.h"
#include "scene/description/description.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace tumble {

class OverlayBuilder {
public:
    /// `scene` must outlive it.
    OverlayBuilder(const SceneDescription& scene, const OverlayScales& scales);

    /// The shapes of the next frame. `records`: of this frame, or null if none are kept. The result is valid until the
    /// next call.
    const OverlayFrame& next(const Snapshot& snapshot, const ContactRecords* records);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [scene, scales, shown, radii, joints, cracks, labels, trails, ghosts, frames, impacts, frame] = self;
        archive.rebuilt(scene, scales, shown, radii, joints, cracks, labels);
        archive.expect_bodies(radii.size());
        archive.keep(ghosts, impacts);
        archive.count(frames);
        archive.keep_each(trails);
        archive.scratch(frame);
    }

private:
    struct Trail {
        std::size_t body;
        Vec3 point;   // body frame, from the body's origin; unused for the center of mass
        bool center;  // of the center of mass
        Color color;
        std::deque<std::pair<double, Vec3>> places;  // times (s) and places (m)
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [body, point, center, color, places] = self;
            archive.rebuilt(body, point, center, color);
            archive.keep(places);
        }
    };
    struct Ghost {
        std::size_t body;
        BodyState state;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [body, state] = self;
            archive.body(body);
            archive.keep(state);
        }
    };
    void remember(const Snapshot& snapshot, const ContactRecords* records);
    void add_ghosts(const Snapshot& snapshot, std::int64_t frame);
    void add_trails();
    void add_contacts(const ContactRecords& records);
    void add_loads(const Snapshot& snapshot);
    void add_joints(const Snapshot& snapshot, const ContactRecords& records);
    void add_impulses(double time);
    void add_body(std::size_t body, const BodyState& state);
    void add_box(std::size_t body, const BodyState& state);
    void add_axes(std::size_t body, const BodyState& state);
    void add_cracks(const Snapshot& snapshot);
    void add_islands(const Snapshot& snapshot, const ContactRecords& records);
    void body_arrow(ArrowQuantity quantity, std::size_t body, const BodyState& state, const Vec3& value);
    void arrow(ArrowQuantity quantity, const Vec3& from, const Vec3& value, float opacity = 1.0f);
    bool shows(Overlay overlay) const { return scene_->overlay.show.has(overlay); }
    bool shows(std::size_t body, const Snapshot& snapshot) const;

    const SceneDescription* scene_;
    OverlayScales scales_;
    std::vector<char> shown_;    // by body
    std::vector<double> radii_;  // m, of a ball about the origin that contains the body; 0 of planes
    std::vector<JointSketch> joints_;
    std::vector<CrackSketch> cracks_;
    BodyLabels labels_;
    std::vector<Trail> trails_;
    std::vector<Ghost> ghosts_;
    std::int64_t frames_ = 0;  // of the clip so far: with a shutter, the frames of snapshots are parts of these
    std::deque<ImpactRecord> impacts_;  // rings that are still visible
    OverlayFrame frame_;
};

/// Radius (m) of a ball about the body's origin that contains the shape; 0 of planes.
double radius_about_origin(const Shape& shape);
/// The color of the arrows of a quantity.
Color arrow_color(const OverlayDescription& overlay, ArrowQuantity quantity);
/// Color of contact points, by state.
Color contact_color(ContactRecord::State state);
MarkerShape contact_shape(ContactFeatures features);

}  // namespace tumble
