#include "metrology/ost/ost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "base/text.hpp"
#include "metrology/ost/private/angle_grid.hpp"
#include "optics/resample.hpp"
#include "optics/vial.hpp"
#include "tomo/filter.hpp"
#include "tomo/radon.hpp"

namespace vam::metrology {

namespace {

constexpr int slices_a_pass = 4 * lanes;  // tomo shares its weights among four slabs

// Camera sinograms of all z slices, k = 0 lowest: columns x angles.
std::vector<Image> camera_sinograms(std::span<const CameraView> views, const AngleGrid& turn, const AxisPose& axis,
                                    double row_stretch, int slices) {
  std::vector<Image> straight(views.size());
  parallel_for(static_cast<int>(views.size()), [&](int i) {
    const auto v = static_cast<std::size_t>(i);
    straight[v] = straightened(views[v].image, axis, row_stretch);
  });
  const int columns = views.front().image.width;
  const int angles = turn.summary().angles;
  std::vector<Image> sinograms(static_cast<std::size_t>(slices));
  parallel_for(slices, [&](int k) {
    Image& sinogram = sinograms[k];
    sinogram = Image(columns, angles);
    for (int a = 0; a < angles; ++a) {
      float* out = sinogram.row(a);
      for (const auto& tap : turn.taps(a)) {
        const Image& image = straight[tap.frame];
        const float* in = image.row(image.height - 1 - k);
        for (int x = 0; x < columns; ++x) out[x] += tap.weight * in[x];
      }
    }
  });
  return sinograms;
}

// Without refraction: the columns as they are, only brought to the virtual pitch by linear interpolation.
void rescale_columns(const Image& in, const optics::Detector& camera, const optics::Detector& detector, Image& out) {
  out = Image(detector.columns, in.height);
  for (int c = 0; c < detector.columns; ++c) {
    const double at = camera.column(detector.x_mm(c));
    const int low = static_cast<int>(std::floor(at));
    if (low < 0 || low + 1 >= in.width) continue;
    const auto f = static_cast<float>(at - low);
    for (int a = 0; a < in.height; ++a) out(c, a) = (1 - f) * in(low, a) + f * in(low + 1, a);
  }
}

void scale(std::vector<Slab>& slabs, float factor) {
  for (auto& slab : slabs) {
    for (float& value : slab.values) value *= factor;
  }
}

}  // namespace

struct OstReconstructor::State {
  OstOptions options;
  AxisPose axis;
  optics::View view;
  optics::Detector camera;
  optics::Detector detector;  // virtual, pitch = voxel
  double azimuth_rad = 0;
  int direction = 1;
  double row_stretch = 1;
  model::Grid grid;

  [[nodiscard]] tomo::ParallelGeometry geometry(int angles) const {
    return {.nx = grid.nx,
            .ny = grid.ny,
            .columns = detector.columns,
            .angles = angles,
            .axis_x = 0.5 * (grid.nx - 1),
            .axis_y = 0.5 * (grid.ny - 1),
            .angle_start_rad = 0,
            .angle_step_rad = 2 * std::numbers::pi / angles};
  }

  [[nodiscard]] std::vector<Image> virtual_sinograms(const std::vector<Image>& sinograms) const;
  void refine(const tomo::ParallelGeometry& geometry, const std::vector<Slab>& sinograms,
              std::vector<Slab>& images) const;
  [[nodiscard]] std::vector<Slab> densities(const tomo::ParallelGeometry& geometry, const tomo::Filter& filter,
                                            const std::vector<Slab>& sinograms) const;
};

OstReconstructor::OstReconstructor(const model::Printer& printer, double pixel_mm, int columns, int rows,
                                   const AxisPose& axis, const OstOptions& options)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = options;
  s.axis = axis;
  s.view = optics::camera_view(printer);
  s.camera = {columns, pixel_mm, axis.column};
  s.azimuth_rad = printer.camera.azimuth_deg * rad_per_deg;
  s.direction = printer.stage.direction;
  const double voxel_mm = options.voxel_mm > 0 ? options.voxel_mm : pixel_mm;
  const double seen_mm = std::min(s.camera.x_mm(columns - 1), -s.camera.x_mm(0));  // the nearer edge of the frame
  const auto edge = optics::chief_ray(s.view, std::max(0.0, seen_mm));
  const double through_vial = options.refraction ? (edge.hits ? edge.x_v_mm : optics::reach_mm(s.view)) : seen_mm;
  const double radius_mm = options.radius_mm > 0 ? std::min(options.radius_mm, through_vial) : through_vial;
  const int half = static_cast<int>(std::floor(radius_mm / voxel_mm));
  if (half < 2) {
    throw Error{Fault::data, "views: the camera sees only " + format_number(radius_mm, 3) +
                                 " mm beside the axis (column " + format_number(axis.column, 5) + " of " +
                                 std::to_string(columns) + "); check camera.pixel_mm and the axis"};
  }
  s.detector = optics::centred_detector(2 * half + 1, voxel_mm);
  s.row_stretch = pixel_mm / (image_magnification(printer) * voxel_mm);
  const int slices = std::max(1, static_cast<int>(std::floor(rows * s.row_stretch)));
  s.grid = model::centred_grid(2 * half + 1, 2 * half + 1, slices, voxel_mm, -0.5 * (slices - 1) * voxel_mm);
}

OstReconstructor::~OstReconstructor() = default;

const model::Grid& OstReconstructor::grid() const { return state_->grid; }

