// The light that vam-optimize works with, by the printer and the options.
#pragma once

#include <memory>
#include <span>

#include "light/operator.hpp"
#include "model/circle.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "tomo/radon.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Where the light comes from and what it goes through.
struct Scene {
  model::Grid grid;
  model::Printer printer;
  model::Circle circle;         // what it reaches
  tomo::ParallelGeometry turn;  // with --geometry parallel
};

[[nodiscard]] Scene make_scene(const model::Grid& grid, const model::Printer& printer, const Options& options);

/// Standard deviation in voxels of what beam and resin smear; 0 when it is to be left out.
[[nodiscard]] double blur_px(const Scene& scene, const Options& options);

/// Parallel light, or the projector's own rays; the resin's absorption is in it unless it is to be left out.
[[nodiscard]] std::unique_ptr<light::Operator> make_light(const Scene& scene, const Options& options);
/// The same around opaque inserts, a slab for every slab of the pass.
[[nodiscard]] std::unique_ptr<light::Operator> make_light(const Scene& scene, const Options& options,
                                                          std::span<const Slab> inserts);

}  // namespace vam::optimize_tool
