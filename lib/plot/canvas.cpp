// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <numbers>
#include <stdexcept>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "plot/private/cairo_library.hpp"
#include "plot/private/letters.hpp"

namespace vam::plot {

namespace {

constexpr double points_per_px = 72 / screen_dpi;
constexpr int most_pixels = 32767;  // a side of cairo's images
constexpr double bytes_per_pixel =
    12;  // of a PNG while it is packed; cairo's own, before that, are 4 and 3 of the copy

const CairoApi& cairo() { return cairo_api(); }

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Context = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

Surface owned(cairo_surface_t* surface) { return {surface, cairo().cairo_surface_destroy}; }
Context context_of(const Surface& surface) { return {cairo().cairo_create(surface.get()), cairo().cairo_destroy}; }

void require_success(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(std::string("figure: ") + cairo().cairo_status_to_string(status));
}

/// The pixels of an image surface: 32 bits each, red above green above blue.
class Pixels {
 public:
  Pixels(int width, int height)
      : surface_(owned(cairo().cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height))) {
    require_success(cairo().cairo_surface_status(surface_.get()));
  }

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] unsigned char* row(int y) const {
    return cairo().cairo_image_surface_get_data(surface_.get()) +
           product(y, cairo().cairo_image_surface_get_stride(surface_.get()));
  }

  void take(const RgbImage& image) const {
    cairo().cairo_surface_flush(surface_.get());
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const Rgb& from = image(x, y);
        const std::uint32_t to = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
        std::memcpy(row(y) + 4 * static_cast<std::ptrdiff_t>(x), &to, sizeof to);
      }
    }
    cairo().cairo_surface_mark_dirty(surface_.get());
  }

  [[nodiscard]] RgbImage give(int width, int height) const {
    cairo().cairo_surface_flush(surface_.get());
    RgbImage image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        std::uint32_t from = 0;
        std::memcpy(&from, row(y) + 4 * static_cast<std::ptrdiff_t>(x), sizeof from);
        for (std::size_t n = 0; n < 3; ++n) image(x, y)[n] = static_cast<std::uint8_t>(from >> (16 - 8 * n));
      }
    }
    return image;
  }

 private:
  Surface surface_;
};

cairo_status_t append(void* to, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

/// Of a straight line along an axis: the middle of the pixel.
double crisp(double place) { return std::floor(place) + 0.5; }

}  // namespace

struct Canvas::State {
  State(int columns, int rows)
      : width(columns),
        height(rows),
        extents{0, 0, static_cast<double>(columns), static_cast<double>(rows)},
        surface(owned(cairo().cairo_recording_surface_create(CAIRO_CONTENT_COLOR, &extents))),
        context(context_of(surface)) {
    require_success(cairo().cairo_status(context.get()));
    cairo().cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_ROUND);
  }

  int width;
  int height;
  cairo_rectangle_t extents;
  Surface surface;
  Context context;
  bool pixelated = false;  // an enlarged image was pasted

  void pen(Rgb colour, double opacity = 1) const {
    cairo().cairo_set_source_rgba(context.get(), colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0, opacity);
  }
  void move(Spot to) const { cairo().cairo_move_to(context.get(), to.x, to.y); }
  void draw_to(Spot to) const { cairo().cairo_line_to(context.get(), to.x, to.y); }
  void follow(const std::vector<Spot>& spots) const {
    if (!spots.empty()) move(spots.front());
    for (const Spot spot : spots) draw_to(spot);
  }
  void stroke(Rgb colour, double thickness) const {
    pen(colour);
    cairo().cairo_set_line_width(context.get(), thickness);
    cairo().cairo_stroke(context.get());
  }
  void box(Spot corner, Spot opposite) const {
    cairo().cairo_rectangle(context.get(), corner.x, corner.y, opposite.x - corner.x, opposite.y - corner.y);
  }

  /// All that was drawn, on another surface, whose unit is `scale` times smaller.
  void replay(const Surface& to, double scale) const {
    require_success(cairo().cairo_status(context.get()));  // after an error nothing more was drawn
    const Context other = context_of(to);
    cairo().cairo_scale(other.get(), scale, scale);
    cairo().cairo_set_source_surface(other.get(), surface.get(), 0, 0);
    cairo().cairo_paint(other.get());
    require_success(cairo().cairo_status(other.get()));
  }
};

