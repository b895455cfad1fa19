#include "io/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::io {

namespace {

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(const Image& image) {
    for (const float value : image.values) {
      low = std::min(low, static_cast<double>(value));
      high = std::max(high, static_cast<double>(value));
    }
  }
};

// Indices of `wanted` of `count` things, evenly spread, the outer ones half a step from the ends.
std::vector<int> spread(int count, int wanted) {
  std::vector<int> indices;
  const int shown = std::clamp(wanted, 1, count);
  for (int n = 0; n < shown; ++n) indices.push_back(static_cast<int>((n + 0.5) * count / shown));
  return indices;
}

// Signed values get the diverging colours with zero in the middle; coverage and light are grey; amounts viridis.
void choose_colours(ImageFigure& figure, const ViewOptions& options, Extremes found, bool grey) {
  const bool is_signed = found.low < -1e-3 * std::abs(found.high);
  std::string colours = options.colours;
  if (colours == "auto") colours = is_signed ? "diverging" : grey ? "grey" : "viridis";
  figure.colours = colours == "diverging" ? ColourMap::diverging
                   : colours == "grey"    ? ColourMap::grey
                                          : ColourMap::viridis;
  const double reach = std::max(std::abs(found.low), std::abs(found.high));
  const bool diverging = figure.colours == ColourMap::diverging;
  figure.low = options.low.value_or(diverging ? -reach : std::min(0.0, found.low));
  figure.high = options.high.value_or(diverging ? reach : found.high);
  if (!(figure.high > figure.low)) figure.high = figure.low + 1;
}

bool is_coverage(const std::string& grid) { return grid == "target" || grid == "insert" || grid == "weight"; }

std::string with_unit(const std::string& what, const std::string& unit) { return what + " (" + unit + ")"; }

std::string mm(double value) { return format_number(std::abs(value) < 1e-9 ? 0 : value, 4) + " mm"; }

const char* plane_name(Plane plane) {
  return plane == Plane::axial ? "axial" : plane == Plane::coronal ? "coronal" : "sagittal";
}

}  // namespace

ImageFigure view_volume(const SparseVolume& volume, const SparseVolume* target, const ViewOptions& options) {
  const model::Grid& grid = volume.grid();
  const int count = plane_count(grid, options.plane);
  std::vector<int> indices = spread(count, options.sheet);
  if (options.at) indices = {plane_index(grid, options.plane, *options.at)};
  std::vector<double> places;
  for (const int index : indices) places.push_back(plane_mm(grid, options.plane, index));
  if (options.at && std::abs(places[0] - *options.at) > 0.51 * grid.voxel_mm) {
    throw Error{Fault::data, options.name + ": has no " + plane_name(options.plane) + " section at " + mm(*options.at) +
                                 "; it reaches from " + mm(plane_mm(grid, options.plane, 0)) + " to " +
                                 mm(plane_mm(grid, options.plane, count - 1))};
  }
  const PlaneAxes axes = plane_axes(options.plane);
  std::vector<Image> sections = planes(volume, options.plane, indices);
  ImageFigure figure;
  Extremes found;
  for (std::size_t n = 0; n < sections.size(); ++n) {
    found.add(sections[n]);
    figure.panels.push_back({std::move(sections[n]), std::string(axes.across) + " = " + mm(places[n]), {}});
  }
  if (target != nullptr) {
    const auto lines = outlines(*target, grid, options.plane, places);
    for (std::size_t n = 0; n < lines.size(); ++n) figure.panels[n].outline = lines[n];
    figure.outline_name = "surface of the target";
  }
  if (is_coverage(volume.name())) found.high = std::max(found.high, 1.0);
  choose_colours(figure, options, found, is_coverage(volume.name()));
  const Spot first = plane_origin_mm(grid, options.plane);
  const Image& shape = figure.panels.front().values;
  const double half = 0.5 * grid.voxel_mm;
  figure.x = {std::string(axes.right) + " (mm)", first.x - half, first.x - half + shape.width * grid.voxel_mm, false};
  figure.y = {std::string(axes.up) + " (mm)", first.y - half, first.y - half + shape.height * grid.voxel_mm, false};
  figure.value_label =
      is_coverage(volume.name()) ? volume.name() + " (covered fraction)" : with_unit(volume.name(), volume.units);
  figure.pixel_mm = grid.voxel_mm;
  figure.size = options.size;
  figure.title = options.name + ": " + volume.name() + ", " + plane_name(options.plane);
  figure.title += figure.panels.size() == 1
                      ? " section at " + figure.panels[0].caption
                      : " sections, " + std::string(axes.right) + " to the right, " + axes.up + " up";
  return figure;
}

