// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/shown_pass.hpp"

#include <memory>
#include <utility>

#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

PassSetup set_up(const VolumeTask& task, const light::Operator& light, const SliceReader& reader, const Pass& pass,
                 const std::function<int(int job)>& slice) {
  PassInput input = read_pass(pass, slice, reader, light.object(), task.circle, task.demands,
                              light.couples_slices() || task.blur_px > 0);
  std::unique_ptr<light::Operator> around;
  std::vector<std::int64_t> dark;
  if (!input.inserts.empty()) {
    exclude(input.problem, input.inserts);
    around = task.around(input.inserts);
    dark = exclude_dark(input.problem, *around);
  }
  return {std::move(input.problem), std::move(input.inserts), std::move(dark),
          PassLight(light, std::move(around), task.blur_px, pass.slices())};
}

std::vector<Slab> dose_of(const Pass& pass, const PassLight& light, const std::function<Image(int job)>& image) {
  const std::vector<Slab> sinograms = collapse_images(pass, image, light.sharp());
  std::vector<Slab> dose = slabs(sinograms.size(), light.sharp().object().width, light.sharp().object().height);
  light.blurred().adjoint(sinograms, dose);
  return dose;
}

ShownPass shown_pass(const VolumeTask& task, const light::Operator& light, const SliceReader& reader, const Pass& pass,
                     const std::function<int(int job)>& slice, const std::function<Image(int job)>& image) {
  PassSetup setup = set_up(task, light, reader, pass, slice);
  std::vector<Slab> dose = dose_of(pass, setup.light, image);
  add_delivered(setup.problem, dose);
  return {std::move(setup.problem), std::move(dose)};
}

}  // namespace vam::optimize
