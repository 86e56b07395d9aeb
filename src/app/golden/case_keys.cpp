#include "app/golden/suite.h"

#include "scene/toml/limits.h"
#include "sim/frames/clip_timing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <string>

namespace tumble {
namespace {

constexpr Choice<PanelArrangement> arrangements[] = {
    {"row", PanelArrangement::row},
    {"grid", PanelArrangement::grid},
};
constexpr Range speeds{slowest_speed, fastest_speed};
constexpr Range shutters{0.0, 360.0, "degrees"};
constexpr std::size_t most_images = 1000;  // of a case: more are a clip, not references

/// Looks a key up in the case, then in the defaults, and remembers its place.
class CaseTable {
public:
    CaseTable(const TomlTable& own, const std::optional<TomlTable>& defaults, GoldenCase& golden)
        : own_(own), defaults_(defaults), golden_(golden) {}

    std::optional<TomlValue> find(std::string_view key) {
        std::optional<TomlValue> value = own_.find(key);
        if (!value && defaults_) value = defaults_->find(key);
        if (value) golden_.places.insert_or_assign(std::string(key), value->origin().where);
        return value;
    }
    template <class Target, class Read>
    void read(std::string_view key, Target& target, const Read& read) {
        if (const std::optional<TomlValue> value = find(key)) target = read(*value);
    }

private:
    const TomlTable& own_;
    const std::optional<TomlTable>& defaults_;
    GoldenCase& golden_;
};

/// A text, or an array of them.
std::vector<std::string> texts(const TomlValue& value) {
    if (value.is_text()) return {value.text()};
    std::vector<std::string> list;
    for (const TomlValue& item : value.items()) list.push_back(item.text());
    return list;
}

/// "velocity,clock" or ["velocity", "clock"]; an empty array is "none".
std::string joined_list(const TomlValue& value) {
    const std::vector<std::string> list = texts(value);
    return list.empty() ? "none" : fmt::format("{}", fmt::join(list, ","));
}

std::vector<std::int64_t> read_frames(const TomlValue& value) {
    std::vector<std::int64_t> frames;
    for (const TomlValue& item : value.items()) {
        frames.push_back(item.integer(0, limits::frames));
        if (frames.size() > 1 && frames.back() <= frames[frames.size() - 2])
            item.fail("must be larger than the number before it");
    }
    if (frames.empty() || frames.size() > most_images)
        value.fail(fmt::format("must have 1 to {} numbers of frames", most_images));
    return frames;
}

/// Files of a folder begin with it, and reports and patterns name it.
void check_name(const TomlValue& value) {
    const std::string name = value.text();
    const auto valid = [](char c) {
        return c == '_' || c == '-' || c == '+' || c == ',' || c == '.' || (c >= '0' && c <= '9') ||
               (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    if (name.empty() || name.front() == '.' || name.front() == '-' || name.size() > 200 ||
        !std::ranges::all_of(name, valid))
        value.fail("must have 1 to 200 of the characters A-Z a-z 0-9 _ - + , . and begin with none of - and .");
}

void read_scenes(CaseTable& table, const TomlTable& own, const std::filesystem::path& folder, GoldenCase& golden) {
    const std::optional<TomlValue> one = table.find("scene"), many = table.find("scenes");
    if (one && many) many->fail("and scene exclude each other: give one of them");
    if (!one && !many)
        throw InputError(own.origin().where, "a case needs \"scene\", the path of a scene file (not given)");
    for (const std::string& scene : one ? std::vector<std::string>{one->text()} : texts(*many)) {
        if (scene.empty()) (one ? *one : *many).fail("must not be empty");
        golden.scenes.push_back((folder / scene).lexically_normal());
    }
    if (golden.scenes.empty()) many->fail("must name a scene");
}

void read_overrides(CaseTable& table, GoldenCase& golden) {
    SceneOverrides& overrides = golden.overrides;
    if (const auto size = table.find("size")) {
        const std::vector<TomlValue> sides = size->items(2, "whole numbers, width and height");
        overrides.width = int(sides[0].integer(1, limits::image_side));
        overrides.height = int(sides[1].integer(1, limits::image_side));
    }
    table.read("fps", overrides.fps, [](const TomlValue& v) { return v.frame_rate(); });
    table.read("duration", overrides.duration, [](const TomlValue& v) { return v.number(limits::duration); });
    table.read("samples", overrides.samples, [](const TomlValue& v) { return int(v.integer(1, 4)); });
    table.read("method", overrides.method, [](const TomlValue& v) { return v.text(); });
    table.read("overlay", overrides.overlay, joined_list);
    table.read("plot", overrides.plot, joined_list);
    table.read("plot_place", overrides.plot_place, [](const TomlValue& v) { return v.text(); });
    table.read("set", overrides.set, [](const TomlValue& v) { return texts(v); });
    if (const auto seed = table.find("seed"))
        overrides.set.push_back(
            fmt::format("simulation.seed={}", seed->integer(0, std::numeric_limits<std::int64_t>::max())));
}

void read_drawing(CaseTable& table, GoldenCase& golden) {
    table.read("vary", golden.vary, [](const TomlValue& v) { return texts(v); });
    if (const auto layout = table.find("layout")) golden.arrangement = layout->choice<PanelArrangement>(arrangements);
    table.read("transparent", golden.transparent, [](const TomlValue& v) { return v.boolean(); });
    table.read("speed", golden.speed, [](const TomlValue& v) { return v.number(speeds); });
    table.read("shutter", golden.shutter, [](const TomlValue& v) { return v.number(shutters); });
    table.read("blur_samples", golden.blur_samples,
               [](const TomlValue& v) { return int(v.integer(2, most_blur_samples)); });
}

/// A case with `of` is a plot: keys of a clip have no meaning.
void check_plot(const TomlTable& own, const GoldenCase& golden) {
    for (const char* key :
         {"frames", "plot", "plot_place", "layout", "transparent", "speed", "shutter", "blur_samples"})
        if (const auto value = own.find(key)) value->fail("has no meaning in a plot: the case has \"of\"");
    if (golden.of->empty()) own.require("of").fail("must name a quantity, as in [\"energy\"]");
}

}  // namespace

void check_default_keys(const TomlTable& defaults) {
    defaults.expect_keys({"frames", "size", "fps", "duration", "samples", "method", "overlay", "plot", "plot_place",
                          "set", "seed", "layout", "transparent", "speed", "shutter", "blur_samples"});
}

Tolerances read_tolerances(const TomlValue& value, const std::filesystem::path& folder, const PairTolerances& base) {
    if (value.is_text()) return Tolerances::read(folder / value.text(), base);
    return Tolerances::of_table(value.table(), folder, base);
}

GoldenCase read_case(const TomlTable& own, const std::optional<TomlTable>& defaults, const GoldenSuite& suite) {
    const std::filesystem::path folder = suite.file.parent_path();
    own.expect_keys({"name",        "scene",   "scenes",  "frames",       "size", "fps",       "duration", "samples",
                     "method",      "overlay", "plot",    "plot_place",   "set",  "seed",      "vary",     "layout",
                     "transparent", "speed",   "shutter", "blur_samples", "of",   "tolerances"});
    GoldenCase golden;
    golden.where = own.origin().where;
    CaseTable table(own, defaults, golden);
    read_scenes(table, own, folder, golden);
    if (const auto name = table.find("name")) {
        check_name(*name);
        golden.name = name->text();
    } else {
        golden.name = golden.scenes.front().stem().string();
    }
    table.read("of", golden.of, joined_list);
    if (const auto tolerances = own.find("tolerances"))
        golden.tolerances = read_tolerances(*tolerances, folder, suite.tolerances.of(golden.image_name(0)));
    read_overrides(table, golden);
    read_drawing(table, golden);
    if (golden.of) {
        check_plot(own, golden);
    } else {
        table.read("frames", golden.frames, read_frames);
    }
    return golden;
}

}  // namespace tumble
