#include "app/causes/explain.h"

#include "app/causes/body_changes.h"
#include "app/causes/first_difference.h"
#include "app/causes/value_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tumble {
namespace {

constexpr std::size_t most_causes = 4;
constexpr double whole_image = 1e12, root_cause = 1e13;  // pixels, for the order: beyond what a body covers
constexpr double least_turn = 1e-9;                      // part of a length: rounding of a camera's place

bool same(const Vec3& a, const Vec3& b) { return (a - b).norm() <= least_turn * (1.0 + a.norm()); }

std::string camera_text(const RecordedView& a, const RecordedView& b) {
    std::string parts;
    const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
    if (!same(a.eye, b.eye)) add(fmt::format("eye moved by {:.2g} m", (a.eye - b.eye).norm()));
    if (!same(a.target, b.target)) add(fmt::format("target moved by {:.2g} m", (a.target - b.target).norm()));
    if (!same(a.up, b.up)) add("up turned");
    if (std::abs(a.vertical_fov - b.vertical_fov) > least_turn)
        add(fmt::format("vertical_fov {} to {}", a.vertical_fov, b.vertical_fov));
    return parts;
}

void add_camera(const PanelView& before, const PanelView& after, std::vector<Cause>& causes) {
    const std::string text = camera_text(before.view(), after.view());
    if (!text.empty()) causes.push_back({fmt::format("camera ({})", text), whole_image});
}

/// Values that change the image by themselves.
bool is_seen(std::string_view key) { return key == "cords" || key.starts_with("light.") || key.starts_with("overlay"); }

std::string seen_text(const ValueDifference& one) {
    const std::string change = value_change_text(one.before, one.after);
    if (one.key == "light.shadows")
        return fmt::format("shadow only (shadows are {})",
                           one.after == "true" ? "on, they were off" : "off, they were on");
    if (one.key.starts_with("light.")) return fmt::format("light ({} {})", one.key.substr(6), change);
    return fmt::format("{} ({})", one.key, change);
}

void add_seen_values(const std::vector<ValueDifference>& values, std::vector<Cause>& causes) {
    for (const ValueDifference& one : values)
        if (is_seen(one.key)) causes.push_back({seen_text(one), whole_image});
}

/// Values that change the image by the motion alone.
void add_motion_values(const std::vector<ValueDifference>& values, std::vector<Cause>& causes) {
    for (const ValueDifference& one : values)
        if (!is_seen(one.key))
            causes.push_back({fmt::format("{} ({})", one.key, value_change_text(one.before, one.after)), root_cause});
}

std::string late_text(std::int64_t late, std::int64_t frame) {
    const std::int64_t count = std::abs(late);
    return fmt::format("{} frame{} {} (it shows frame {} of the reference)",
                       count == 1 ? "one" : fmt::format("{}", count), count == 1 ? "" : "s",
                       late > 0 ? "late" : "early", frame - late);
}

/// A frame, and the places of its poses in the two records.
struct FramePlace {
    std::int64_t frame;
    std::size_t before, after;
    Rectangle changed;       // of the image
    bool whole_run = false;  // the image shows all of the motion
};

void add_motion(const PanelView& before, const PanelView& after, const BodyPairs& pairs, const FramePlace& place,
                std::vector<Cause>& causes) {
    std::vector<Cause> moves =
        place.whole_run ? run_changes(before, after, pairs) : motion_changes(before, after, pairs);
    if (moves.empty()) return;
    if (const auto late = place.whole_run ? std::nullopt : frames_late(before.panel(), after.panel(), place.frame)) {
        causes.push_back({late_text(*late, place.frame), root_cause});
        return;
    }
    std::vector<Cause> roots = matter_changes(before, after, pairs);
    for (Cause& root : roots) root.pixels = root_cause;
    add_motion_values(value_differences(before.panel().values, after.panel().values), roots);
    std::ranges::move(roots, std::back_inserter(causes));
    std::ranges::move(moves, std::back_inserter(causes));
}

std::vector<Cause> panel_causes(const PanelRecord& a, const PanelRecord& b, const FramePlace& place) {
    const PanelView before(a, place.before, place.changed), after(b, place.after, place.changed);
    const BodyPairs pairs(a, b);
    std::vector<Cause> causes;
    add_camera(before, after, causes);
    add_seen_values(value_differences(a.values, b.values), causes);
    std::ranges::move(appearance_changes(before, after, pairs), std::back_inserter(causes));
    add_motion(before, after, pairs, place, causes);
    return causes;
}

void add_image_values(const MotionRecord& before, const MotionRecord& after, std::vector<Cause>& causes) {
    for (const ValueDifference& one : value_differences(before.values, after.values)) {
        const std::string change = value_change_text(one.before, one.after);
        const bool text = one.key.starts_with("text.");
        causes.push_back(
            {text ? fmt::format("text ({}: {})", one.key.substr(5), change) : fmt::format("{} ({})", one.key, change),
             whole_image});
    }
}

/// Causes without pixels cannot be seen: they stay only if there are no others.
void keep_visible(std::vector<Cause>& causes) {
    const auto unseen = [](const Cause& cause) { return !(cause.pixels > 0.0); };
    if (!std::ranges::all_of(causes, unseen)) std::erase_if(causes, unseen);
}

std::vector<std::string> sentences(std::vector<Cause> causes) {
    keep_visible(causes);
    std::ranges::stable_sort(causes, std::greater<>(), &Cause::pixels);
    std::vector<std::string> texts;
    for (const Cause& cause : causes) {
        if (texts.size() == most_causes) {
            texts.push_back(fmt::format("and {} more", causes.size() - most_causes));
            break;
        }
        texts.push_back(cause.text);
    }
    return texts;
}

}  // namespace

std::vector<std::string> causes_between(const MotionRecord& before, const MotionRecord& after, std::int64_t frame,
                                        const Rectangle& changed) {
    const auto a = recorded_index(before, frame), b = recorded_index(after, frame);
    if (!a || !b) return {};
    std::vector<Cause> causes;
    add_image_values(before, after, causes);
    if (before.panels.size() != after.panels.size()) {
        causes.push_back({fmt::format("panels ({} to {})", before.panels.size(), after.panels.size()), root_cause});
        return sentences(std::move(causes));
    }
    for (std::size_t i = 0; i < before.panels.size(); ++i) {
        for (Cause& cause :
             panel_causes(before.panels[i], after.panels[i], {frame, *a, *b, changed, before.whole_run})) {
            if (before.panels.size() > 1) cause.text += fmt::format(" in panel {}", i + 1);
            causes.push_back(std::move(cause));
        }
    }
    return sentences(std::move(causes));
}

}  // namespace tumble
