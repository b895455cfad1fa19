#include "vam-optimize/light.hpp"

#include "optimize/attenuated_operator.hpp"
#include "optimize/parallel_operator.hpp"
#include "optimize/shadowed_operator.hpp"

namespace vam::optimize_tool {

namespace {

double mu_per_px(const Scene& scene, const Options& options) {
  return options.absorption == "none" ? 0 : scene.printer.resin.absorption_per_mm * scene.grid.voxel_mm;
}

double radius_px(const Scene& scene) { return model::resin_radius_mm(scene.printer.vial) / scene.grid.voxel_mm; }

}  // namespace

std::unique_ptr<optimize::Operator> make_light(const Scene& scene, const Options& options) {
  const double mu = mu_per_px(scene, options);
  if (mu == 0) return std::make_unique<optimize::ParallelOperator>(scene.turn);
  const auto correction = options.absorption == "disc" ? optimize::Correction::disc : optimize::Correction::exact;
  return std::make_unique<optimize::AttenuatedOperator>(scene.turn, mu, radius_px(scene), correction);
}

std::unique_ptr<optimize::Operator> make_light(const Scene& scene, const Options& options,
                                               std::span<const optimize::Slab> inserts) {
  return std::make_unique<optimize::ShadowedOperator>(scene.turn, mu_per_px(scene, options), radius_px(scene), inserts);
}

}  // namespace vam::optimize_tool
