// Slices of continuous stereolithography, one after the other in time: each is shown once, for the time in which the
// platform moves by a slice height.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "io/exr_stack.hpp"
#include "io/frame_sink.hpp"
#include "model/printer.hpp"
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
/// A folder of pictures; its values are grey.
[[nodiscard]] SliceStack slice_folder(const std::string& path);

struct SliceTiming {
  std::optional<double> fps;
  std::optional<double> speed_mm_h;
};
/// Slices per second: as given, or print speed / slice height, or by the times of the slices. Throws Fault::usage when
/// both are given, or the height is not known to a given speed; Fault::data when nothing is known, or the frames belong
/// to stage angles.
[[nodiscard]] double slices_per_s(const SliceStack& stack, const SliceTiming& timing);

/// The slices in the projector's picture, as fractions of full intensity.
[[nodiscard]] Frames frames_of(const SliceStack& stack, double fps, const model::Projector& projector,
                               double column_offset, double row_offset);

/// The facts of the frames that come of it.
[[nodiscard]] model::StackInfo facts_of(const SliceStack& stack, double fps, const model::Projector& projector);

}  // namespace vam::project
