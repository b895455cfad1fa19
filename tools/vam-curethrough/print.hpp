// SPDX-License-Identifier: GPL-3.0-or-later
// What the subcommands share: the options of a print.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "resin/curethrough/column_dose.hpp"
#include "resin/response.hpp"

namespace vam::curethrough {

struct PrintOptions {
  double speed_mm_h = resin::Process{}.speed_mm_h;
  std::optional<double> absorbance_height_um;
  std::optional<double> full_cure_dose_mj_cm3;
  std::string exposure = "continuous";
  cli::PrinterOptions printer;
};
/// Speed and resin are not for these kinds of output.
void add_print(cli::App& app, PrintOptions& options, const std::vector<std::string>& not_for = {});

/// The printer file with the options on top. An option wins over the file, the file over resin::Process's defaults.
struct PrintSettings {
  model::Printer printer;
  resin::Process process;
  resin::CureLimits limits;
  resin::Response response;
};
[[nodiscard]] PrintSettings resolve(const PrintOptions& options, double slice_um);
[[nodiscard]] resin::ExposureMode exposure_of(const PrintOptions& options);

[[nodiscard]] Json to_json(const resin::Process& process);
/// What later tools need to show the slices in time, as text attributes.
[[nodiscard]] std::map<std::string, std::string> attributes(const resin::Process& process);
[[nodiscard]] double frames_per_s(const resin::Process& process);

}  // namespace vam::curethrough
