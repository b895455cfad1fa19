// SPDX-License-Identifier: GPL-3.0-or-later
// cairo and pango, loaded when the first figure is drawn: with fonts, glib and X11 they are 30 libraries, which would
// take most of the start of every tool that can draw. Their headers say what the functions are; nothing is linked.
#pragma once

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <pango/pangocairo.h>

// Every function that is called; libpangocairo knows those of the others.
// clang-format off
#define VAM_CAIRO_FUNCTIONS(X)                                                                                        \
  X(cairo_arc) X(cairo_clip) X(cairo_create) X(cairo_destroy) X(cairo_fill) X(cairo_font_options_create)              \
  X(cairo_font_options_destroy) X(cairo_font_options_set_antialias) X(cairo_font_options_set_hint_metrics)            \
  X(cairo_font_options_set_hint_style) X(cairo_get_source) X(cairo_image_surface_create)                              \
  X(cairo_image_surface_get_data) X(cairo_image_surface_get_stride) X(cairo_line_to) X(cairo_move_to)                 \
  X(cairo_paint) X(cairo_pattern_set_extend) X(cairo_pattern_set_filter) X(cairo_pdf_surface_create_for_stream)       \
  X(cairo_pdf_surface_set_metadata) X(cairo_recording_surface_create) X(cairo_rectangle) X(cairo_restore)             \
  X(cairo_rotate) X(cairo_save) X(cairo_scale) X(cairo_set_antialias) X(cairo_set_dash) X(cairo_set_line_cap)         \
  X(cairo_set_line_join) X(cairo_set_line_width) X(cairo_set_source_rgba) X(cairo_set_source_surface)                 \
  X(cairo_status) X(cairo_status_to_string) X(cairo_stroke) X(cairo_surface_destroy) X(cairo_surface_finish)          \
  X(cairo_surface_flush) X(cairo_surface_mark_dirty) X(cairo_surface_status)                                          \
  X(cairo_svg_surface_create_for_stream) X(cairo_translate) X(g_log_default_handler) X(g_log_set_default_handler)     \
  X(g_object_unref)                                                                                                   \
  X(pango_cairo_context_set_font_options) X(pango_cairo_font_map_get_default) X(pango_cairo_show_layout)              \
  X(pango_context_set_round_glyph_positions) X(pango_font_description_free) X(pango_font_description_new)             \
  X(pango_font_description_set_absolute_size) X(pango_font_description_set_family) X(pango_font_map_create_context)   \
  X(pango_layout_get_baseline) X(pango_layout_get_size) X(pango_layout_new) X(pango_layout_set_font_description)      \
  X(pango_layout_set_single_paragraph_mode) X(pango_layout_set_text)
// clang-format on

namespace vam::plot {

struct CairoApi {
#define VAM_POINTER(name) decltype(&::name) name;  // NOLINT(bugprone-macro-parentheses): it is declared here
  VAM_CAIRO_FUNCTIONS(VAM_POINTER)
#undef VAM_POINTER
};

/// The one of this process. Throws Fault::absent when it is not installed, Fault::memory when there is no room for it.
const CairoApi& cairo_api();

}  // namespace vam::plot
