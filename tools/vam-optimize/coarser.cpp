// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/coarser.hpp"

#include <vector>

#include "io/vdb/coarser.hpp"

namespace vam::optimize_tool {

Inputs coarser(const Inputs& in) {
  Inputs coarse;
  const auto add = [](const std::vector<io::SparseVolume>& from, std::vector<io::SparseVolume>& to) {
    for (const io::SparseVolume& volume : from) to.push_back(io::coarser(volume));
  };
  add(in.target, coarse.target);
  add(in.insert, coarse.insert);
  add(in.weight, coarse.weight);
  add(in.tolerance, coarse.tolerance);
  return coarse;
}

Options coarser(const Options& options) {
  Options coarse = options;
  coarse.angles = (options.angles + 1) / 2;
  if (options.bins) coarse.bins = (*options.bins + 1) / 2;
  coarse.trace.clear();
  coarse.certify.clear();
  return coarse;
}

}  // namespace vam::optimize_tool