std::vector<Image> OstReconstructor::State::virtual_sinograms(const std::vector<Image>& sinograms) const {
  std::vector<Image> out(sinograms.size());
  if (!options.refraction) {
    parallel_for(static_cast<int>(out.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      rescale_columns(sinograms[i], camera, detector, out[i]);
    });
    return out;
  }
  const int angles = sinograms.front().height;
  // A camera weighs a ray's light by what leaves the glass, T, and each pixel sees a beam as wide as J.
  const optics::ResampleOptions how{
      .fresnel = true, .jacobian = false, .angle_offset_rad = azimuth_rad, .direction = direction};
  const auto plan = optics::plan_to_virtual(view, camera, detector, {angles, 0, 2 * std::numbers::pi / angles}, how);
  optics::resample(plan, sinograms, out);
  return out;
}

// MLEM: x <- x * A*(g / A x) / A* 1 [SV82]; keeps x >= 0 and the counts.
void OstReconstructor::State::refine(const tomo::ParallelGeometry& geometry, const std::vector<Slab>& sinograms,
                                     std::vector<Slab>& images) const {
  std::vector<Slab> ones(1, Slab(geometry.columns, geometry.angles));
  std::fill(ones[0].values.begin(), ones[0].values.end(), 1.0F);
  std::vector<Slab> norm(1, Slab(geometry.nx, geometry.ny));
  tomo::adjoint(geometry, ones, norm);
  std::vector<Slab> ratio(images.size(), Slab(geometry.columns, geometry.angles));
  std::vector<Slab> back(images.size(), Slab(geometry.nx, geometry.ny));
  float brightest = 0;
  for (const auto& image : images)
    brightest = std::max(brightest, *std::max_element(image.values.begin(), image.values.end()));
  const float floor = 1e-3F * brightest;  // MLEM never leaves 0: start a little above
  for (auto& image : images) {
    for (float& x : image.values) x = std::max(x, floor);
  }
  for (int iteration = 0; iteration < options.statistical; ++iteration) {
    tomo::forward(geometry, images, ratio);
    for (std::size_t s = 0; s < images.size(); ++s) {
      const auto& measured = sinograms[s].values;
      auto& r = ratio[s].values;
      for (std::size_t i = 0; i < r.size(); ++i) r[i] = r[i] > floor ? std::max(0.0F, measured[i]) / r[i] : 0.0F;
    }
    tomo::adjoint(geometry, ratio, back);
    for (std::size_t s = 0; s < images.size(); ++s) {
      for (std::size_t i = 0; i < back[s].values.size(); ++i) {
        const float n = norm[0].values[i];
        images[s].values[i] *= n > 0 ? back[s].values[i] / n : 0.0F;
      }
    }
  }
}

// Filtered back-projection, where asked for the start of MLEM; densities in 1/mm.
std::vector<Slab> OstReconstructor::State::densities(const tomo::ParallelGeometry& geometry, const tomo::Filter& filter,
                                                     const std::vector<Slab>& sinograms) const {
  std::vector<Slab> filtered = sinograms;
  for (auto& slab : filtered) filter.apply(slab);
  std::vector<Slab> images(sinograms.size(), Slab(geometry.nx, geometry.ny));
  tomo::adjoint(geometry, filtered, images);
  const float to_density = static_cast<float>(0.5 * geometry.angle_step_rad / grid.voxel_mm);
  const bool statistical = options.statistical > 0;
  scale(images, statistical ? to_density * static_cast<float>(grid.voxel_mm) : to_density);
  if (options.non_negative) {
    for (auto& image : images) {
      for (float& x : image.values) x = std::max(x, 0.0F);
    }
  }
  if (statistical) {
    refine(geometry, sinograms, images);
    scale(images, static_cast<float>(1 / grid.voxel_mm));
  }
  return images;
}

model::Volume OstReconstructor::reconstruct(std::span<const CameraView> views) const {
  const State& s = *state_;
  std::vector<double> angles_deg;
  for (const CameraView& view : views) angles_deg.push_back(view.angle_deg);
  const AngleGrid turn(angles_deg, 0);
  const auto sinograms = s.virtual_sinograms(camera_sinograms(views, turn, s.axis, s.row_stretch, s.grid.nz));

  const auto geometry = s.geometry(turn.summary().angles);
  const tomo::Filter filter(geometry.columns, {.window = tomo::window_from_name(s.options.window)});
  model::Volume volume{s.grid, std::vector<float>(s.grid.size())};
  for (int first = 0; first < s.grid.nz; first += slices_a_pass) {
    const int count = std::min(slices_a_pass, s.grid.nz - first);
    const auto slices = std::span(sinograms).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
    const auto images = s.densities(geometry, filter, packed(slices, slices.front().width, slices.front().height));
    for (int k = 0; k < count; k += lanes) {
      const auto& image = images[k / lanes];
      unpack(image, std::min(lanes, count - k), volume.slice(first + k));
    }
  }
  return volume;
}

double image_magnification(const model::Printer& printer) {
  return 1 / (1 - model::shortening_mm(printer, printer.camera.index_resin) / printer.camera.distance_mm);
}

Image mean_view(std::span<const CameraView> views) {
  std::vector<double> angles_deg;
  for (const CameraView& view : views) angles_deg.push_back(view.angle_deg);
  const AngleGrid turn(angles_deg, 0);
  Image mean(views.front().image.width, views.front().image.height);
  const float share = 1.0F / static_cast<float>(turn.summary().angles);
  for (int a = 0; a < turn.summary().angles; ++a) {
    for (const auto& tap : turn.taps(a)) {
      const Image& image = views[tap.frame].image;
      for (std::size_t i = 0; i < mean.size(); ++i) mean.values[i] += share * tap.weight * image.values[i];
    }
  }
  return mean;
}

}  // namespace vam::metrology
