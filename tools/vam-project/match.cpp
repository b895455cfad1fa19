// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/match.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_match.hpp"
#include "io/stream/stream.hpp"
#include "model/light_width.hpp"

namespace vam::project {

std::vector<std::string> require_printer(const Options& options, const model::StackInfo& info,
                                         const model::Printer& printer) {
  if (info.kind != model::Kind::sinogram || info.space != model::Space::projector) return {};
  const model::Projector& projector = printer.projector;
  if (!projector.shows_axis()) {
    throw Error{Fault::data, "projector.axis_column: " + format_number(projector.axis_column) +
                                 " is not in the image of " + std::to_string(projector.columns) +
                                 " columns; set it (vam-calibrate edges)"};
  }
  const std::string name = io::input_name(options.input);
  const auto computed_for = info.extra.find("vam:printer");
  if (computed_for == info.extra.end()) {
    if (!options.accept_printer) {
      warn(name + ": the attribute vam:printer is missing; whether it was computed for this printer cannot be checked");
    }
    return {};
  }
  auto differences =
      io::differences(io::parse_settings(computed_for->second, name + ": vam:printer"), printer, io::Matter::light);
  if (differences.empty()) return {};
  const std::string what = name + ": computed for another printer: " + join(differences, "; ");
  if (!options.accept_printer) {
    throw Error{Fault::data, what + "; compute it for this printer, or give --accept-printer"};
  }
  warn(what + "; accepted");
  return differences;
}

void tell_width(const std::string& input, const model::StackInfo& info, double frame_deg) {
  constexpr double alike = 0.1;  // of the wider one
  const auto stated = info.extra.find("vam:printer");
  if (stated == info.extra.end() || info.space != model::Space::projector) return;
  const double step_deg = std::abs(info.angle_step_deg);
  const double judged = model::light_width(io::parse_settings(stated->second, "vam:printer"), step_deg).hold_deg;
  const double shown = model::interpolated_hold_deg(frame_deg, step_deg);
  if (std::abs(shown - judged) <= alike * std::max(shown, judged)) return;
  note("vam-project: shows each frame of " + io::input_name(input) + " over " + format_number(shown, 3) +
       " deg of the stage, which was judged with " + format_number(judged, 3) + " deg; stage.motion=" +
       (std::abs(frame_deg / step_deg - 1) < 1e-6 ? "held" : "interpolated") + " judges by what is shown");
}

void require_whole(const std::string& input, const model::StackInfo& info) {
  if (info.piece.whole()) return;
  throw Error{Fault::data, io::input_name(input) + ": holds " + std::to_string(info.count) + " of " +
                               std::to_string(info.piece.of) + " slices (vam:piece " + model::piece_text(info.piece) +
                               "); join the pieces by vam-convert join"};
}

}  // namespace vam::project
