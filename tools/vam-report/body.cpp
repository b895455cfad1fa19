#include "vam-report/body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/base64.hpp"
#include "base/json.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "plot/canvas.hpp"
#include "plot/colour_map.hpp"
#include "plot/page.hpp"
#include "solid/mesh/surface.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-report/page_data.hpp"

namespace vam::report_tool {

namespace {

constexpr std::size_t most_voxels = 2'000'000;
constexpr std::size_t most_vertices = 60'000;
constexpr double flat = 0.02;  // adaptivity of the surfaces: large faces take few triangles

/// Means of by x by x by voxels; beyond the volume is nothing.
model::Volume averaged(const io::SparseVolume& volume, int by) {
  const model::Grid& fine = volume.grid();
  const auto fewer = [by](int count) { return (count + by - 1) / by; };
  const double shift_mm = 0.5 * (by - 1) * fine.voxel_mm;
  model::Volume coarse{{fewer(fine.nx), fewer(fine.ny), fewer(fine.nz), by * fine.voxel_mm, fine.origin_mm}, {}};
  for (double& origin : coarse.grid.origin_mm) origin += shift_mm;
  coarse.values.resize(coarse.grid.size());
  const float share = 1.0F / static_cast<float>(by * by * by);
  std::vector<float> slice(fine.slice_size());
  for (int k = 0; k < fine.nz; ++k) {
    volume.read_slices(k, 1, slice.data());
    float* out = coarse.slice(k / by);
    for (int j = 0; j < fine.ny; ++j) {
      const float* row = slice.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.nx);
      float* sums = out + static_cast<std::size_t>(j / by) * static_cast<std::size_t>(coarse.grid.nx);
      for (int i = 0; i < fine.nx; ++i) sums[i / by] += share * row[i];
    }
  }
  return coarse;
}

/// Trilinear; the border's value beyond it.
double value_at(const model::Volume& volume, const Vector3& point) {
  const model::Grid& grid = volume.grid;
  const std::array<int, 3> counts{grid.nx, grid.ny, grid.nz};
  std::array<int, 3> low{};
  std::array<double, 3> part{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place =
        std::clamp((point[axis] - grid.origin_mm[axis]) / grid.voxel_mm, 0.0, static_cast<double>(counts[axis] - 1));
    low[axis] = std::min(static_cast<int>(place), std::max(0, counts[axis] - 2));
    part[axis] = place - low[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    double weight = 1;
    std::array<int, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      weight *= step[axis] == 1 ? part[axis] : 1 - part[axis];
      at[axis] = std::min(low[axis] + step[axis], counts[axis] - 1);
    }
    sum += weight * static_cast<double>(volume.slice(at[2])[at[1] * grid.nx + at[0]]);
  }
  return sum;
}

struct Layer {
  std::string name;
  model::TriangleSoup mesh;
  std::vector<double> values;  // one a vertex; none: grey
  double limit = 1;            // of the colours, on either side of 0
  std::string unit;
  std::string meaning;
};

/// The 98th percentile of the magnitudes as a number with one digit.
double colour_limit(std::vector<double> values, double least) {
  for (double& value : values) value = std::abs(value);
  if (values.empty()) return least;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  const double wanted = std::max(least, *at);
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  return std::ceil(wanted / power) * power;
}

template <class Number>
std::string encoded(const std::vector<Number>& numbers) {
  std::string raw(numbers.size() * sizeof(Number), '\0');
  std::memcpy(raw.data(), numbers.data(), raw.size());
  return base64(raw);
}

Json packed(const Layer& layer, const solid::Box& box) {
  std::vector<std::uint16_t> positions;
  std::vector<std::uint8_t> colours;
  std::vector<std::uint32_t> triangles;
  for (std::size_t n = 0; n < layer.mesh.points.size(); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (layer.mesh.points[n][axis] - box.low[axis]) / (box.high[axis] - box.low[axis]);
      positions.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(place, 0.0, 1.0))));
    }
    const Rgb colour = layer.values.empty()
                           ? plot::paint::light_grey
                           : plot::colour(plot::ColourMap::diverging, 0.5 + 0.5 * layer.values[n] / layer.limit);
    colours.insert(colours.end(), colour.begin(), colour.end());
  }
  for (const auto& triangle : layer.mesh.triangles) triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  return Json::array({encoded(positions), encoded(colours), encoded(triangles)});
}

