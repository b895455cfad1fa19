// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/inputs.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "grey_target.hpp"
#include "io/vdb/gate.hpp"
#include "own_grid.hpp"

namespace vam::optimize_tool {

namespace {

io::SparseVolume read_dose(const std::string& path) {
  io::SparseVolume dose = tool::read_own(path, "dose");
  if (dose.units == "mJ/cm3") return dose;
  throw Error{Fault::data, path + ": the dose is in units of " + excerpt(dose.units) +
                               ", not mJ/cm3; set resin.critical_dose_mj_cm3 and resin.absorption_per_mm in "
                               "vam-dose"};
}

}  // namespace

Inputs read(const Options& options) {
  Inputs in;
  std::vector<io::SparseVolume> all = io::read_volumes(options.input);
  io::require_usable(options.input, all, options.demands.grey ? io::TargetKind::grey : io::TargetKind::coverage);
  for (io::SparseVolume& volume : all) {
    if (volume.name() == "target")
      in.target.push_back(std::move(volume));
    else if (volume.name() == "insert")
      in.insert.push_back(std::move(volume));
    else if (volume.name() == "weight" && options.weights.empty())
      in.weight.push_back(std::move(volume));
    else if (volume.name() == "tolerance" && options.band_volume.empty())
      in.tolerance.push_back(std::move(volume));
  }
  if (in.target.empty()) throw Error{Fault::data, options.input + ": has no grid 'target'; vam-slice writes one"};
  if (options.demands.grey && in.target.front().units != "relative") {
    throw Error{Fault::data, options.input + ": is in " + in.target.front().units +
                                 ", but projections have relative doses; divide it by the dose that is to be 1"};
  }
  if (!options.demands.grey) tool::warn_of_grey(in.target.front(), options.input);
  if (!options.weights.empty()) in.weight.push_back(tool::read_own(options.weights, "weight"));
  if (!options.band_volume.empty()) in.tolerance.push_back(tool::read_own(options.band_volume, "tolerance"));
  for (const std::string& path : options.delivered) in.delivered.push_back(read_dose(path));
  if (!in.insert.empty())
    in.insert.front().extend_to(in.grid(), options.input);  // other programs leave the void around it out
  for (const auto& [volumes, file] :
       {std::pair{&in.weight, &options.weights}, std::pair{&in.tolerance, &options.band_volume}}) {
    if (volumes->empty() || volumes->front().grid() == in.grid()) continue;
    throw tool::differs_from_target(volumes->front(), file->empty() ? options.input : *file);
  }
  return in;
}

Initial::Initial(const std::string& path, const model::StackInfo& want) : path_(path), reader_(path) {
  const auto& is = reader_.info();
  io::require(path, is, model::Kind::sinogram, want.space);
  if (is.width == want.width && is.height == want.height && is.count == want.count) return;
  const auto size = [](const model::StackInfo& s) {
    return std::to_string(s.width) + " columns x " + std::to_string(s.height) + " angles x " + std::to_string(s.count) +
           " slices";
  };
  throw Error{Fault::data, path + ": " + size(is) + ", but the target needs " + size(want) +
                               "; use the same target, --angles and --detector-bins"};
}

Image Initial::operator()(int k) {
  constexpr int kept = 64;
  model::ImageInfo about;
  for (; next_ <= k; ++next_) {
    Image image;
    if (!reader_.next(image, about)) throw Error{Fault::data, path_ + ": ends at slice " + std::to_string(next_)};
    recent_.emplace(next_, std::move(image));
    recent_.erase(next_ - kept);
  }
  return recent_.at(k);
}

}  // namespace vam::optimize_tool
