// SPDX-License-Identifier: GPL-3.0-or-later
// Slices of continuous stereolithography, one after the other in time: each is shown once, for the time in which the
// platform moves by a slice height.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "cli/app.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "vam-project/options.hpp"
#include "vam-project/show.hpp"

namespace vam::project {

/// What vam-curethrough correct has written.
struct SliceStack {
  std::string name;
  model::StackInfo info;
  std::vector<model::ImageInfo> about;  // times, where they are known
  std::function<bool(Image&)> next;     // in printing order
};
[[nodiscard]] SliceStack slices_of(const std::string& path, io::StackReader& reader);
/// A folder of images; its values are grey.
[[nodiscard]] SliceStack slice_folder(const std::string& path);

/// Whether slices are a folder of images, not a stack.
[[nodiscard]] bool is_folder(const std::string& path);

/// The slices in the projector's image, as fractions of full intensity, one after the other: they know no stage.
/// Slices per second are as the options say, or print speed / slice height, or by the times of the slices. Throws
/// Fault::usage for options of the stage, when both fps and speed are given, or the height is not known to a given
/// speed; Fault::data when nothing is known, or the frames belong to stage angles.
[[nodiscard]] Frames slices_in_time(const cli::App& app, const Options& options, const model::Printer& printer,
                                    const SliceStack& slices);

/// For --report.
[[nodiscard]] Json slice_figures(const Frames& frames, const Options& options, const model::Projector& projector,
                                 const resin::LightTally& tally);

/// The facts of the frames that come of it.
[[nodiscard]] model::StackInfo facts_of(const SliceStack& stack, double fps, const model::Projector& projector);

}  // namespace vam::project
