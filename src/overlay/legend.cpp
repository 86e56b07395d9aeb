#include "overlay/legend.h"

#include "overlay/overlay_builder.h"
#include "overlay/shape_raster.h"
#include "plot/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// A symbol and its meaning.
struct Entry {
    enum class Symbol { arrow, double_arrow, marker, patch } symbol;
    Color color;
    std::string text;
    MarkerShape shape = MarkerShape::disc;
};

std::string scale_text(double scale, std::string_view unit) {
    if (scale <= 0.0) return "none in this clip";
    return fmt::format("1 m = {:g} {}", 1.0 / scale, unit);
}

std::string_view force_name(const OverlayDescription& overlay) {
    const bool contacts = overlay.show.has(Overlay::forces);
    if (!overlay.show.has(Overlay::joints)) return style::arrows[0].text;
    return contacts ? "force of a contact or joint" : "force of a joint";
}

using Row = std::vector<Entry>;

void add_arrows(const SceneDescription& scene, const OverlayScales& scales, const OverlayMarks& marks,
                std::vector<Row>& rows) {
    const OverlayDescription& overlay = scene.overlay;
    for (std::size_t q = 0; q < arrow_quantity_count; ++q) {
        const auto quantity = ArrowQuantity(q);
        if (!shows(overlay, quantity)) continue;
        const auto& look = style::arrows[q];
        const std::string scale = scale_text(scales[q], look.unit);
        const bool force = quantity == ArrowQuantity::force;
        const bool of_joints = overlay.show.has(Overlay::joints);
        if (!force || overlay.show.has(Overlay::forces) || of_joints)
            rows.push_back(
                {{look.axial ? Entry::Symbol::double_arrow : Entry::Symbol::arrow, arrow_color(overlay, quantity),
                  fmt::format("{}, {}", force ? force_name(overlay) : look.text, scale)}});
        if (force && overlay.show.has(Overlay::forces) && marks.friction)
            rows.push_back({{Entry::Symbol::arrow, style::friction_color, "its friction part"}});
        if (force && overlay.show.has(Overlay::loads))
            rows.push_back(
                {{Entry::Symbol::arrow, style::load_color, fmt::format("weight, applied force, {}", scale)}});
    }
    if (overlay.show.has(Overlay::normals))
        rows.push_back({{Entry::Symbol::arrow, style::normal_color, "normal, from A to B"}});
    if (overlay.show.has(Overlay::joints))
        rows.push_back({{Entry::Symbol::marker, style::joint_color, "joint and axis"},
                        {Entry::Symbol::patch, style::limit_color, "limits"},
                        {Entry::Symbol::patch, style::at_limit_color, "at a limit"}});
    if (overlay.show.has(Overlay::axes))
        rows.push_back({{Entry::Symbol::arrow, style::axis_colors[0], "x"},
                        {Entry::Symbol::arrow, style::axis_colors[1], "y"},
                        {Entry::Symbol::arrow, style::axis_colors[2], "z of the body"}});
}

/// The states and features that occur, two in a row.
void add_contacts(const OverlayMarks& marks, std::vector<Row>& rows) {
    const std::size_t first = rows.size();
    const auto add = [&](Entry entry) {
        if (rows.size() == first || rows.back().size() == 2) rows.emplace_back();
        rows.back().push_back(std::move(entry));
    };
    for (std::size_t k = 0; k < std::size(style::contact_states); ++k)
        if ((marks.states >> k & 1u) != 0)
            add({Entry::Symbol::marker, style::contact_states[k].color, std::string(style::contact_states[k].text)});
    // Both orders of vertex and face have one mark.
    std::uint32_t features = marks.features;
    if ((features >> unsigned(ContactFeatures::face_vertex) & 1u) != 0)
        features |= 1u << unsigned(ContactFeatures::vertex_face);
    for (const auto feature : {ContactFeatures::vertex_face, ContactFeatures::face_face, ContactFeatures::edge_edge,
                               ContactFeatures::sphere, ContactFeatures::mesh})
        if ((features >> unsigned(feature) & 1u) != 0)
            add({Entry::Symbol::marker, style::normal_color,
                 std::string(style::contact_features[std::size_t(feature)].text), contact_shape(feature)});
}

