// Cairo and Pango as canvas.cpp calls them. They are opened with the first canvas: 34 libraries and 8 MB come with
// them, and most runs draw neither plots nor text.
#pragma once

#include "core/dynamic_library.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <pango/pangocairo.h>

#define TUMBLE_PANGO_CAIRO_FUNCTIONS(X)         \
    X(cairo_arc)                                \
    X(cairo_clip)                               \
    X(cairo_close_path)                         \
    X(cairo_create)                             \
    X(cairo_destroy)                            \
    X(cairo_fill)                               \
    X(cairo_font_options_create)                \
    X(cairo_font_options_destroy)               \
    X(cairo_font_options_set_antialias)         \
    X(cairo_font_options_set_hint_metrics)      \
    X(cairo_font_options_set_hint_style)        \
    X(cairo_image_surface_create)               \
    X(cairo_image_surface_get_data)             \
    X(cairo_image_surface_get_height)           \
    X(cairo_image_surface_get_stride)           \
    X(cairo_image_surface_get_width)            \
    X(cairo_line_to)                            \
    X(cairo_move_to)                            \
    X(cairo_new_path)                           \
    X(cairo_new_sub_path)                       \
    X(cairo_pdf_surface_create_for_stream)      \
    X(cairo_pdf_surface_set_metadata)           \
    X(cairo_rectangle)                          \
    X(cairo_restore)                            \
    X(cairo_save)                               \
    X(cairo_scale)                              \
    X(cairo_set_dash)                           \
    X(cairo_set_line_cap)                       \
    X(cairo_set_line_join)                      \
    X(cairo_set_line_width)                     \
    X(cairo_set_source_rgba)                    \
    X(cairo_show_page)                          \
    X(cairo_status)                             \
    X(cairo_status_to_string)                   \
    X(cairo_stroke)                             \
    X(cairo_surface_destroy)                    \
    X(cairo_surface_finish)                     \
    X(cairo_surface_flush)                      \
    X(cairo_surface_write_to_png_stream)        \
    X(cairo_svg_surface_create_for_stream)      \
    X(cairo_svg_surface_set_document_unit)      \
    X(g_object_unref)                           \
    X(pango_attr_font_features_new)             \
    X(pango_attr_list_insert)                   \
    X(pango_attr_list_new)                      \
    X(pango_attr_list_unref)                    \
    X(pango_cairo_context_set_font_options)     \
    X(pango_cairo_context_set_resolution)       \
    X(pango_cairo_create_layout)                \
    X(pango_cairo_show_layout)                  \
    X(pango_cairo_update_layout)                \
    X(pango_context_load_font)                  \
    X(pango_font_describe)                      \
    X(pango_font_description_free)              \
    X(pango_font_description_get_family)        \
    X(pango_font_description_new)               \
    X(pango_font_description_set_absolute_size) \
    X(pango_font_description_set_family)        \
    X(pango_font_description_set_weight)        \
    X(pango_layout_get_baseline)                \
    X(pango_layout_get_context)                 \
    X(pango_layout_get_font_description)        \
    X(pango_layout_get_size)                    \
    X(pango_layout_set_attributes)              \
    X(pango_layout_set_font_description)        \
    X(pango_layout_set_text)

namespace tumble {

/// The functions by their own names.
class PangoCairo {
    DynamicLibrary library_;

public:
    PangoCairo();

// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared takes none
#define X(name) decltype(&::name) name = library_.require<decltype(&::name)>(#name);
    TUMBLE_PANGO_CAIRO_FUNCTIONS(X)
#undef X
};

/// Opened by the first call. Throws RunError if it is not installed.
const PangoCairo& pango_cairo();

}  // namespace tumble