Canvas::Canvas(int width, int height, Rgb background) : state_(std::make_unique<State>(width, height)) {
  state_->pen(background);
  cairo().cairo_paint(state_->context.get());
}
Canvas::Canvas(Canvas&& other) noexcept = default;
Canvas& Canvas::operator=(Canvas&& other) noexcept = default;
Canvas::~Canvas() = default;

int Canvas::width() const { return state_->width; }
int Canvas::height() const { return state_->height; }

void Canvas::line(Spot from, Spot to, Rgb colour, double thickness) {
  if (from.x == to.x) from.x = to.x = crisp(from.x);
  if (from.y == to.y) from.y = to.y = crisp(from.y);
  state_->move(from);
  state_->draw_to(to);
  state_->stroke(colour, thickness);
}

void Canvas::dashed(Spot from, Spot to, Rgb colour, double thickness) {
  constexpr double dash = 6;
  cairo().cairo_set_dash(state_->context.get(), &dash, 1, 0);
  line(from, to, colour, thickness);
  cairo().cairo_set_dash(state_->context.get(), nullptr, 0, 0);
}

void Canvas::lines(const std::vector<SpotPair>& pieces, Rgb colour, double thickness) {
  for (const auto& [from, to] : pieces) {
    state_->move(from);
    state_->draw_to(to);
  }
  cairo().cairo_set_line_cap(state_->context.get(), CAIRO_LINE_CAP_ROUND);
  state_->stroke(colour, thickness);
  cairo().cairo_set_line_cap(state_->context.get(), CAIRO_LINE_CAP_BUTT);
}

void Canvas::polyline(const std::vector<Spot>& spots, Rgb colour, double thickness) {
  state_->follow(spots);
  state_->stroke(colour, thickness);
}

void Canvas::fill(Spot corner, Spot opposite, Rgb colour, double opacity) {
  cairo().cairo_save(state_->context.get());
  cairo().cairo_set_antialias(state_->context.get(), CAIRO_ANTIALIAS_NONE);
  state_->pen(colour, opacity);
  state_->box(corner, opposite);
  cairo().cairo_fill(state_->context.get());
  cairo().cairo_restore(state_->context.get());
}

void Canvas::area(const std::vector<Spot>& spots, Rgb colour, double opacity) {
  state_->pen(colour, opacity);
  state_->follow(spots);
  cairo().cairo_fill(state_->context.get());
}

void Canvas::hatch(const std::vector<SpotPair>& boxes) {
  if (boxes.empty()) return;
  constexpr double pitch = 8;
  Spot low = boxes.front().first;
  Spot high = boxes.front().second;
  cairo().cairo_save(state_->context.get());
  cairo().cairo_set_antialias(state_->context.get(), CAIRO_ANTIALIAS_NONE);
  for (const auto& [corner, opposite] : boxes) {
    state_->box(corner, opposite);
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, opposite.x), std::max(high.y, opposite.y)};
  }
  cairo().cairo_clip(state_->context.get());
  fill(low, high, paint::light_grey);
  std::vector<SpotPair> strokes;
  const double rise = high.y - low.y;
  const int count = ceil_int((high.x - low.x + rise) / pitch);
  for (int i = 0; i < count; ++i) {
    const double x = low.x - rise + pitch * i;
    strokes.push_back({{x, high.y}, {x + rise, low.y}});
  }
  cairo().cairo_set_antialias(state_->context.get(), CAIRO_ANTIALIAS_DEFAULT);
  lines(strokes, paint::black, 2);
  cairo().cairo_restore(state_->context.get());
}

void Canvas::outline(Spot corner, Spot opposite, Rgb colour, double thickness) {
  line(corner, {opposite.x, corner.y}, colour, thickness);
  line({corner.x, opposite.y}, opposite, colour, thickness);
  line(corner, {corner.x, opposite.y}, colour, thickness);
  line({opposite.x, corner.y}, opposite, colour, thickness);
}

