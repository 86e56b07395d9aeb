#include "compare/tolerances.h"

#include "compare/glob.h"
#include "compare/platform.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_file = 4 << 20;  // bytes: ten thousand rules
constexpr std::int64_t most_pixels = 1 << 20;   // of a side or a place: beyond any picture (max_image_pixels)
constexpr Range part{0.0, 1.0, ""};
constexpr Range levels_range{0.0, 255.0, "levels"};
constexpr Range similarity{-1.0, 1.0, ""};

Rectangle rectangle_of(const TomlValue& value) {
    const auto number = value.items(4, "whole numbers: x, y, width, height");
    const auto at = [&](std::size_t i, std::int64_t least) { return int(number[i].integer(least, most_pixels)); };
    return {at(0, 0), at(1, 0), at(2, 1), at(3, 1)};
}

FractionRectangle fractions_of(const TomlValue& value) {
    const auto number = value.items(4, "numbers: x, y, width, height");
    const Range size{0.0, 1.0, "", true};
    const FractionRectangle r{number[0].number(part), number[1].number(part), number[2].number(size),
                              number[3].number(size)};
    if (r.x + r.width > 1.0 + 1e-9 || r.y + r.height > 1.0 + 1e-9)
        value.fail("must lie within the picture: x + width and y + height are at most 1");
    return r;
}

std::shared_ptr<const MaskPicture> picture_of(const TomlValue& value, const fs::path& folder) {
    try {
        return MaskPicture::read(folder / value.text());
    } catch (const InputError& error) {
        const std::string name = error.where().file.empty() ? "" : safe_path(error.where().file) + ": ";
        value.fail("cannot be used: " + name + error.message());
    }
}

Mask mask_of(const TomlTable& table, const fs::path& folder) {
    table.expect_keys({"pixels", "fractions", "file"});
    const auto pixels = table.find("pixels"), fractions = table.find("fractions"), file = table.find("file");
    if (int(pixels.has_value()) + int(fractions.has_value()) + int(file.has_value()) != 1)
        throw InputError(table.origin().where, "a mask needs one of \"pixels\", \"fractions\" and \"file\"");
    if (pixels) return {rectangle_of(*pixels)};
    if (fractions) return {fractions_of(*fractions)};
    return {picture_of(*file, folder)};
}

ToleranceValues values_of(const TomlTable& table, const fs::path& folder) {
    ToleranceValues values;
    const auto integer = [&](const char* key, std::optional<int>& to, std::int64_t most) {
        if (const auto value = table.find(key)) to = int(value->integer(0, most));
    };
    if (const auto value = table.find("exact")) values.exact = value->boolean();
    integer("levels", values.levels, 255);
    integer("cluster", values.cluster, 64);
    integer("shade", values.shade, 64);
    table.read("fraction", values.fraction, part);
    table.read("window", values.window, levels_range);
    table.read("ssim", values.ssim, similarity);
    table.read("flip", values.flip, part);
    if (const auto value = table.find("masks")) {
        values.masks.emplace();
        for (TomlTable mask : value->tables()) {
            mask.set_title("a mask");
            values.masks->push_back(mask_of(mask, folder));
        }
    }
    return values;
}

std::vector<std::string> patterns_of(const TomlValue& value) {
    std::vector<std::string> patterns;
    const auto add = [&](const TomlValue& one) {
        patterns.push_back(one.text());
        if (const auto mistake = glob_mistake(patterns.back())) one.fail("is no pattern of files: it " + *mistake);
    };
    if (value.is_text()) {
        add(value);
        return patterns;
    }
    for (const TomlValue& item : value.items()) add(item);
    if (patterns.empty()) value.fail("must have a pattern of files");
    return patterns;
}

bool matches(const std::vector<std::string>& patterns, std::string_view name) {
    return std::any_of(patterns.begin(), patterns.end(), [&](const auto& p) { return glob_matches(p, name); });
}

}  // namespace

void ToleranceValues::apply(PairTolerances& to) const {
    if (exact) {
        const CompareOptions every_pixel{0, 0.0, 0, 0.0, 0};
        to.pixels = *exact ? every_pixel : CompareOptions{};
    }
    if (levels) to.pixels.tolerance = *levels;
    if (fraction) to.pixels.fraction = *fraction;
    if (cluster) to.pixels.cluster = *cluster;
    if (window) to.pixels.window = *window;
    if (shade) to.pixels.shade = *shade;
    if (ssim) to.ssim = *ssim;
    if (flip) to.flip = *flip;
    if (masks) to.masks = *masks;
}

Tolerances Tolerances::of_table(const TomlTable& table, const fs::path& folder, const PairTolerances& base) {
    table.expect_keys(
        {"exact", "levels", "fraction", "cluster", "window", "shade", "ssim", "flip", "masks", "platforms", "rule"});
    Tolerances tolerances(base);
    values_of(table, folder).apply(tolerances.all_);
    if (const auto names = table.find("platforms"))
        for (const TomlValue& name : names->items()) {
            tolerances.platforms_.push_back(name.text());
            if (!is_platform_name(tolerances.platforms_.back()))
                name.fail("must be the name of a folder, without '/' and no dot at its start");
        }
    if (const auto rules = table.find("rule"))
        for (TomlTable rule : rules->tables()) {
            rule.set_title("[[rule]]");
            rule.expect_keys(
                {"files", "exact", "levels", "fraction", "cluster", "window", "shade", "ssim", "flip", "masks"});
            const TomlValue files = rule.require("files");
            const SourceLocation& where = rule.origin().where;
            tolerances.rules_.push_back(
                {patterns_of(files), fmt::format("{}:{}", safe_path(where.file), where.line), values_of(rule, folder)});
        }
    return tolerances;
}

Tolerances Tolerances::parse(const std::string& text, const fs::path& file, const PairTolerances& base) {
    const toml::table document = parse_toml(text, file.string());
    const TomlTable table(document, {file.filename().string(), {file.string(), 1, 1}}, "a file of tolerances");
    return of_table(table, file.parent_path(), base);
}

Tolerances Tolerances::read(const fs::path& file, const PairTolerances& base) {
    Tolerances tolerances = parse(read_toml_file(file, "file of tolerances", largest_file), file, base);
    tolerances.file_ = file;
    return tolerances;
}

void Tolerances::add_masks(const std::vector<Mask>& masks, std::vector<fs::path>& files) {
    for (const Mask& mask : masks)
        if (const auto* picture = std::get_if<std::shared_ptr<const MaskPicture>>(&mask.area))
            files.push_back((*picture)->file);
}

std::vector<fs::path> Tolerances::files() const {
    std::vector<fs::path> files;
    if (!file_.empty()) files.push_back(file_);
    add_masks(all_.masks, files);
    for (const Rule& rule : rules_)
        if (rule.values.masks) add_masks(*rule.values.masks, files);
    return files;
}

PairTolerances Tolerances::of(std::string_view name) const {
    PairTolerances tolerances = all_;
    for (const Rule& rule : rules_)
        for (const std::string& pattern : rule.files)
            if (glob_matches(pattern, name)) {
                rule.values.apply(tolerances);
                tolerances.rule = pattern;
                break;
            }
    return tolerances;
}

std::vector<std::string> Tolerances::unused(const std::vector<std::string>& names) const {
    std::vector<std::string> places;
    for (const Rule& rule : rules_) {
        const bool used =
            std::any_of(names.begin(), names.end(), [&](const auto& n) { return matches(rule.files, n); });
        if (!used) places.push_back(fmt::format("{}: \"{}\"", rule.place, safe_text(rule.files.front())));
    }
    return places;
}

}  // namespace tumble
