#include "plot/canvas.h"

#include "core/error.h"
#include "plot/pango_cairo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

// The first family that is installed is taken; the last is an alias that always exists.
constexpr const char* families = "Inter, DejaVu Sans, sans-serif";

const PangoCairo& lib() { return pango_cairo(); }

cairo_status_t append(void* target, const unsigned char* data, unsigned int size) {
    static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct Canvas::State {
    struct Unref {
        void operator()(cairo_surface_t* s) const { lib().cairo_surface_destroy(s); }
        void operator()(cairo_t* c) const { lib().cairo_destroy(c); }
        void operator()(PangoLayout* l) const { lib().g_object_unref(l); }
        void operator()(PangoFontDescription* d) const { lib().pango_font_description_free(d); }
    };

    Format format = Format::png;
    std::string bytes;
    std::unique_ptr<cairo_surface_t, Unref> surface;
    std::unique_ptr<cairo_t, Unref> cairo;
    std::unique_ptr<PangoLayout, Unref> layout;

    // Outlines without hinting: the same shapes at any place and size.
    void start(cairo_surface_t* made) {
        surface.reset(made);
        cairo.reset(lib().cairo_create(made));
        check();
        lib().cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
        lib().cairo_set_line_cap(cairo.get(), CAIRO_LINE_CAP_ROUND);
        cairo_font_options_t* options = lib().cairo_font_options_create();
        lib().cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
        lib().cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
        lib().cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
        layout.reset(lib().pango_cairo_create_layout(cairo.get()));
        lib().pango_cairo_context_set_font_options(lib().pango_layout_get_context(layout.get()), options);
        lib().pango_cairo_context_set_resolution(lib().pango_layout_get_context(layout.get()), 72.0);
        lib().cairo_font_options_destroy(options);
    }

    void check() const {
        const cairo_status_t status = lib().cairo_status(cairo.get());
        if (status != CAIRO_STATUS_SUCCESS)
            throw RunError(fmt::format("cannot draw a plot: {}", lib().cairo_status_to_string(status)));
    }

    void set(const Paint& paint) const {
        lib().cairo_set_source_rgba(cairo.get(), paint.color.r / 255.0, paint.color.g / 255.0, paint.color.b / 255.0,
                                    paint.opacity);
    }

    void set_text(std::string_view text, const TextStyle& style) const {
        const std::unique_ptr<PangoFontDescription, Unref> font(lib().pango_font_description_new());
        lib().pango_font_description_set_family(font.get(), families);
        lib().pango_font_description_set_absolute_size(font.get(), style.size * PANGO_SCALE);
        if (style.bold) lib().pango_font_description_set_weight(font.get(), PANGO_WEIGHT_SEMIBOLD);
        lib().pango_layout_set_font_description(layout.get(), font.get());
        PangoAttrList* attributes = lib().pango_attr_list_new();
        lib().pango_attr_list_insert(attributes, lib().pango_attr_font_features_new("tnum=1"));  // digits of one width
        lib().pango_layout_set_attributes(layout.get(), attributes);
        lib().pango_attr_list_unref(attributes);
        lib().pango_layout_set_text(layout.get(), text.data(), int(text.size()));
    }

    double width() const {
        int w = 0;
        lib().pango_layout_get_size(layout.get(), &w, nullptr);
        return double(w) / PANGO_SCALE;
    }
};

Canvas::Canvas(Format format, double width, double height) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.format = format;
    if (format == Format::svg) {
        s.start(lib().cairo_svg_surface_create_for_stream(append, &s.bytes, width, height));
        lib().cairo_svg_surface_set_document_unit(s.surface.get(), CAIRO_SVG_UNIT_PX);
    } else if (format == Format::pdf) {
        s.start(lib().cairo_pdf_surface_create_for_stream(append, &s.bytes, width, height));
        // A fixed date: the same plot has the same bytes.
        lib().cairo_pdf_surface_set_metadata(s.surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    } else {
        s.start(
            lib().cairo_image_surface_create(CAIRO_FORMAT_ARGB32, int(std::lround(width)), int(std::lround(height))));
    }
}

Canvas::Canvas(int width_pixels, int height_pixels, double scale) : state_(std::make_unique<State>()) {
    state_->start(lib().cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width_pixels, height_pixels));
    lib().cairo_scale(state_->cairo.get(), scale, scale);
    lib().pango_cairo_update_layout(state_->cairo.get(), state_->layout.get());
}

Canvas::~Canvas() = default;

