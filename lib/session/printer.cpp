// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/printer.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/printer_path.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/printer_match.hpp"
#include "io/stream/stream.hpp"

namespace vam::session {

model::Printer load_printer(const cli::PrinterOptions& options) { return io::load_printer(options.file, options.sets); }

model::Printer printer_of(const cli::PrinterOptions& options, const model::Metadata& facts, const std::string& name,
                          Role role) {
  const auto stated = facts.find("vam:printer");
  const std::string file = printer_path(options.file);
  if (stated == facts.end() || (role == Role::instrument && !file.empty())) return load_printer(options);
  auto own = io::parse_settings(stated->second, name + ": vam:printer", options.sets);
  if (const auto named = io::parse_printer("", "--set", options.sets).calibration; !named.folder.empty()) {
    auto calibrated = io::parse_settings(stated->second, name + ": vam:printer");
    io::apply_records(calibrated, named, utc_seconds());
    own = io::parse_settings(io::printer_settings(calibrated), name + ": vam:printer", options.sets);
  }
  const model::Printer other = load_printer(options);
  if (role == Role::instrument) {  // no device moves or shines because of a file of projections
    own.stage.device = other.stage.device;
    own.projector.relay = other.projector.relay;
    own.projector.max_led_current_percent = other.projector.max_led_current_percent;
    own.projector.latency_ms = other.projector.latency_ms;
    own.camera = other.camera;
    own.calibration = other.calibration;
  }
  if (file.empty()) return own;
  const std::vector<std::string> differences = io::differences(own, other, io::Matter::any);
  const bool given = !options.file.empty();
  if (!differences.empty()) {
    warn(name + ": made for another printer than " + file + ": " + join(differences, "; ") +
         (given ? "; the one given counts" : "; its own counts; --printer " + file + " judges by that"));
  }
  return given ? other : own;
}

bool print_printer(const cli::PrinterOptions& options, const model::Printer& printer, const std::string& output) {
  if (options.print)
    io::write_text(output, io::preset_settings(printer_path(options.file)).comment + io::printer_toml(printer));
  return options.print;
}

bool print_printer(const cli::PrinterOptions& options, const std::string& output) {
  return options.print && print_printer(options, load_printer(options), output);
}

void require_settings(const cli::App& app, const model::Printer& printer) {
  app.require_settings([&](const std::string& setting) { return io::has_setting(printer, setting); });
}

resin::Response response_of(const model::Projector& projector) {
  if (projector.response.empty()) return resin::projector_response(projector);
  return resin::Response(io::read_response(projector.response, projector.bits));
}

Image flat_of(const model::Projector& projector) {
  if (projector.flat.empty()) return {};
  Image flat = io::read_field(projector.flat);
  const auto refuse = [&](const std::string& why) {
    throw Error{Fault::data, "projector.flat: " + projector.flat + " " + why + "; run vam-calibrate uniformity"};
  };
  if (flat.width != projector.columns || flat.height != projector.rows) {
    refuse("has " + size_text(flat.width, flat.height) + " pixels, the projector " +
           size_text(projector.columns, projector.rows));
  }
  const auto [least, most] = std::minmax_element(flat.values.begin(), flat.values.end());
  const float unit = *least;
  if (!(unit > 0 && unit >= 0.2F * *most)) {
    refuse("has pixels from " + format_number(unit, 3) + " to " + format_number(*most, 3) +
           ", and the darkest needs a fifth of the brightest");
  }
  for (float& value : flat.values) value /= unit;
  return flat;
}

}  // namespace vam::session
