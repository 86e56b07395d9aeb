#include "scene/keys/matter.h"

#include "core/safe_text.h"
#include "scene/keys/motion.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"
#include "sim/math/mass_properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {
namespace {

std::array<double, 6> six_numbers(const Mat3& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}; }

/// Fails unless matter with positive density can have these moments.
void check_moments(const Vec3& moments, const TomlValue& value) {
    Vec3 sorted = moments;
    std::sort(sorted.data(), sorted.data() + 3);
    const std::string given =
        fmt::format("(given the moments {:.6g}, {:.6g} and {:.6g} kg m^2 about its principal axes)", sorted[0],
                    sorted[1], sorted[2]);
    if (!(sorted[0] > 0.0)) value.origin().fail("must be positive about every axis " + given);
    if (sorted[2] - sorted[0] - sorted[1] > limits::inertia_tolerance * sorted[2])
        value.origin().fail(
            fmt::format("breaks the triangle inequality, and no body has it: the largest moment is at most the sum of "
                        "the other two, here {:.6g} {}",
                        sorted[0] + sorted[1], given));
}

std::array<double, 6> read_inertia(const TomlValue& value) {
    Mat3 tensor;
    if (value.is_table()) {
        TomlTable table = value.table();
        table.set_title("an inertia");
        table.expect_keys({"principal", "rotation"});
        const Vec3 moments = table.require("principal").vector(limits::inertia);
        check_moments(moments, value);
        const auto rotation = table.find("rotation");
        const Mat3 turn = rotation ? read_rotation(*rotation).toRotationMatrix() : Mat3(Mat3::Identity());
        tensor = turn * moments.asDiagonal() * turn.transpose();
    } else {
        const auto item = value.items(6, "numbers xx, yy, zz, xy, xz, yz (or a table with principal and rotation)");
        for (int k = 0; k < 3; ++k) tensor(k, k) = item[std::size_t(k)].number(limits::inertia);
        const double xy = item[3].number(limits::inertia_product), xz = item[4].number(limits::inertia_product),
                     yz = item[5].number(limits::inertia_product);
        tensor(0, 1) = tensor(1, 0) = xy;
        tensor(0, 2) = tensor(2, 0) = xz;
        tensor(1, 2) = tensor(2, 1) = yz;
        check_moments(principal_inertia(tensor).moments, value);
    }
    return six_numbers(tensor);
}

std::vector<std::string> read_names(const TomlValue& value) {
    std::vector<std::string> names;
    for (const TomlValue& item : value.items()) {
        names.push_back(item.text());
        if (names.back().empty()) item.fail("must not be empty");
    }
    return names;
}

void check_uses(const TomlTable& table, const std::set<std::string>& layers) {
    const auto bodies = table.find("body");
    if (!bodies) return;
    for (const TomlTable& body : bodies->tables()) {
        const auto given = body.find("collide_with");
        if (!given) continue;
        for (const TomlValue& item : given->items()) {
            const std::string name = item.text();
            if (layers.contains(name)) continue;
            const std::vector<std::string_view> known(layers.begin(), layers.end());
            item.origin().fail(fmt::format("\"{}\" is the layer of no body{}", safe_text(name),
                                           known.empty() ? ": give a body layers = [...]" : suggestion(name, known)));
        }
    }
}

}  // namespace

void read_matter(const TomlTable& table, BodyDescription& body) {
    for (const char* key : {"inertia", "center_of_mass"})
        if (const auto value = table.find(key); value && !body.dynamic())
            value->origin().fail("is for dynamic bodies: others move by no force");
    if (const auto value = table.find("inertia")) body.inertia = read_inertia(*value);
    if (const auto value = table.find("layers")) body.layers = read_names(*value);
    if (const auto value = table.find("collide_with")) body.collide_with = read_names(*value);
}

void check_layers(const TomlTable& root, const SceneDescription& scene) {
    std::set<std::string> layers;
    bool used = false;
    for (const BodyDescription& body : scene.bodies) {
        layers.insert(body.layers.begin(), body.layers.end());
        used = used || body.collide_with;
    }
    if (layers.size() > std::size_t(limits::layers))
        root.origin().fail(
            fmt::format("has too many layers: the limit is {} (given {})", limits::layers, layers.size()));
    if (!used) return;
    check_uses(root, layers);
    if (const auto templates = root.find("template"))
        for (const auto& [name, content] : templates->table().entries()) check_uses(content.table(), layers);
}

}  // namespace tumble
