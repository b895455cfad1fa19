// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/log/progress.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/text.hpp"
#include "io/image/video.hpp"
#include "model/dose/dose_metrics.hpp"
#include "plot/image_figure.hpp"
#include "plot/render.hpp"
#include "session/surface.hpp"
#include "solid/mesh/geometry.hpp"
#include "vam-view/figures.hpp"

namespace vam::view_tool {

namespace {

constexpr double fps = 20;
constexpr int growing = 120, standing = 20;  // frames
constexpr int at_once = 8;                   // of them are drawn

double largest(const io::SparseVolume& dose) {
  const model::Grid& grid = dose.grid();
  std::vector<float> slice(grid.slice_size());
  float most = 0;
  for (int k = 0; k < grid.nz; ++k) {
    dose.read_slices(k, 1, slice.data());
    most = std::max(most, *std::max_element(slice.begin(), slice.end()));
  }
  return static_cast<double>(most);
}

/// As wide as its value at the end, by blanks that are as wide as a digit.
std::string part_of(double whole, double fraction, int decimals) {
  std::string text = fixed_number(fraction * whole, decimals);
  for (std::size_t n = text.size(); n < fixed_number(whole, decimals).size(); ++n) text.insert(0, "\u2007");
  return text;
}

/// "turn 2.4 of 6, 43 s" or "57 % of the exposure".
std::string time_text(double fraction, const std::optional<Exposure::Duration>& whole) {
  if (!whole) return part_of(100, fraction, 0) + " % of the exposure";
  return "turn " + part_of(whole->turns, fraction, 1) + " of " + format_number(whole->turns, 3) + ", " +
         part_of(whole->seconds, fraction, 0) + " s";
}

/// Figures may differ by a pixel, frames may not.
RgbImage of_size(const RgbImage& image, int width, int height) {
  RgbImage out(width, height, plot::paint::white);
  for (int y = 0; y < std::min(height, image.height); ++y) {
    for (int x = 0; x < std::min(width, image.width); ++x) out(x, y) = image(x, y);
  }
  return out;
}

class Growth {
 public:
  Growth(const io::SparseVolume& dose, const io::SparseVolume& target, const io::SparseVolume* insert,
         const Exposure& exposure, const plot::ViewOptions& view)
      : dose_(dose),
        target_(target),
        exposure_(exposure),
        view_(view),
        part_{session::fine_surface(target, model::half_surface, target.metadata), {}},
        insert_(insert_body(insert, target)) {
    if (part_.mesh.triangles.empty()) throw Error{Fault::data, view.name + ": the target is empty"};
    const plot::Body print = print_after(1);
    if (print.mesh.triangles.empty()) {
      throw Error{Fault::data, view.name + ": nothing prints at a threshold of " +
                                   format_number(exposure.threshold, 4) + " " + dose.units +
                                   "; choose a lower --isovalue"};
    }
    sight_ = sight_of({&part_, &print, &insert_});
    first_ = exposure.threshold / largest(dose);
    figure_.columns = 2;
    add_panel(figure_, {&part_, &insert_}, sight_, view_.size * 7 / 10, "target");
    label(figure_, sight_, view_, ": the print as it grows");
    figure_.legend = {{plot::Mark::none, {}, "target " + size_text(solid::bounding_box(part_.mesh))}};
    name_insert(figure_, insert_);
  }

  /// What a growing frame shows.
  [[nodiscard]] plot::Body print(int n) const { return print_after(fraction(n)); }

  [[nodiscard]] RgbImage frame(int n, const plot::Body& print, double dpi) const {
    std::vector<const plot::Body*> so_far{&insert_};
    if (!print.mesh.triangles.empty()) so_far.push_back(&print);
    plot::ImageFigure figure = figure_;
    add_panel(figure, so_far, sight_, view_.size * 7 / 10, time_text(fraction(n), exposure_.duration));
    return plot::draw(figure).image(dpi);
  }

 private:
  [[nodiscard]] double fraction(int n) const { return first_ + (1 - first_) * static_cast<double>(n) / (growing - 1); }
  [[nodiscard]] plot::Body print_after(double fraction) const {
    return {session::fine_surface(dose_, exposure_.threshold / fraction, target_.metadata), {}};
  }

  const io::SparseVolume& dose_;
  const io::SparseVolume& target_;
  const Exposure& exposure_;
  const plot::ViewOptions& view_;
  plot::Body part_;
  plot::Body insert_;
  Sight sight_;
  plot::ImageFigure figure_;  // with the target alone
  double first_ = 0;          // fraction of the exposure at which the first resin gels
};

}  // namespace

void write_movie(const std::string& path, const io::SparseVolume& dose, const io::SparseVolume& target,
                 const io::SparseVolume* insert, const Exposure& exposure, const plot::ViewOptions& view, double dpi,
                 const std::string& history) {
  const Growth growth(dose, target, insert, exposure, view);
  RgbImage frame = growth.frame(growing - 1, growth.print(growing - 1), dpi);
  const int width = frame.width, height = frame.height;
  io::VideoWriter movie(path, {.width = width, .height = height, .fps = fps, .comment = history, .colour = true});
  Progress progress("drawing", growing);
  for (int n = 0; n < growing; n += at_once) {
    const int count = std::min(at_once, growing - n);
    std::vector<plot::Body> prints;  // one after the other, each by all threads: each takes the volume once more
    for (int i = 0; i < count; ++i) prints.push_back(growth.print(n + i));
    std::vector<RgbImage> frames(prints.size());
    parallel_for(count, [&](int i) {
      frames[i] = of_size(growth.frame(n + i, prints[i], dpi), width, height);
      progress.tick();
    });
    for (const RgbImage& one : frames) movie.write(one);
    frame = frames.back();
  }
  for (int n = 0; n < standing; ++n) movie.write(frame);
  movie.commit();
}

}  // namespace vam::view_tool
