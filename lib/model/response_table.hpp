// SPDX-License-Identifier: GPL-3.0-or-later
// A measured projector response, as it comes out of a file.
#pragma once

#include <string>
#include <vector>

namespace vam::model {

/// Intensity of the light at each grey level sent, in any units: both are relative to their last entry, which is full
/// grey. Grey begins at 0 and rises from entry to entry.
struct ResponseTable {
  std::string source;  // file name, for messages
  std::vector<double> grey;
  std::vector<double> intensity;
};

}  // namespace vam::model
