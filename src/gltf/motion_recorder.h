// The motion of all bodies and of the camera as keys, recorded moment by moment.
#pragma once

#include "gltf/key_track.h"
#include "scene/description/description.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"

#include <optional>
#include <vector>

namespace tumble {

/// Tolerances of the keys at the samples, in double precision. Below the rounding of single precision at 40 m.
inline constexpr double key_tolerance = 5e-6;           // m
inline constexpr double key_rotation_tolerance = 4e-6;  // rad

/// The keys of a node: position and rotation.
struct PoseKeys {
    KeyTrack<3> position;
    KeyTrack<4> rotation;

    PoseKeys(KeyKind kind, bool velocities)
        : position(kind, key_tolerance, velocities), rotation(kind, key_rotation_tolerance, velocities) {}
};

/// Orientation of a camera that looks along -z with y up, as in glTF.
Quat camera_rotation(const CameraDescription& camera);

class MotionRecorder {
public:
    /// `reports`: of all bodies. The scene must outlive the recorder.
    MotionRecorder(const SceneDescription& scene, std::vector<BodyReport> reports, KeyKind kind);

    /// Adds the next moment. `camera`: its pose then. `records`: since the moment before; null: without impacts at
    /// times of their own.
    void add(const Snapshot& snapshot, const CameraDescription& camera, const ContactRecords* records);
    void finish();

    /// By body: of its center of mass if it is dynamic, otherwise of its origin.
    const std::vector<PoseKeys>& bodies() const { return bodies_; }
    /// By body: when it vanishes and appears in turn, s (BodyState::absent).
    const std::vector<std::vector<double>>& absent_from() const { return absent_from_; }
    const PoseKeys& camera() const { return camera_; }
    /// Node of a body relative to the body's origin, body frame, m.
    Vec3 node_place(std::size_t body) const;
    /// Bounds of the nodes of all bodies except planes, over the whole motion.
    const Bounds& bounds() const { return bounds_; }
    double position_error() const;  // m, the largest of all keys
    double rotation_error() const;  // rad

private:
    struct Pose {
        double time = 0.0;  // s
        Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
        Quat rotation = Quat::Identity();
        Vec3 angular_velocity = Vec3::Zero(), angular_momentum = Vec3::Zero();
    };
    struct Impacts {
        double first = infinity, last = -infinity;  // s
    };

    Pose pose_of(std::size_t body, const Snapshot& snapshot) const;
    Pose flown(std::size_t body, const Pose& from, double time) const;
    void add_impacts(std::size_t body, const Impacts& impacts, const Pose& now);
    void add_keyframes(std::size_t body, const Pose& now);
    void add_corner(std::size_t body, const Pose& before, const Pose& after);
    void add_pose(PoseKeys& keys, const Pose& pose);

    const SceneDescription& scene_;
    std::vector<BodyReport> reports_;
    std::vector<PoseKeys> bodies_;
    std::vector<std::vector<double>> absent_from_;
    std::vector<Pose> last_;        // by body
    std::vector<Impacts> impacts_;  // by body
    PoseKeys camera_;
    Quat last_camera_ = Quat::Identity();
    double last_time_ = 0.0;  // s
    bool started_ = false;
    Bounds bounds_;
};

}  // namespace tumble
