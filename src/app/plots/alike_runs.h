// Runs of --vary that move alike: their value has no effect, which pictures do not tell.
#pragma once

#include "app/survey/survey.h"
#include "scene/description/description.h"

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace tumble {

class AlikeRuns {
public:
    /// `vary`: "PATH=VALUE,VALUE" of each option. Without any, runs may be alike.
    explicit AlikeRuns(std::span<const std::string> vary);

    /// The observer of a run's frames. It lives as long as this object.
    SurveyObserver& add(const std::string& label, const SceneDescription& scene);

    /// Lines that name the runs with the same motion to the last bit, where their scenes differ in a value that could
    /// change it; empty without such runs.
    std::string warning() const;

private:
    struct Run : SurveyObserver {
        void see(const Snapshot& snapshot, const Survey&, const ContactRecords*) override;
        std::string label, scene;  // scene: hash of all that could change the motion
        PairRules rules;
        std::uint64_t motion = 0;  // hash of the poses
    };
    std::string reason(const PairRules& rules) const;

    std::vector<std::string> keys_;  // that vary
    std::deque<Run> runs_;
};

}  // namespace tumble
