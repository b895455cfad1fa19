// What a plan says.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "optimize/run/preview.hpp"
#include "score/exposure_plan.hpp"
#include "vam-plan/options.hpp"

namespace vam::plan_tool {

inline constexpr int coarseness = 4;  // pixels per voxel of the estimate
inline constexpr int angles = 90;
inline constexpr int iterations = 12;

/// Whether the part fits, and at which scale.
struct Fit {
  std::array<double, 3> size_mm{};
  double writable_radius_mm = 0;
  double writable_height_mm = 0;
  double factor = 1;  // largest scale that fits, relative to that of the options
  [[nodiscard]] bool fits() const { return factor >= 1; }
};

struct Plan {
  std::string subject;
  Fit now;
  std::optional<Fit> bath;  // with a bath of the resin's index; none: it has one
  double given_scale = 1;   // by the options
  double scale = 1;         // of what follows, of the file's coordinates
  model::Grid grid;         // at the printer's pixels
  std::optional<double> wall_voxels;
  std::optional<optimize::Preview> preview;
  std::optional<score::ExposurePlan> exposure;  // none: the resin is not known
};

/// Throws Error: no_input, data.
[[nodiscard]] Plan plan(const Options& options, const model::Printer& printer);

[[nodiscard]] std::string table(const Plan& plan);
[[nodiscard]] Json report(const Plan& plan);

}  // namespace vam::plan_tool