void Canvas::fill(const Box2& box, const Paint& paint, double corner_radius) {
    cairo_t* c = state_->cairo.get();
    state_->set(paint);
    lib().cairo_new_path(c);
    const double r = std::min({corner_radius, 0.5 * box.width(), 0.5 * box.height()});
    if (r <= 0.0) {
        lib().cairo_rectangle(c, box.left, box.top, box.width(), box.height());
    } else {
        constexpr double quarter = 0.5 * std::numbers::pi;
        lib().cairo_arc(c, box.right - r, box.top + r, r, -quarter, 0.0);
        lib().cairo_arc(c, box.right - r, box.bottom - r, r, 0.0, quarter);
        lib().cairo_arc(c, box.left + r, box.bottom - r, r, quarter, 2.0 * quarter);
        lib().cairo_arc(c, box.left + r, box.top + r, r, 2.0 * quarter, 3.0 * quarter);
        lib().cairo_close_path(c);
    }
    lib().cairo_fill(c);
}

void Canvas::polyline(std::span<const Point2> points, const Paint& paint, double width, double dash) {
    cairo_t* c = state_->cairo.get();
    state_->set(paint);
    lib().cairo_set_line_width(c, width);
    const double dashes[] = {dash, dash};
    lib().cairo_set_dash(c, dashes, dash > 0.0 ? 2 : 0, 0.0);
    lib().cairo_new_path(c);
    for (const Point2& p : points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y))
            lib().cairo_new_sub_path(c);
        else
            lib().cairo_line_to(c, p.x, p.y);
    }
    lib().cairo_stroke(c);
}

void Canvas::disc(const Point2& center, double radius, const Paint& paint) {
    cairo_t* c = state_->cairo.get();
    state_->set(paint);
    lib().cairo_new_path(c);
    lib().cairo_arc(c, center.x, center.y, radius, 0.0, 2.0 * std::numbers::pi);
    lib().cairo_fill(c);
}

void Canvas::clip(const Box2& box) {
    cairo_t* c = state_->cairo.get();
    lib().cairo_save(c);
    lib().cairo_rectangle(c, box.left, box.top, box.width(), box.height());
    lib().cairo_clip(c);
}

void Canvas::unclip() { lib().cairo_restore(state_->cairo.get()); }

void Canvas::text(const Point2& at, std::string_view text, const TextStyle& style) {
    State& s = *state_;
    s.set_text(text, style);
    s.set(style.paint);
    const double baseline = double(lib().pango_layout_get_baseline(s.layout.get())) / PANGO_SCALE;
    lib().cairo_move_to(s.cairo.get(), at.x - style.anchor * s.width(), at.y - baseline);
    lib().pango_cairo_show_layout(s.cairo.get(), s.layout.get());
}

std::string Canvas::font_family() const {
    state_->set_text("", {});
    PangoLayout* const layout = state_->layout.get();
    PangoFont* const font = lib().pango_context_load_font(lib().pango_layout_get_context(layout),
                                                          lib().pango_layout_get_font_description(layout));
    if (font == nullptr) return "";
    const std::unique_ptr<PangoFontDescription, State::Unref> description(lib().pango_font_describe(font));
    const char* const family = lib().pango_font_description_get_family(description.get());
    std::string name = family == nullptr ? "" : family;
    lib().g_object_unref(font);
    return name;
}

double Canvas::text_width(std::string_view text, const TextStyle& style) const {
    state_->set_text(text, style);
    return state_->width();
}

std::string Canvas::finish() {
    State& s = *state_;
    s.check();
    if (s.format == Format::png) {
        const cairo_status_t status = lib().cairo_surface_write_to_png_stream(s.surface.get(), append, &s.bytes);
        if (status != CAIRO_STATUS_SUCCESS)
            throw RunError(fmt::format("cannot draw a plot: {}", lib().cairo_status_to_string(status)));
    } else {
        lib().cairo_show_page(s.cairo.get());
        lib().cairo_surface_finish(s.surface.get());
    }
    s.check();
    return std::move(s.bytes);
}

Image Canvas::image() const {
    cairo_surface_t* surface = state_->surface.get();
    lib().cairo_surface_flush(surface);
    const int width = lib().cairo_image_surface_get_width(surface),
              height = lib().cairo_image_surface_get_height(surface);
    const unsigned char* rows = lib().cairo_image_surface_get_data(surface);
    const int stride = lib().cairo_image_surface_get_stride(surface);
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        const auto* row = reinterpret_cast<const std::uint32_t*>(rows + std::ptrdiff_t(y) * stride);
        for (int x = 0; x < width; ++x) {
            const std::uint32_t argb = row[x], alpha = argb >> 24;
            std::uint8_t* out = image.at(x, y);
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t value = argb >> (16 - 8 * k) & 255u;
                out[k] = alpha == 0 ? 0 : std::uint8_t(std::min(255u, (255u * value + alpha / 2) / alpha));
            }
            out[3] = std::uint8_t(alpha);
        }
    }
    return image;
}

}  // namespace tumble
