// A recorded run of a scene, as plain values: everything that a page shows of it.
#pragma once

#include "overlay/overlay_scales.h"
#include "scene/description/description.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/report.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

/// A body at a frame; world frame.
struct BodySample {
    Vec3 position = Vec3::Zero();  // m, of the center of mass
    Quat rotation = Quat::Identity();
    Vec3 velocity = Vec3::Zero();          // m/s, of the center of mass
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
    bool asleep = false;
};

/// A body at an impact of it.
struct BodyEvent {
    double time = 0.0;  // s, when the body is there: the start of the step, where a step resolves the impact
    StruckBody body;
    bool exact = false;  // true if that is also the impact's time; otherwise the impact has the time of the step's end
};

struct BodyRecord {
    std::vector<BodySample> samples;        // by frame; a single one of a fixed body
    std::vector<BodyEvent> events;          // in order of time
    bool all_events = true;                 // false: there were more than are kept
    std::vector<std::int64_t> absent_from;  // frames where it vanishes and appears in turn (BodyState::absent)
};

struct PageImpact {
    ImpactRecord record;
    std::size_t event_a = 0, event_b = 0;  // indices into the bodies' events; may be past the end of those kept
};

/// A row of the energy table, J.
struct EnergySample {
    double kinetic_linear = 0.0, kinetic_angular = 0.0, potential = 0.0, elastic = 0.0;
    double work = 0.0, impact_loss = 0.0, friction_loss = 0.0;  // since the start
    double contacts = 0.0;                                      // touching contact points
    double max_penetration = 0.0;                               // m, deepest overlap
};

/// A quantity of a joint over the run.
struct JointColumn {
    std::string name;            // as plots name it: "joint.hinge.force"
    std::vector<double> values;  // by frame
};

struct PageRun {
    std::string label;       // tells it from the other runs of a clip; empty if it is the only one
    SceneDescription scene;  // with its own timing
    std::string integrator;  // its name in a scene file
    std::int64_t frames = 0;
    std::vector<double> pace;  // s, the times of a clip's frames where its speed changes ([[speed]]); otherwise empty
    std::vector<BodyReport> reports;         // by body
    std::vector<BodyRecord> bodies;          // by body
    std::vector<CameraDescription> cameras;  // one, or one a frame if it moves
    std::vector<EnergySample> energy;        // by frame
    std::vector<JointColumn> joints;         // quantities that plots name
    std::vector<PageImpact> impacts;         // in order of time; the strongest, if there are too many
    std::int64_t all_impacts = 0;            // in the run
    // by frame; the contacts with the largest forces, if there are too many
    std::vector<std::vector<ContactRecord>> contacts;
    std::int64_t all_contacts = 0;                      // of all frames
    std::vector<std::vector<ExternalLoad>> loads;       // by frame
    std::vector<std::vector<JointState>> joint_states;  // by frame, then by joint
    OverlayScales scales{};
};

}  // namespace tumble
