// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/inputs.hpp"

#include "base/error.hpp"
#include "session/grey_target.hpp"
#include "session/volumes.hpp"

namespace vam::optimize_tool {

Inputs read(const Options& options) {
  const bool grey = options.demands.grey;
  std::vector<io::SparseVolume> grids =
      session::read_grids(options.input, grey ? io::TargetKind::grey : io::TargetKind::coverage);
  Inputs in;
  in.target.push_back(
      session::taken(grids, session::require_grid(grids, "target", options.input, "vam-slice writes one")));
  if (grey && in.target.front().units != "relative") {
    throw Error{Fault::data, options.input + ": is in " + in.target.front().units +
                                 ", but projections have relative doses; divide it by the dose that is to be 1"};
  }
  if (!grey) session::warn_of_grey(in.target.front(), options.input);
  if (io::SparseVolume* insert = session::find_grid(grids, "insert")) {
    insert->extend_to(in.grid(), options.input);  // other programs leave the void around it out
    in.insert.push_back(session::taken(grids, *insert));
  }
  const auto take = [&](const char* name, const std::string& own, std::vector<io::SparseVolume>& to) {
    if (!own.empty()) to.push_back(session::read_grid(own, name));
    io::SparseVolume* grid = own.empty() ? session::find_grid(grids, name) : &to.back();
    if (grid == nullptr) return;
    if (grid->grid() != in.grid()) throw session::differs_from_target(*grid, own.empty() ? options.input : own);
    if (own.empty()) to.push_back(session::taken(grids, *grid));
  };
  take("weight", options.weights, in.weight);
  take("tolerance", options.band_volume, in.tolerance);
  for (const std::string& path : options.delivered) in.delivered.push_back(session::read_dose(path));
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