std::string scale(const Layer& layer, bool hidden) {
  if (layer.values.empty()) return "<div class=\"scale\"" + std::string(hidden ? " hidden" : "") + "></div>";
  std::string stops;
  for (int n = 0; n <= 4; ++n) {
    const Rgb colour = plot::colour(plot::ColourMap::diverging, 0.25 * n);
    stops +=
        ",rgb(" + std::to_string(colour[0]) + "," + std::to_string(colour[1]) + "," + std::to_string(colour[2]) + ")";
  }
  const std::string limit = format_number(layer.limit, 2) + " " + layer.unit;
  return "<div class=\"scale\"" + std::string(hidden ? " hidden" : "") + "><span>-" + limit +
         "</span><i style=\"background:linear-gradient(90deg" + stops + ")\"></i><span>+" + limit + "</span><span>" +
         page_text(layer.meaning) + "</span></div>";
}

std::string choices(const std::vector<Layer>& layers) {
  if (layers.size() < 2) return "";
  std::string made = "<div class=\"control\">";
  for (std::size_t n = 0; n < layers.size(); ++n) {
    made += "<label><input type=\"radio\" name=\"layer\"" + std::string(n == 0 ? " checked" : "") + ">" +
            page_text(layers[n].name) + "</label>";
  }
  return made + "</div>";
}

/// The design, and the print where there is a dose, on voxels of this coarseness.
std::vector<Layer> layers_of(const io::SparseVolume& target, const std::optional<PrintedDose>& print, int by) {
  std::vector<Layer> layers(1);
  layers[0].name = "design";
  layers[0].mesh = solid::isosurface(averaged(target, by), 0.5, flat);
  if (!print || layers[0].mesh.triangles.empty()) return layers;
  const model::Volume dose = averaged(*print->dose, by);
  Layer& design = layers[0];
  for (const auto& point : design.mesh.points)
    design.values.push_back(100 * (value_at(dose, point) / print->threshold - 1));
  design.limit = colour_limit(design.values, 1);
  design.unit = "%";
  design.meaning = "dose on the design's surface relative to the threshold; blue: too low";
  Layer printed{"print", solid::isosurface(dose, print->threshold, flat), {}, 1, "mm", ""};
  if (printed.mesh.triangles.empty()) return layers;
  const std::vector<float> away = solid::Surface(design.mesh).signed_distances(printed.mesh.points);
  printed.values.assign(away.begin(), away.end());
  printed.limit = colour_limit(printed.values, 0.1 * target.grid().voxel_mm);
  printed.meaning = "distance of the print from the design; red: outside, blue: missing";
  layers.push_back(std::move(printed));
  return layers;
}

std::size_t vertices(const std::vector<Layer>& layers) {
  std::size_t most = 0;
  for (const Layer& layer : layers) most = std::max(most, layer.mesh.points.size());
  return most;
}

}  // namespace

std::string body_view(const io::SparseVolume& target, const std::optional<PrintedDose>& print) {
  int by = 1;
  while (target.grid().size() / static_cast<std::size_t>(by * by * by) > most_voxels) ++by;
  std::vector<Layer> layers = layers_of(target, print, by);
  while (vertices(layers) > most_vertices) layers = layers_of(target, print, ++by);
  if (layers[0].mesh.triangles.empty()) return "";
  for (Layer& layer : layers) tool::unstretch(layer.mesh, target.metadata);
  solid::Box box = solid::bounding_box(layers[0].mesh);
  const solid::Box design = box;
  for (const Layer& layer : layers) {
    const solid::Box other = solid::bounding_box(layer.mesh);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], other.low[axis]);
      box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
  }
  Json packed_layers = Json::array();
  std::string scales;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    packed_layers.push_back(packed(layers[n], box));
    scales += scale(layers[n], n > 0);
  }
  const Vector3 size = design.high - design.low;
  const std::string mm =
      format_number(size[0], 3) + " x " + format_number(size[1], 3) + " x " + format_number(size[2], 3) + " mm";
  return plot::page_figure("Part and print",
                           "<div class=\"body\">" + choices(layers) +
                               "<canvas tabindex=\"0\" aria-label=\"three-dimensional view of the part\"></canvas>" +
                               scales + page_data(Json::array({box.low, box.high, packed_layers})) + "</div>",
                           "Drag to rotate, scroll to zoom; the rotation axis z points upwards. The design measures " +
                               mm + "; surfaces are computed on voxels of " +
                               format_number(by * target.grid().voxel_mm, 3) + " mm.");
}

}  // namespace vam::report_tool
