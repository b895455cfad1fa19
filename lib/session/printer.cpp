// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/printer.hpp"

#include "io/settings/printer_file.hpp"
#include "io/settings/response_file.hpp"
#include "io/stream/stream.hpp"

namespace vam::session {

model::Printer load_printer(const cli::PrinterOptions& options) { return io::load_printer(options.file, options.sets); }

bool print_printer(const cli::PrinterOptions& options, const model::Printer& printer, const std::string& output) {
  if (options.print) io::write_text(output, io::printer_toml(printer));
  return options.print;
}

bool print_printer(const cli::PrinterOptions& options) {
  return options.print && print_printer(options, load_printer(options), "-");
}

resin::Response response_of(const model::Projector& projector) {
  if (projector.response.empty()) return resin::projector_response(projector);
  return resin::Response(io::read_response(projector.response, projector.bits));
}

}  // namespace vam::session