void Canvas::disc(Spot centre, double radius, Rgb colour) {
  state_->pen(colour);
  cairo().cairo_arc(state_->context.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo().cairo_fill(state_->context.get());
}

void Canvas::paste(const RgbImage& image, Spot corner, Spot opposite) {
  const Pixels pixels(image.width, image.height);
  pixels.take(image);
  const double x = (opposite.x - corner.x) / image.width;
  const double y = (opposite.y - corner.y) / image.height;
  cairo_t* context = state_->context.get();
  cairo().cairo_save(context);
  cairo().cairo_translate(context, corner.x, corner.y);
  cairo().cairo_scale(context, x, y);
  cairo().cairo_set_source_surface(context, pixels.surface().get(), 0, 0);
  const bool enlarged = x >= 1 && y >= 1;
  state_->pixelated = state_->pixelated || enlarged;
  cairo().cairo_pattern_set_filter(cairo().cairo_get_source(context),
                                   enlarged ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
  if (!enlarged) cairo().cairo_pattern_set_extend(cairo().cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo().cairo_rectangle(context, 0, 0, image.width, image.height);  // what is smoothed ends with the image, too
  cairo().cairo_fill(context);
  cairo().cairo_restore(context);
}

void Canvas::place(const Canvas& other, Spot corner) {
  cairo().cairo_set_source_surface(state_->context.get(), other.state_->surface.get(), corner.x, corner.y);
  cairo().cairo_paint(state_->context.get());
}

void Canvas::text(Spot at, const std::string& words, double size, Rgb colour, Align horizontal, Align vertical,
                  bool upwards) {
  if (words.empty()) return;
  const Letters letters(words, size);
  const auto aligned = [](Align align, double length) {
    return align == Align::begin ? 0 : align == Align::middle ? 0.5 * length : length;
  };
  cairo_t* context = state_->context.get();
  cairo().cairo_save(context);
  cairo().cairo_translate(context, at.x, at.y);
  if (upwards) cairo().cairo_rotate(context, -0.5 * std::numbers::pi);
  state_->pen(colour);
  const double capital = capital_height * size;
  state_->move({-aligned(horizontal, letters.width()), capital - letters.baseline() - aligned(vertical, capital)});
  letters.show(context);
  cairo().cairo_restore(context);
}

double Canvas::text_width(const std::string& words, double size) { return Letters(words, size).width(); }

RgbImage Canvas::image(double dpi) const {
  const double scale = dpi / screen_dpi;
  const int columns = round_int(state_->width * scale);
  const int rows = round_int(state_->height * scale);
  const std::string size = "figure: " + std::to_string(columns) + " x " + std::to_string(rows) + " pixels";
  const std::string remedy = "reduce --image-size or --dpi, or write a PDF or SVG";
  if (std::max(columns, rows) > most_pixels) {
    throw Error{Fault::usage, size + " are more than " + std::to_string(most_pixels) + " a side; " + remedy};
  }
  require_memory(bytes_per_pixel * columns * rows, size, remedy);
  const Pixels pixels(columns, rows);
  state_->replay(pixels.surface(), scale);
  return pixels.give(columns, rows);
}

std::string Canvas::pdf(const std::string& history) const {
  std::string bytes;
  const Surface file = owned(cairo().cairo_pdf_surface_create_for_stream(append, &bytes, state_->width * points_per_px,
                                                                         state_->height * points_per_px));
  cairo().cairo_pdf_surface_set_metadata(file.get(), CAIRO_PDF_METADATA_SUBJECT, printable(history).c_str());
  cairo().cairo_pdf_surface_set_metadata(file.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  state_->replay(file, points_per_px);
  cairo().cairo_surface_finish(file.get());
  require_success(cairo().cairo_surface_status(file.get()));
  return bytes;
}

std::string Canvas::svg(const std::string& history) const {
  std::string bytes;
  const Surface file = owned(cairo().cairo_svg_surface_create_for_stream(append, &bytes, state_->width * points_per_px,
                                                                         state_->height * points_per_px));
  state_->replay(file, points_per_px);
  cairo().cairo_surface_finish(file.get());
  require_success(cairo().cairo_surface_status(file.get()));
  const std::size_t root = bytes.find('>', bytes.find("<svg")) + 1;
  // Cairo does not write how an image is enlarged.
  const std::string style = state_->pixelated ? "<style>image{image-rendering:pixelated}</style>" : "";
  return bytes.insert(root, "\n<desc>" + page_text(history) + "</desc>" + style);
}

}  // namespace vam::plot
