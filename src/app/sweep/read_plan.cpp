#include "app/sweep/sweep_plan.h"

#include "app/sweep/read_axis.h"
#include "app/sweep/sweep_sample.h"
#include "core/error.h"
#include "scene/toml/limits.h"
#include "scene/toml/toml_reader.h"
#include "scene/toml/toml_text.h"
#include "sim/frames/clip_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t readable_format = 1;
constexpr std::int64_t most_samples = 10'000'000;
constexpr std::int64_t plan_bytes = 64 << 20;  // a list of a million values is about 20 MB
constexpr Range factor{-1e12, 1e12, ""};

constexpr Choice<Combination> combinations[] = {
    {"product", Combination::product}, {"zip", Combination::zip}, {"random", Combination::random}};
constexpr Choice<VideoQuality> qualities[] = {
    {"draft", VideoQuality::draft}, {"normal", VideoQuality::normal}, {"best", VideoQuality::best}};
constexpr Choice<GlBackend> backends[] = {
    {"software", GlBackend::software}, {"osmesa", GlBackend::osmesa}, {"egl", GlBackend::egl}};
constexpr Choice<SceneForm> forms[] = {{"toml", SceneForm::toml}, {"json", SceneForm::json}, {"none", SceneForm::none}};
constexpr Choice<bool> table_formats[] = {{"csv", false}, {"npz", true}};

void check_format(const TomlTable& root) {
    const auto format = root.find("format");
    if (!format) throw InputError(root.origin().where, "a plan starts with \"format = 1\" (not given)");
    if (format->integer(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()) !=
        readable_format)
        format->fail(fmt::format("must be {}, the only one there is", readable_format));
}

/// "PATH=VALUE" of the keys of a table; tables in it, which dotted keys make, continue the path.
void read_fixed(const toml::table& table, const std::string& path, std::vector<std::string>& fixed) {
    for (const auto& [key, node] : entries_in_order(table)) {
        const std::string inner = path.empty() ? std::string(key->str()) : fmt::format("{}.{}", path, key->str());
        if (const toml::table* more = node->as_table(); more != nullptr && !more->is_inline())
            read_fixed(*more, inner, fixed);
        else
            fixed.push_back(fmt::format("{}={}", inner, toml_value_text(*node)));
    }
}

std::vector<SweepAxis> read_axes(const TomlTable& root) {
    std::vector<SweepAxis> axes;
    const auto list = root.find("axis");
    if (!list) return axes;
    std::set<std::string> names, paths;
    for (TomlTable& table : list->tables("; write [[axis]] for each")) {
        table.set_title("[[axis]]");
        axes.push_back(read_axis(table));
        const SweepAxis& axis = axes.back();
        if (!names.insert(axis.name).second)
            table.require(table.has("name") ? "name" : "path").fail("must be unique, and another axis has it");
        for (const std::string& path : axis.paths)
            if (!paths.insert(path).second)
                table.require(table.has("path") ? "path" : "paths").fail("must be unique, and another axis sets it");
    }
    return axes;
}

/// Lists that are zipped have one length.
void check_lists(const TomlTable& root, const SweepPlan& plan) {
    std::int64_t size = -1, product = 1;
    std::size_t i = 0;
    if (plan.axes.empty()) return;
    for (const TomlTable& table : root.require("axis").tables()) {
        const SweepAxis& axis = plan.axes[i++];
        if (!axis.is_list()) continue;
        const auto own = std::int64_t(axis.list_size());
        const TomlValue given = table.require(table.has("values") ? "values" : "range");
        if (plan.combination == Combination::zip && size >= 0 && own != size)
            given.origin().fail(fmt::format("must have as many values as the lists before, {} (given {})", size, own));
        size = own;
        product = plan.combination == Combination::product ? product * own : own;
        if (product > most_samples) given.origin().fail(fmt::format("makes more than {} combinations", most_samples));
    }
}

