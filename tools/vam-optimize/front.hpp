// SPDX-License-Identifier: GPL-3.0-or-later
// --tradeoff: duration against window, as a table or as an image.
#pragma once

#include <string>
#include <vector>

#include "model/printer.hpp"
#include "optimize/run/volume.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Frames in the grey levels of --bits or of the projector, the brightest pixel at full grey unless optimize.full_scale
/// says otherwise. Throws Error when the response cannot be read.
[[nodiscard]] optimize::Show make_show(const model::Printer& printer, const Options& options);

/// A name that ends in .png: latitude and IoU of the limits against the duration, or against mean / peak intensity
/// unless the resin is known. Else a table, the columns
/// max_intensity,duration_s,turns,latitude,pw,ver,iou,peak_intensity,efficiency,latitude_tolerances, a line for each
/// limit; duration_s and turns are empty unless the resin is known, latitude_tolerances is without --robust. Throws as
/// io::write_text does.
void write_front(const std::string& path, const std::vector<optimize::FrontPoint>& front, const model::Printer& printer,
                 const model::StackInfo& info, const Options& options);

}  // namespace vam::optimize_tool
