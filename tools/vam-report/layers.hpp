// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that can be turned, one of which is seen at a time.
#pragma once

#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "model/mesh.hpp"

namespace vam::report_tool {

inline constexpr std::size_t most_vertices = 65'536;  // of a view, as corners are of 16 bits

struct Layer {
  std::string name;
  model::TriangleSoup mesh;
  std::vector<double> values;  // one a vertex; none: `colours`, or grey
  double limit = 1;            // of the colours, on either side of 0
  std::string unit;
  std::string meaning;
  std::vector<Rgb> colours = {};
  model::TriangleSoup beside = {};  // a body that is seen with it, in green
};

/// HTML: a view of the layers with their scales; a choice where there are more than one, told from others by `group`.
[[nodiscard]] std::string layers_view(const std::vector<Layer>& layers, const std::string& group);

}  // namespace vam::report_tool
