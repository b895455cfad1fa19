// --tradeoff: the table of duration against window.
#pragma once

#include <string>

#include "model/printer.hpp"
#include "optimize/run/volume.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Frames in the grey levels of --bits or of the projector, the brightest pixel at full grey unless --full-scale says
/// otherwise. Throws Error when the response cannot be read.
[[nodiscard]] optimize::Show make_show(const model::Printer& printer, const Options& options);

/// The columns max_intensity,duration_s,turns,pw,ver,iou,peak, a line for each limit; duration_s and turns are empty
/// unless the resin is known.
[[nodiscard]] std::string front_csv(const std::vector<optimize::FrontPoint>& front, const model::Printer& printer,
                                    const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