std::vector<Row> make_rows(const SceneDescription& scene, const PanelOverlay& panel) {
    const OverlayDescription& overlay = scene.overlay;
    std::vector<Row> rows;
    add_arrows(scene, panel.scales, panel.marks, rows);
    if (overlay.show.has(Overlay::contacts)) add_contacts(panel.marks, rows);
    if (overlay.show.has(Overlay::com))
        rows.push_back({{Entry::Symbol::marker, style::center_color, "center of mass", MarkerShape::center_of_mass}});
    if (overlay.show.has(Overlay::ghosts))
        rows.push_back({{Entry::Symbol::patch,
                         {200, 206, 216},
                         fmt::format("pose every {:.3g} s", overlay.ghost_every * panel.frame_step)}});
    if (overlay.show.has(Overlay::sleep)) rows.push_back({{Entry::Symbol::patch, style::asleep_color, "asleep"}});
    if (overlay.show.has(Overlay::islands))
        rows.push_back({{Entry::Symbol::patch, style::island_colors[0], "island: bodies in contact"}});
    if (overlay.show.has(Overlay::cracks)) {
        rows.push_back({{Entry::Symbol::patch, style::crack_color, "bond between cells"}});
        rows.push_back({{Entry::Symbol::patch, style::open_crack_color, "open crack"}});
    }
    return rows;
}

// In units of the shapes' sizes.
constexpr double row_height = 23.0, legend_margin = 11.0, column_gap = 16.0;
constexpr double arrow_width = 30.0, marker_width = 14.0, symbol_gap = 9.0;

double symbol_width(const Entry& entry) {
    return entry.symbol == Entry::Symbol::marker || entry.symbol == Entry::Symbol::patch ? marker_width : arrow_width;
}

void draw_symbol(const Entry& entry, double left, double y, double unit, ShapeRaster& raster) {
    const OverlayPaint paint{entry.color, 1.0, false};
    const auto at = [&](double x) { return ScreenPoint{{(left + x) * unit, y * unit}, 1.0}; };
    switch (entry.symbol) {
        case Entry::Symbol::marker:
            raster.marker(at(0.5 * marker_width), 5.5 * unit, entry.shape, paint);
            break;
        case Entry::Symbol::patch:
            raster.line(std::array{at(4.0), at(marker_width - 4.0)}, 12.0 * unit, paint);
            break;
        default:
            raster.arrow({at(0.0), at(arrow_width), 3.2 * unit, entry.symbol == Entry::Symbol::double_arrow ? 2 : 1},
                         paint);
    }
}

/// The left edge of each entry of each row, and the right edge of the last.
std::vector<std::vector<double>> place_entries(const std::vector<Row>& rows, const TextStyle& style) {
    const Canvas measure(1, 1, 1.0);
    const auto width_of = [&](const Entry& entry) {
        return symbol_width(entry) + symbol_gap + measure.text_width(entry.text, style);
    };
    double first_column = 0.0;  // of the rows of two, whose second entries are aligned
    for (const Row& row : rows)
        if (row.size() == 2) first_column = std::max(first_column, width_of(row[0]));
    std::vector<std::vector<double>> lefts;
    for (const Row& row : rows) {
        std::vector<double> places{legend_margin};
        for (std::size_t k = 0; k < row.size(); ++k) {
            const bool last = k + 1 == row.size();
            const double width = row.size() == 2 && !last ? first_column : width_of(row[k]);
            places.push_back(places.back() + width + (last ? 0.0 : column_gap));
        }
        lefts.push_back(std::move(places));
    }
    return lefts;
}

}  // namespace

std::optional<Image> draw_legend(const SceneDescription& scene, const PanelOverlay& panel) {
    const std::vector<Row> rows = make_rows(scene, panel);
    if (rows.empty()) return std::nullopt;
    const double unit = overlay_unit(panel.frame_height);
    TextStyle style;
    style.size = 15.0;
    style.paint = {style::normal_color, 1.0};
    const auto lefts = place_entries(rows, style);
    double width = 0.0;
    for (const auto& places : lefts) width = std::max(width, places.back() + legend_margin);
    const double tall = 2.0 * legend_margin + row_height * double(rows.size()) - 4.0;
    Canvas canvas(int(std::ceil(width * unit)), int(std::ceil(tall * unit)), unit);
    canvas.fill({0.0, 0.0, width, tall}, {style::label_background_color, 0.66}, 8.0);
    const auto for_each = [&](const auto& use) {
        for (std::size_t r = 0; r < rows.size(); ++r)
            for (std::size_t k = 0; k < rows[r].size(); ++k)
                use(rows[r][k], lefts[r][k], legend_margin + row_height * double(r));
    };
    for_each([&](const Entry& entry, double left, double top) {
        canvas.text({left + symbol_width(entry) + symbol_gap, top + 14.0}, entry.text, style);
    });
    Image image = canvas.image();
    // The symbols are drawn like the marks themselves.
    ShapeRaster raster(image.width, image.height, 0.0);
    raster.begin(image, nullptr);
    for_each([&](const Entry& entry, double left, double top) { draw_symbol(entry, left, top + 9.0, unit, raster); });
    return image;
}

}  // namespace tumble
