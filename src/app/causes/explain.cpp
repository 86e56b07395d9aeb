#include "app/causes/explain.h"

#include "app/causes/body_changes.h"
#include "app/causes/first_difference.h"
#include "app/causes/motion_record.h"
#include "app/causes/panel_view.h"
#include "app/files/frame_folder.h"
#include "core/color.h"
#include "core/error.h"
#include "output/picture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>

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

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t farthest_neighbor = 3;  // frames
constexpr std::size_t most_searched = 100;     // images of a set for which neighbors are read
constexpr int least_difference = 4;            // levels, beyond the default tolerance
constexpr double same_shade = 0.35;   // of the factors of two channels: measured up to 0.27 for the default sky
constexpr double shaded_share = 0.9;  // of the differing pixels
constexpr double least_light = 0.01;  // linear: darker channels have no ratio

const std::array<double, 256>& linear_levels() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> levels{};
        for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = srgb_to_linear(double(i) / 255.0);
        return levels;
    }();
    return table;
}

/// True if all channels become darker, or all brighter, by similar factors, as by a shadow: the light of the sky in it
/// is not that of the lamp.
bool is_shaded(const std::uint8_t* before, const std::uint8_t* after) {
    double least = infinity, most = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double from = linear_levels()[before[c]], to = linear_levels()[after[c]];
        if (std::max(from, to) < least_light) continue;
        const double ratio = (to + 1e-3) / (from + 1e-3);
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    return (most <= 1.0 || least >= 1.0) && most - least <= same_shade * most;
}

/// True if brightness alone differs.
bool shading_only(const Image& before, const Image& after) {
    if (before.width != after.width || before.height != after.height) return false;
    std::size_t differing = 0, shaded = 0;
    for (std::size_t i = 0; i < before.pixels.size(); i += 4) {
        const std::uint8_t *a = &before.pixels[i], *b = &after.pixels[i];
        int most = 0;
        for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(int(a[c]) - int(b[c])));
        if (most < least_difference) continue;
        ++differing;
        if (a[3] == b[3] && is_shaded(a, b)) ++shaded;
    }
    return differing > 0 && double(shaded) >= shaded_share * double(differing);
}

/// The smallest body in front of which the changed region lies.
std::string body_at(const MotionRecord& record, std::int64_t frame, const Rectangle& changed) {
    const auto recorded = recorded_index(record, frame);
    if (!recorded) return "";
    std::string name;
    double smallest = infinity;
    const int x = changed.x + changed.width / 2, y = changed.y + changed.height / 2;
    for (const PanelRecord& panel : record.panels) {
        if (*recorded >= panel.views.size()) continue;
        const PanelView view(panel, *recorded);
        for (std::size_t i = 0; i < panel.bodies.size(); ++i) {
            const Rectangle r = view.bounds(i);
            const double area = double(r.width) * r.height;
            if (area < smallest && x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height) {
                smallest = area;
                name = panel.bodies[i].name;
            }
        }
    }
    return name;
}

std::string drawing_text(const MotionRecord& record, std::int64_t frame, const ImageResult& result) {
    constexpr const char* same = "the scene, its motion, camera and light are the same";
    if (shading_only(read_picture(result.reference), read_picture(result.image)))
        return fmt::format("shadow only (brightness alone differs; {})", same);
    const std::string body = body_at(record, frame, result.changed);
    return fmt::format("drawing{} ({})", body.empty() ? "" : " at " + body, same);
}

/// The file of the frame so many before; empty if there is none.
fs::path earlier_frame(const fs::path& file, std::int64_t by) {
    const std::string name = file.filename().string();
    const std::size_t digits = name.find_last_of('_') + 1;
    const auto number = number_in(name, name.substr(0, digits), ".png");
    if (!number || *number - by < 0) return {};
    const fs::path other = file.parent_path() / fmt::format("{}{:06}.png", name.substr(0, digits), *number - by);
    std::error_code error;
    return fs::is_regular_file(other, error) ? other : fs::path();
}

/// "one frame late (...)" if the image is another frame of the reference.
std::string late_image(const ImageResult& result) {
    const Image image = read_picture(result.image);
    for (std::int64_t late = 1; late <= farthest_neighbor; ++late)
        for (const std::int64_t by : {late, -late}) {
            const fs::path other = earlier_frame(result.reference, by);
            if (other.empty() || !(read_picture(other) == image)) continue;
            return fmt::format("{} {} (it is {} of the reference)",
                               late == 1 ? "one frame" : fmt::format("{} frames", late), by > 0 ? "late" : "early",
                               other.filename().string());
        }
    return "";
}

/// The records of folders, each read once; null: there is none.
class RecordShelf {
public:
    const MotionRecord* of(const fs::path& folder) {
        const auto [place, is_new] = records_.try_emplace(folder);
        if (is_new) place->second = read(folder / folder_record_name);
        return place->second.get();
    }

private:
    static std::unique_ptr<MotionRecord> read(const fs::path& file) {
        std::error_code error;
        if (!fs::exists(file, error)) return nullptr;
        try {
            return std::make_unique<MotionRecord>(read_motion_record(file));
        } catch (const InputError&) {
            return nullptr;
        }
    }

    std::map<fs::path, std::unique_ptr<MotionRecord>> records_;
};

void explain_frame(RecordShelf& records, bool search, ImageResult& result) {
    const auto frame = number_in(fs::path(result.name).filename().string(), "frame_", ".png");
    if (!frame || result.reference.empty() || result.image.empty()) return;
    if (search)
        if (const std::string late = late_image(result); !late.empty()) {
            result.causes = {late};
            return;
        }
    const MotionRecord* const before = records.of(result.reference.parent_path());
    const MotionRecord* const after = records.of(result.image.parent_path());
    if (before != nullptr && after != nullptr) explain_image(*before, *after, *frame, result);
}

}  // namespace

void explain_image(const MotionRecord& before, const MotionRecord& after, std::int64_t frame, ImageResult& result) {
    result.causes = causes_between(before, after, frame, result.changed);
    const bool both = recorded_index(before, frame) && recorded_index(after, frame);
    if (result.causes.empty() && both) result.causes = {drawing_text(after, frame, result)};
}

void explain_frames(SetResult& result) {
    RecordShelf records;
    std::size_t searched = 0;
    for (ImageResult& image : result.images) {
        if (image.verdict != Verdict::different) continue;
        try {
            explain_frame(records, searched++ < most_searched, image);
        } catch (const InputError&) {
            // Causes are an addition: the verdict stands without them.
        }
    }
}

}  // namespace tumble
