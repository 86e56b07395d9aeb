// The numbers of a frame that the observers of a run see.
#pragma once

#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"
#include "sim/world.h"

#include <span>
#include <vector>

namespace tumble {

/// Numbers of a world that cost time, and that a frame has only if an observer needs them.
struct SurveyNeeds {
    bool measurement = false, joints = false;
    SurveyNeeds operator|(const SurveyNeeds& other) const {
        return {measurement || other.measurement, joints || other.joints};
    }
};

/// The numbers of those needs, at the world's present time.
struct Survey {
    Survey() = default;
    Survey(const World& world, const SurveyNeeds& needs);

    Measurement measurement;         // empty unless needed
    std::vector<JointState> joints;  // of all joints in the scene's order; empty unless needed
};

/// Sees every frame of a run in order.
class SurveyObserver {
public:
    virtual ~SurveyObserver() = default;
    virtual SurveyNeeds needs() const { return {}; }
    /// `records`: of the frame (frame_sequence.h), if the world records contacts, otherwise null.
    virtual void see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) = 0;
};

SurveyNeeds needs_of(std::span<SurveyObserver* const> observers);

}  // namespace tumble
