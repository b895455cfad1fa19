// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/text/base64.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "plot/canvas.hpp"
#include "plot/colour_map.hpp"
#include "plot/page.hpp"
#include "plot/render.hpp"
#include "solid/mesh/geometry.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

template <class Number>
std::string encoded(const std::vector<Number>& numbers) {
  std::string raw(numbers.size() * sizeof(Number), '\0');
  std::memcpy(raw.data(), numbers.data(), raw.size());
  return base64(raw);
}

Rgb colour_of(const Layer& layer, std::size_t vertex) {
  if (!layer.colours.empty()) return layer.colours[vertex];
  if (layer.values.empty()) return plot::paint::light_grey;
  return plot::colour(plot::ColourMap::diverging, 0.5 + 0.5 * layer.values[vertex] / layer.limit);
}

/// What WebGL takes of bodies in one box, of at most `most_vertices`.
class Packing {
 public:
  explicit Packing(const solid::Bounds& box) : box_(box) {}
  /// colour(vertex)
  template <class Colour>
  void add(const model::TriangleSoup& mesh, const Colour& colour) {
    const std::size_t first = positions_.size() / 3;
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = (mesh.points[n][axis] - box_.low[axis]) / (box_.high[axis] - box_.low[axis]);
        positions_.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(place, 0.0, 1.0))));
      }
      const Rgb paint = colour(n);
      colours_.insert(colours_.end(), paint.begin(), paint.end());
    }
    for (const auto& triangle : mesh.triangles) {
      for (const auto corner : triangle) corners_.push_back(static_cast<std::uint16_t>(first + corner));
    }
  }
  [[nodiscard]] Json packed() const { return Json::array({encoded(positions_), encoded(colours_), encoded(corners_)}); }

 private:
  solid::Bounds box_;
  std::vector<std::uint16_t> positions_;
  std::vector<std::uint8_t> colours_;
  std::vector<std::uint16_t> corners_;
};

Json packed(const Layer& layer, const solid::Bounds& box) {
  Packing packing(box);
  packing.add(layer.mesh, [&](std::size_t vertex) { return colour_of(layer, vertex); });
  packing.add(layer.beside, [](std::size_t) { return plot::paint::green; });
  return packing.packed();
}

std::string scale(const Layer& layer, bool hidden) {
  if (layer.meaning.empty()) return "<div class=\"scale\"" + std::string(hidden ? " hidden" : "") + "></div>";
  const std::string limit = format_number(layer.limit, 2) + " " + layer.unit;
  return "<div class=\"scale\"" + std::string(hidden ? " hidden" : "") + "><span>-" + limit +
         "</span><i style=\"background:" + plot::page_gradient(plot::ColourMap::diverging, 4) + "\"></i><span>+" +
         limit + "</span><span>" + page_text(layer.meaning) + "</span></div>";
}

std::string choices(const std::vector<Layer>& layers, const std::string& group) {
  if (layers.size() < 2) return "";
  std::string made = "<div class=\"control\">";
  for (std::size_t n = 0; n < layers.size(); ++n) {
    made += "<label><input type=\"radio\" name=\"" + group + "\"" + std::string(n == 0 ? " checked" : "") + ">" +
            page_text(layers[n].name) + "</label>";
  }
  return made + "</div>";
}

solid::Bounds box_of(const std::vector<Layer>& layers) {
  solid::Bounds box = solid::bounding_box(layers[0].mesh);
  for (const Layer& layer : layers) {
    box.join(solid::bounding_box(layer.mesh));
    if (!layer.beside.points.empty()) box.join(solid::bounding_box(layer.beside));
  }
  return box;
}

/// For where nothing can be turned.
std::string drawn(const Layer& layer, const solid::Bounds& box) {
  plot::Body body{layer.mesh, {}};
  for (std::size_t n = 0; n < layer.mesh.points.size(); ++n) body.colours.push_back(colour_of(layer, n));
  const plot::Body beside{layer.beside, std::vector<Rgb>(layer.beside.points.size(), plot::paint::green)};
  const Vector3 centre = 0.5 * (box.low + box.high);
  constexpr int pixels = 480;
  const std::vector<const plot::Body*> bodies{&body, &beside};
  return "<template>" +
         plot::page_image(plot::render(bodies, centre, plot::side_mm(bodies, centre, {}), {}, pixels), layer.name) +
         "</template>";
}

}  // namespace

std::string layers_view(const std::vector<Layer>& layers, const std::string& group) {
  const solid::Bounds box = box_of(layers);
  Json packed_layers = Json::array();
  std::string scales;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    packed_layers.push_back(packed(layers[n], box));
    scales += scale(layers[n], n > 0);
  }
  return "<div class=\"body\">" + choices(layers, group) +
         "<canvas tabindex=\"0\" aria-label=\"three-dimensional view of the part\"></canvas>" + scales +
         drawn(layers.back(), box) + page_data(Json::array({box.low, box.high, packed_layers})) + "</div>";
}

}  // namespace vam::report_tool
