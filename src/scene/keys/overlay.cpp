#include "scene/keys/readers.h"

#include "scene/fields/overlay_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

void add_overlay(std::string_view name, const SourcePosition& origin, OverlaySet& set) {
    const auto known = std::find_if(overlay_names.begin(), overlay_names.end(),
                                    [&](const OverlayName& overlay) { return overlay.name == name; });
    if (known != overlay_names.end()) return set.add(known->overlay);
    std::vector<std::string_view> names;
    for (const OverlayName& overlay : overlay_names) names.push_back(overlay.name);
    std::string hint = suggestion(name, names);
    if (hint.empty()) hint = fmt::format(" (known: {})", quoted_list(names));
    origin.fail(fmt::format("\"{}\" is not the name of an overlay{}", safe_text(name), hint));
}

/// Reads the list of the command line: names separated by commas, or "none".
OverlaySet read_list(std::string_view list) {
    OverlaySet set;
    if (list == "none") return set;
    for (std::size_t first = 0; first <= list.size();) {
        const std::size_t end = std::min(list.find(',', first), list.size());
        add_overlay(list.substr(first, end - first), {"--overlay", {}}, set);
        first = end + 1;
    }
    return set;
}

/// A body, or all copies of a grid or scatter.
void add_bodies(const TomlValue& value, const std::vector<BodyDescription>& bodies, const BodyIndex& index,
                std::vector<std::size_t>& shown) {
    const std::string copies = fmt::format("{}.", value.text());
    const std::size_t before = shown.size();
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].name.starts_with(copies)) shown.push_back(i);
    if (shown.size() == before) shown.push_back(index.find(value));
}

void read_trail_points(const TomlTable& table, const BodyIndex& index, std::vector<TrailPoint>& points) {
    const auto list = table.find("trail_points");
    if (!list) return;
    for (const TomlTable& one : list->tables("; write trail_points = [{ body = \"ball\", point = [0, 0, 0] }]")) {
        TrailPoint point = read_all_fields<TrailPoint>(one);
        point.body = index.find(one.require("body"));
        points.push_back(point);
    }
}

/// A table with a value for each quantity.
template <class Value, class Read>
void read_by_quantity(const TomlTable& table, std::string_view key,
                      std::array<std::optional<Value>, arrow_quantity_count>& values, const Read& read) {
    auto by_quantity = table.find_table(key);
    if (!by_quantity) return;
    by_quantity->set_title(fmt::format("[overlay.{}]", key));
    std::vector<std::string_view> names;
    for (const auto& quantity : choices<ArrowQuantity>) names.push_back(quantity.name);
    by_quantity->expect_keys(names);
    for (const auto& quantity : choices<ArrowQuantity>)
        if (const auto value = by_quantity->find(quantity.name)) values[std::size_t(quantity.value)] = read(*value);
}

void check_span(const TomlTable& table, double start, double end) {
    if (end <= start)
        table.find(table.has("end") ? "end" : "start")
            ->fail(fmt::format("makes the time span end before it starts, at {} s", number_text(start)));
}

void read_table(const TomlTable& table, const std::vector<BodyDescription>& bodies, OverlayDescription& overlay) {
    table.expect_keys(list_keys<OverlayDescription>().keys);
    read_fields(table, overlay);
    if (const auto show = table.find("show"))
        for (const TomlValue& name : show->items()) add_overlay(name.text(), name.origin(), overlay.show);
    const BodyIndex index(bodies);
    if (const auto list = table.find("bodies"))
        for (const TomlValue& name : list->items()) add_bodies(name, bodies, index, overlay.bodies);
    check_span(table, overlay.start, overlay.end);
    read_trail_points(table, index, overlay.trail_points);
    read_by_quantity(table, "scale", overlay.scale,
                     [](const TomlValue& value) { return value.number(limits::arrow_scale); });
    read_by_quantity(table, "color", overlay.color, [](const TomlValue& value) { return value.color(); });
    if (const auto plot = table.find("plot"))
        for (const TomlValue& quantity : plot->items()) {
            if (!overlay.plot.empty()) overlay.plot += ',';
            overlay.plot += quantity.text();
        }
}

void read_captions(const TomlTable& root, std::vector<Caption>& captions) {
    const auto list = root.find("caption");
    if (!list) return;
    for (TomlTable& table : list->tables("; write [[caption]] for each")) {
        table.set_title("[[caption]]");
        Caption caption = read_all_fields<Caption>(table);
        check_span(table, caption.start, caption.end);
        captions.push_back(std::move(caption));
    }
}

}  // namespace

OverlayDescription read_overlay(const TomlTable& root, const std::vector<BodyDescription>& bodies,
                                const SceneOverrides& overrides) {
    OverlayDescription overlay;
    if (const auto table = root.find_table("overlay")) read_table(*table, bodies, overlay);
    read_captions(root, overlay.captions);
    if (overrides.overlay) {
        overlay.show = read_list(*overrides.overlay);
        if (*overrides.overlay == "none") overlay.captions.clear(), overlay.plot.clear();
    }
    if (overrides.plot) overlay.plot = *overrides.plot == "none" ? "" : *overrides.plot;
    if (overrides.plot_place)
        overlay.plot_place = chosen<PlotPlace>(*overrides.plot_place, choices<PlotPlace>, {"--plot-place", {}});
    return overlay;
}

}  // namespace tumble