std::int64_t read_samples(const TomlTable& root, const SweepPlan& plan) {
    const auto given = root.find("samples");
    const std::int64_t each = plan.pair ? 2 : 1;
    const bool lists = std::any_of(plan.axes.begin(), plan.axes.end(), [](const SweepAxis& a) { return a.is_list(); });
    if (!given) {
        if (lists && plan.combination != Combination::random) return each * plan.combinations();
        if (plan.axes.empty()) return 1;
        throw InputError(
            root.origin().where,
            "a plan without lists, or with random ones, needs \"samples\", the number of samples (not given)");
    }
    const std::int64_t samples = given->integer(1, most_samples);
    if (samples % each != 0) given->fail("must be even, because each pair has two samples");
    return samples;
}

std::size_t axis_named(const TomlValue& name, const SweepPlan& plan) {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < plan.axes.size(); ++i) {
        if (plan.axes[i].name == name.text()) return i;
        known.push_back(plan.axes[i].name);
    }
    name.origin().fail(fmt::format("names no axis: \"{}\"{}", safe_text(name.text()), suggestion(name.text(), known)));
}

PairPlan read_pair(const TomlTable& table, const SweepPlan& plan) {
    table.expect_keys({"differ", "factor", "offset", "b"});
    PairPlan pair;
    const TomlValue differ = table.require("differ");
    if (differ.is_array())
        for (const TomlValue& name : differ.items()) pair.axes.push_back(axis_named(name, plan));
    else
        pair.axes.push_back(axis_named(differ, plan));
    if (pair.axes.empty()) differ.fail("must name an axis");
    if (table.has("factor") || table.has("offset")) {
        PairFactor by;
        table.read("factor", by.factor, factor);
        table.read("offset", by.offset, factor);
        if (by.factor == 1.0 && by.offset == 0.0)
            table.require(table.has("factor") ? "factor" : "offset").fail("must make another value");
        pair.value = by;
    }
    if (const auto b = table.find("b")) {
        if (pair.value.index() != 0) b->origin().fail("excludes \"factor\" and \"offset\"");
        TomlTable source = b->table();
        source.set_title("b");
        source.expect_keys(
            {"values", "range", "distribution", "min", "max", "mean", "deviation", "weights", "decimals"});
        pair.value = OtherSource{read_source(source)};
    }
    if (pair.value.index() == 0)
        for (const std::size_t axis : pair.axes)
            if (plan.axes[axis].is_list() && plan.axes[axis].list_size() < 2)
                differ.fail("must name an axis with two values, or one that draws them");
    return pair;
}

void read_tables(const TomlValue& list, SampleOutputs& outputs) {
    const std::vector<std::pair<std::string_view, bool*>> known = {
        {"trajectory", &outputs.trajectory}, {"energy", &outputs.energy}, {"impacts", &outputs.impacts},
        {"contacts", &outputs.contacts},     {"loads", &outputs.loads},   {"joints", &outputs.joints}};
    std::vector<std::string_view> names;
    for (const auto& [name, wanted] : known) names.push_back(name);
    for (const TomlValue& item : list.items()) {
        const std::string name = item.text();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            item.origin().fail(fmt::format("has the unknown name \"{}\"{}", safe_text(name), suggestion(name, names)));
        *known[std::size_t(found - names.begin())].second = true;
    }
}

void read_aovs(const TomlValue& list, AovSet& aovs) {
    if (list.is_text() && list.text() == "all") {
        for (const Aov aov : all_aovs) aovs.add(aov);
        return;
    }
    if (!list.is_array()) list.fail("must be \"all\" or an array of names");
    std::vector<std::string_view> names;
    for (const Aov aov : all_aovs) names.push_back(name_of(aov));
    for (const TomlValue& item : list.items()) {
        const std::string name = item.text();
        const auto aov = aov_named(name);
        if (!aov)
            item.origin().fail(fmt::format("has the unknown name \"{}\"{}", safe_text(name), suggestion(name, names)));
        aovs.add(*aov);
    }
}