namespace {

double angle_of(const model::StackInfo& info, const model::ImageInfo& about, int index) {
  return about.has_angle ? about.angle_deg : info.angle_start_deg + index * info.angle_step_deg;
}

double coordinate(const model::StackInfo& info, const model::ImageInfo& about, int index) {
  return info.kind == model::Kind::sinogram ? about.z_mm : angle_of(info, about, index);
}

std::string caption_of(const model::StackInfo& info, const model::ImageInfo& about, int index) {
  if (info.kind == model::Kind::sinogram) return "z = " + mm(about.z_mm);
  if (about.has_angle || info.angle_step_deg != 0) return format_number(angle_of(info, about, index), 5) + " deg";
  return about.has_time ? format_number(about.time_s, 5) + " s" : "frame " + std::to_string(index);
}

void set_axes(ImageFigure& figure, const model::StackInfo& info) {
  const bool sinogram = info.kind == model::Kind::sinogram;
  const double half = 0.5 * info.width * info.pixel_mm;
  figure.x = info.pixel_mm > 0 ? Axis{"column, from the middle (mm)", -half, half, false}
                               : Axis{"column", -0.5, info.width - 0.5, false};
  const double start = sinogram ? info.angle_start_deg : info.z_start_mm;
  const double step = sinogram ? info.angle_step_deg : info.row_mm;
  const char* label = sinogram ? "stage angle (deg)" : "z (mm)";
  // Row 0 is at the top, so the axis runs downwards with the rows.
  figure.y = step != 0 ? Axis{label, start + (info.height - 0.5) * step, start - 0.5 * step, false}
                       : Axis{"row", info.height - 0.5, -0.5, false};
  constexpr double turn_ticks_deg = 45;
  if (sinogram && std::abs(step) * info.height > 180) figure.y.step = turn_ticks_deg;
  figure.square_pixels = !sinogram;
  if (!sinogram && info.pixel_mm > 0) figure.pixel_mm = info.pixel_mm;
}

// Keeps what is to be shown while the stack goes by.
class Selection {
 public:
  Selection(const model::StackInfo& info, const ViewOptions& options)
      : info_(info), at_(options.at), indices_(spread(info.count, options.sheet)) {
    if (options.sheet <= 1 && info.kind == model::Kind::frames) indices_ = {0};
  }

  void offer(Image&& image, const model::ImageInfo& about, int index) {
    if (at_) {
      const double away = std::abs(coordinate(info_, about, index) - *at_);
      if (index > 0 && away >= nearest_) return;
      nearest_ = away;
      panels = {{std::move(image), caption_of(info_, about, index), {}}};
    } else if (std::find(indices_.begin(), indices_.end(), index) != indices_.end()) {
      panels.push_back({std::move(image), caption_of(info_, about, index), {}});
    }
  }

  // How far the picture shown is from the place wanted.
  [[nodiscard]] double away() const { return nearest_; }

  std::vector<Panel> panels;

 private:
  model::StackInfo info_;
  std::optional<double> at_;
  std::vector<int> indices_;
  double nearest_ = 0;
};

}  // namespace

ImageFigure view_images(ImageSource& images, const ViewOptions& options) {
  const model::StackInfo info = images.info();
  const bool sinogram = info.kind == model::Kind::sinogram;
  if (options.at && !sinogram && info.angle_step_deg == 0) {
    throw Error{Fault::data, options.name + ": its pictures have no angles; show one by a sheet, or use the EXR stack"};
  }
  Selection selection(info, options);
  Image image;
  model::ImageInfo about;
  for (int index = 0; images.next(image, about); ++index) selection.offer(std::move(image), about, index);
  if (selection.panels.empty()) throw Error{Fault::data, options.name + ": has no picture"};
  const double pitch = std::abs(sinogram ? info.row_mm : info.angle_step_deg);
  if (selection.away() > 0.51 * pitch + 1e-6) {
    throw Error{Fault::data, options.name + ": has none at " + format_number(*options.at) + "; the nearest is " +
                                 selection.panels[0].caption};
  }
  ImageFigure figure;
  figure.panels = std::move(selection.panels);
  Extremes found;
  for (const auto& panel : figure.panels) found.add(panel.values);
  if (info.units.starts_with("fraction")) found.high = 1;
  choose_colours(figure, options, found, !sinogram);
  set_axes(figure, info);
  figure.value_label = with_unit(sinogram ? "sinogram" : "light", info.units);
  figure.size = options.size;
  figure.title = options.name + (sinogram ? ": sinogram" : ": frame");
  figure.title += figure.panels.size() == 1
                      ? (sinogram ? " at " : ", ") + figure.panels[0].caption
                      : std::string(sinogram ? "s, columns to the right, angles down" : "s, upright as in the file");
  return figure;
}

