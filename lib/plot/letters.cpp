// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/private/letters.hpp"

#include "base/text/printable.hpp"

namespace vam::plot {

namespace {

/// Unhinted, so that words are as wide on a screen as on paper.
PangoContext* make_context() {
  const CairoApi& api = cairo_api();
  PangoContext* context = api.pango_font_map_create_context(api.pango_cairo_font_map_get_default());
  cairo_font_options_t* options = api.cairo_font_options_create();
  api.cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  api.cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  api.cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  api.pango_cairo_context_set_font_options(context, options);
  api.cairo_font_options_destroy(options);
  api.pango_context_set_round_glyph_positions(context, FALSE);
  return context;
}

PangoContext* context() {
  thread_local const std::unique_ptr<PangoContext, void (*)(void*)> made(make_context(), cairo_api().g_object_unref);
  return made.get();
}

}  // namespace

Letters::Letters(const std::string& words, double size)
    : layout_(cairo_api().pango_layout_new(context()), cairo_api().g_object_unref) {
  const CairoApi& api = cairo_api();
  PangoFontDescription* font = api.pango_font_description_new();
  api.pango_font_description_set_family(font, "sans-serif");
  api.pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
  api.pango_layout_set_font_description(layout_.get(), font);
  api.pango_font_description_free(font);
  api.pango_layout_set_single_paragraph_mode(layout_.get(), TRUE);
  const std::string shown = printable(words);
  api.pango_layout_set_text(layout_.get(), shown.data(), static_cast<int>(shown.size()));
}

double Letters::width() const {
  int width = 0;
  cairo_api().pango_layout_get_size(layout_.get(), &width, nullptr);
  return static_cast<double>(width) / PANGO_SCALE;
}

double Letters::baseline() const {
  return static_cast<double>(cairo_api().pango_layout_get_baseline(layout_.get())) / PANGO_SCALE;
}

void Letters::show(cairo_t* context) const { cairo_api().pango_cairo_show_layout(context, layout_.get()); }

}  // namespace vam::plot