SampleOutputs read_outputs(const TomlTable& table) {
    table.expect_keys({"frames", "clip", "aov", "tables", "table_format", "scene"});
    SampleOutputs outputs;
    table.read("frames", outputs.frames);
    if (const auto clip = table.find("clip")) {
        outputs.clip = clip->text();
        if (outputs.clip.empty() || outputs.clip.front() == '.' || outputs.clip.find('/') != std::string::npos)
            clip->fail("must be a file name such as \"clip.mp4\"");
        if (has_control_characters(outputs.clip)) clip->fail("must have no control characters");
        for (const char* taken : {"sample.json", "scene.toml", "scene.json", "frames", "aov"})
            if (outputs.clip == taken) clip->fail("must differ from the other files of a sample");
    }
    if (const auto aov = table.find("aov")) read_aovs(*aov, outputs.aovs);
    if (const auto tables = table.find("tables")) read_tables(*tables, outputs);
    table.read<bool>("table_format", outputs.arrays, table_formats);
    table.read<SceneForm>("scene", outputs.scene, forms);
    return outputs;
}

SampleDrawing read_drawing(const TomlTable& table) {
    table.expect_keys({"start", "speed", "shutter", "blur_samples", "transparent", "quality", "gl"});
    SampleDrawing drawing;
    table.read("start", drawing.start, limits::duration);
    table.read("speed", drawing.speed, Range{slowest_speed, fastest_speed, ""});
    table.read("shutter", drawing.shutter, Range{0.0, 360.0, "degrees"});
    if (const auto samples = table.find("blur_samples"))
        drawing.blur_samples = int(samples->integer(2, most_blur_samples));
    table.read("transparent", drawing.transparent);
    table.read<VideoQuality>("quality", drawing.quality, qualities);
    table.read<GlBackend>("gl", drawing.backend, backends);
    return drawing;
}

void check_names(const TomlTable& root, const SweepPlan& plan) {
    const auto given = root.find("name");
    const SourcePosition at = given ? given->origin() : SourcePosition{"name", root.origin().where};
    try {
        check_name_template(plan);
        if (names_each_index(plan)) return;
    } catch (const InputError& error) {
        at.fail(fmt::format("{} (given \"{}\")", error.message(), safe_text(plan.name)));
    }
    std::set<std::string> names;
    for (std::int64_t i = 0; i < plan.samples; ++i) {
        const std::string name = sample_of(plan, i).name;
        if (!names.insert(name).second)
            at.fail(fmt::format("gives two samples the name \"{}\": add {{index}} to it (given \"{}\")",
                                safe_text(name), safe_text(plan.name)));
    }
}

}  // namespace

SweepPlan read_plan(const fs::path& file) {
    const toml::table document = parse_toml(read_toml_file(file, "plan", plan_bytes), file.string());
    const TomlTable root(document, {"plan", {file.string(), 1, 1}}, "a plan");
    check_format(root);
    root.expect_keys(
        {"format", "scene", "name", "seed", "combine", "samples", "set", "axis", "pair", "outputs", "render"});
    SweepPlan plan;
    plan.file = file;
    plan.scene = file.parent_path() / root.require("scene").text();
    root.read("name", plan.name);
    if (const auto seed = root.find("seed"))
        plan.seed = std::uint64_t(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
    root.read<Combination>("combine", plan.combination, combinations);
    if (const auto set = root.find_table("set")) read_fixed(set->table(), "", plan.fixed);
    plan.axes = read_axes(root);
    check_lists(root, plan);
    if (const auto pair = root.find_table("pair")) plan.pair = read_pair(*pair, plan);
    plan.samples = read_samples(root, plan);
    if (const auto outputs = root.find_table("outputs")) plan.outputs = read_outputs(*outputs);
    if (const auto render = root.find_table("render")) plan.drawing = read_drawing(*render);
    check_names(root, plan);
    return plan;
}

}  // namespace tumble
