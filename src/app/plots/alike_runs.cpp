#include "app/plots/alike_runs.h"

#include "core/fnv_hash.h"
#include "core/safe_text.h"
#include "scene/hash/scene_hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace tumble {
namespace {

/// The key of "PATH=VALUE,VALUE".
std::string key_of(std::string_view text) {
    const std::string_view path = text.substr(0, text.find('='));
    return std::string(path.substr(path.rfind('.') + 1));
}

/// Without the settings of the output: they change no motion.
std::string hash_of_motion(SceneDescription scene) {
    scene.output = {};
    return motion_hash(scene);
}

std::uint64_t hash_of_numbers(std::span<const double> numbers, std::uint64_t hash) {
    return fnv_hash(std::as_bytes(numbers), hash);
}

}  // namespace

AlikeRuns::AlikeRuns(std::span<const std::string> vary) {
    for (const std::string& text : vary) keys_.push_back(key_of(text));
}

SurveyObserver& AlikeRuns::add(const std::string& label, const SceneDescription& scene) {
    Run& run = runs_.emplace_back();
    run.label = label;
    run.scene = hash_of_motion(scene);
    run.rules = scene.contact;
    return run;
}

void AlikeRuns::Run::see(const Snapshot& snapshot, const Survey&, const ContactRecords*) {
    for (const BodyState& body : snapshot.bodies) {
        motion = hash_of_numbers(std::span(body.origin.data(), 3), motion);
        motion = hash_of_numbers(std::span(body.orientation.coeffs().data(), 4), motion);
    }
}

std::string AlikeRuns::reason(const PairRules& rules) const {
    const bool restitution = std::ranges::find(keys_, "restitution") != keys_.end(),
               friction = std::ranges::find(keys_, "friction") != keys_.end();
    if (restitution && rules.restitution == PairRule::maximum)
        return "of the two restitutions of a pair the larger one acts: leave that of the other body out where it is "
               "fixed or kinematic, or choose another restitution_rule in [contact]";
    if (restitution && rules.restitution == PairRule::minimum)
        return "of the two restitutions of a pair the smaller one acts: raise that of the other body";
    if (friction && (rules.friction == PairRule::geometric || rules.friction == PairRule::multiply))
        return "a pair has no friction where one of its two bodies has friction = 0: leave that of the other body out "
               "where it is fixed or kinematic, or give it a value";
    return "the value has no effect on the motion in this time";
}

std::string AlikeRuns::warning() const {
    if (keys_.empty()) return "";
    std::string lines;
    std::set<std::size_t> named;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        if (named.contains(i)) continue;
        std::vector<std::string> labels{fmt::format("'{}'", safe_text(runs_[i].label))};
        for (std::size_t k = i + 1; k < runs_.size(); ++k) {
            if (runs_[k].motion != runs_[i].motion || runs_[k].scene == runs_[i].scene) continue;
            named.insert(k);
            labels.push_back(fmt::format("'{}'", safe_text(runs_[k].label)));
        }
        if (labels.size() > 1)
            lines += fmt::format("warning: the runs {} move alike to the last bit: {}\n", fmt::join(labels, ", "),
                                 reason(runs_[i].rules));
    }
    return lines;
}

}  // namespace tumble