namespace {

enum class Side { inside, outside, neither };

// One pass over both volumes, slab by slab; visit(dose, side).
template <class Visit>
void for_each_voxel(const SparseVolume& dose, const SparseVolume& target, const model::Circle& circle, Visit visit) {
  const model::Grid& grid = dose.grid();
  constexpr int slab = 8;
  std::vector<float> doses(grid.slice_size() * slab);
  std::vector<float> covered(grid.slice_size() * slab);
  constexpr float whole = 1e-3F;  // of a voxel: rounding of the coverage
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    dose.read_slices(k, count, doses.data());
    target.read_slices(k, count, covered.data());
    for (std::size_t i = 0; i < grid.slice_size() * static_cast<std::size_t>(count); ++i) {
      const auto in_slice = static_cast<int>(i % grid.slice_size());
      const bool void_counts = circle.contains(in_slice % grid.nx, in_slice / grid.nx);
      if (covered[i] > 1 - whole) visit(doses[i], Side::inside);
      if (covered[i] < whole && void_counts) visit(doses[i], Side::outside);
    }
  }
}

struct Sides {
  Extremes inside;
  Extremes outside;
};

}  // namespace

Plot dose_histogram(const SparseVolume& dose, const SparseVolume& target, const model::Circle& circle,
                    const ViewOptions& options) {
  const model::Grid& grid = dose.grid();
  const model::Grid& other = target.grid();
  if (grid.nx != other.nx || grid.ny != other.ny || grid.nz != other.nz) {
    const auto text = [](const model::Grid& g) {
      return std::to_string(g.nx) + " x " + std::to_string(g.ny) + " x " + std::to_string(g.nz);
    };
    throw Error{Fault::data, options.name + ": the dose has " + text(grid) + " voxels, but the target has " +
                                 text(other) + "; make the dose for this target"};
  }
  Sides extremes;
  for_each_voxel(dose, target, circle, [&](float value, Side side) {
    Extremes& those = side == Side::inside ? extremes.inside : extremes.outside;
    those.low = std::min(those.low, static_cast<double>(value));
    those.high = std::max(those.high, static_cast<double>(value));
  });
  if (!(extremes.inside.high >= extremes.inside.low))
    throw Error{Fault::data, options.name + ": the target has no whole voxel inside the part"};
  if (!(extremes.outside.high >= extremes.outside.low))
    throw Error{Fault::data, options.name + ": the target has no voxel outside the part"};
  const double low = options.low.value_or(std::min({0.0, extremes.inside.low, extremes.outside.low}));
  const double high = options.high.value_or(std::max(extremes.inside.high, extremes.outside.high));
  constexpr int bins = 120;
  HistogramBuilder inside(low, high, bins);
  HistogramBuilder outside(low, high, bins);
  for_each_voxel(dose, target, circle, [&](float value, Side side) {
    (side == Side::inside ? inside : outside).add(static_cast<double>(value));
  });
  Plot plot;
  plot.title = options.name + ": dose inside and outside the part";
  plot.x = {with_unit("dose", dose.units), low, high, false};
  plot.y = {"share of the voxels of each side (%)", 0, 0, false};
  const auto bars_out = outside.done();
  const auto bars_in = inside.done();
  plot.series = {{"outside the part", bars_out.edges, bars_out.percent, paint::blue, SeriesStyle::bars},
                 {"inside the part", bars_in.edges, bars_in.percent, paint::vermilion, SeriesStyle::bars}};
  plot.markers = {{extremes.inside.low, "lowest inside " + format_number(extremes.inside.low, 4), paint::vermilion},
                  {extremes.outside.high, "highest outside " + format_number(extremes.outside.high, 4), paint::blue}};
  return plot;
}

}  // namespace vam::io
