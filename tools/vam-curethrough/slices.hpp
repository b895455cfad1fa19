// SPDX-License-Identifier: GPL-3.0-or-later
// A stack of slices as intensities, whatever it is stored as; read from the first slice on, as often as needed.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "resin/response.hpp"

namespace vam::curethrough {

struct SliceSource {
  std::string name;
  int width = 0;
  int height = 0;
  int count = 0;
  std::map<std::string, std::string> facts;  // text attributes of an EXR stack
  std::vector<std::string> history;
  /// Slice n as fractions of the maximum intensity. n runs up from 0; asking for 0 again starts over.
  std::function<void(int n, Image& slice)> read;
};

/// Intensities, fractions of the maximum, to grey 0..1.
void to_grey(Image& slice, const resin::Response& response);

/// An EXR frame stack or a folder of numbered grey images; grey goes through the response. Not a pipe: slices are
/// read twice. Throws what io throws.
[[nodiscard]] SliceSource open_slices(const std::string& path, const resin::Response& response);

}  // namespace vam::curethrough
