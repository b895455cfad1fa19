// SPDX-License-Identifier: GPL-3.0-or-later
// The conventions of other programs, a row each, as their sources have them [formats: Conventions of other programs].
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "base/text/text.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

namespace {

// Dr.TVAM: motion.py, CircularMotion.eval; integrators/common.py, sample_rays; Mitsuba's orthographic_projection, whose
// columns run to the left of an emitter that looks at the axis; utils.py, discretize.
// VAMToolbox: Projector3DParallel.py, backward (t = column cos - row sin, from N // 2), with the array of voxelize.py,
// OpenGLSlicer.slice (rows are y, from the lowest), or voxelizeTarget (rows are x); Projector3DParallelAstra and
// Projector3DParallelCUDAAstra by ASTRA's genPar3DProjections: the latter exchanges the axes of the array
// (t = row cos + column sin), both are centred; imagesequence.py, ImageSeq: the lowest slice is the top row.
// OpenCAL plays VAMToolbox's videos; menus.py, _parse_rpm.
// SwissVAMyKnife.jl: utils.jl, save_patterns; RadonKA.jl, next_ray_on_circle and _radon (N / 2 + 1 of 1 to N).
constexpr Convention conventions[] = {
    // program, volumes, projections, frames, zero, sense, axis of volumes and of columns on N / 2, speed in the name
    {"none", "zyx", "zax", "normal", 0, 1, false, false, false},
    {"drtvam", "zyx", "a-zx", "normal", 90, 1, false, false, false},
    {"vamtoolbox", "yxz", "xaz", "flip-rows", 0, -1, true, true, false},
    {"vamtoolbox-astra", "yxz", "xaz", "flip-rows", 0, -1, false, false, false},
    {"vamtoolbox-cuda", "yxz", "xaz", "flip-rows", 90, -1, false, false, false},
    {"vamtoolbox-stl", "xyz", "xaz", "flip-rows", 90, 1, true, true, false},
    {"vamtoolbox-stl-astra", "xyz", "xaz", "flip-rows", 90, 1, false, false, false},
    {"vamtoolbox-stl-cuda", "xyz", "xaz", "flip-rows", 0, 1, false, false, false},
    {"opencal", "xyz", "xaz", "flip-rows", 0, 1, false, false, true},
    {"swissvamyknife", "zyx", "zax", "rotate-90", 90, 1, true, false, false},
};

}  // namespace

std::vector<std::string> programs() {
  std::vector<std::string> names;
  for (const Convention& row : conventions) names.emplace_back(row.program);
  return names;
}

const Convention& convention_of(const std::string& program) {
  return *std::ranges::find(conventions, program, &Convention::program);
}

double axis_of(int count, bool at_half) { return at_half ? count / 2 : 0.5 * (count - 1); }

std::optional<double> named_speed_deg_s(const std::string& path) {
  std::string name = std::filesystem::path(path).filename();
  std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  const std::size_t end = name.rfind("rpm"), begin = name.rfind('_', end);
  if (end == std::string::npos || begin == std::string::npos) return std::nullopt;
  const auto rpm = parse_number(name.substr(begin + 1, end - begin - 1));
  if (!rpm || !(*rpm > 0)) return std::nullopt;
  return 6 * *rpm;
}

}  // namespace vam::convert_tool
