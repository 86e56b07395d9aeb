// The simulation: the bodies, and the function that advances them by a step.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/break_record.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/joint_report.h"
#include "sim/snapshot/joint_state.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tumble {

class CheckpointReader;
class CheckpointWriter;

class World {
public:
    /// Builds the bodies: masses, inertia tensors, hulls. `threads` changes the time taken, never a byte of the result.
    explicit World(const SceneDescription& scene, int threads = 1);
    /// The same with another rate of frames and steps than the scene's.
    World(const SceneDescription& scene, const FrameTiming& timing, int threads);
    ~World();
    World(World&&) noexcept;

    /// One fixed step. Throws RunError naming the step and the body when a state stops being finite.
    void step();
    /// The steps of one frame; `steps`: of a frame of another length, above 0.
    void advance_frame(std::optional<int> steps = {});
    /// The same; returns the bodies at the middle of the frame: between the two states around it where the number of
    /// steps is odd.
    Snapshot advance_frame_by_middle(std::optional<int> steps = {});

    /// Collects impacts, contacts and energy losses of each frame from now on. The motion is the same.
    void record_contacts();
    /// The same with the energy ledger alone, in far less memory: the lists of the records stay empty, and save() has
    /// none.
    void record_energy();
    /// Records of the last advance_frame(), or of the start. Precondition: record_contacts() or record_energy().
    const ContactRecords& contact_records() const;
    /// The bonds that failed in the last advance_frame().
    const std::vector<BreakRecord>& breaks() const;
    bool records_contacts() const;

    Snapshot snapshot() const;
    /// States of all joints, in the scene's order, at the present time.
    std::vector<JointState> joint_states() const;
    /// Report of the joints that hold now.
    JointReport joint_report() const;
    Measurement measure() const;
    /// Overlaps of the present poses, ascending; without bodies that a joint keeps from colliding.
    std::vector<Overlap> overlaps() const;
    BodyReport report(std::size_t body) const;

    /// Writes the whole state (sim/checkpoint/archive.h). Precondition: no step but those of advance_frame() since the
    /// start.
    void save(CheckpointWriter& writer) const;
    /// Goes on from such a state: all later steps give the bytes of the world that wrote it, for any number of threads.
    /// Preconditions: no step has been done; the other world has the same scene and timing; if this one records
    /// contacts, so did that one. Throws InputError where the bytes are not those of such a state, or the last
    /// precondition does not hold.
    void restore(CheckpointReader& reader);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tumble
