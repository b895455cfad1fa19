// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/common.hpp"

#include "base/compute/parallel.hpp"

namespace vam::cli {

App& add_output(App& app, std::string& output) {
  return app.option("-o,--output", "FILE", output, "Output file; - is standard output.").not_in_job().writes();
}

App& add_printer(App& app, PrinterOptions& options) {
  app.group("Printer");
  app.option(printer_flag, "FILE", options.file,
             "Printer settings (TOML); or names of vam-plan --printers, e.g. opencal,vial-16,dudma: a printer, a vial, "
             "a resin.");
  app.default_is(
      "$VAM_PRINTER, else ./printer.toml, else the built-in printer (1024 x 768 pixels of 0.065 mm, throw ratio 1.8, "
      "vial of 25.4 mm, index 1.53)");
  app.brief("Printer settings, or names of vam-plan --printers. Default: $VAM_PRINTER or printer.toml.").not_in_job();
  app.option("--set", "KEY=VALUE", options.sets, "Override one setting, e.g. vial.radius_mm=10.").not_in_job();
  app.brief("Override one setting, e.g. vial.radius_mm=10.");
  app.flag("--print-printer", options.print, "Print the settings in force as commented TOML and exit.").not_in_job();
  return app.group(App::plain_heading);
}

std::string printer_words(const PrinterOptions& options) {
  std::string words = options.file.empty() ? "" : std::string(" ") + printer_flag + " " + quoted(options.file);
  for (const std::string& setting : options.sets) words += " --set " + quoted(setting);
  return words;
}

App& add_report(App& app, std::string& report) {
  return app.option("--report", "FILE", report, "Write a report in JSON; units are part of the key names.")
      .not_in_job()
      .writes();
}

App& add_threads(App& app) {
  return app
      .option(
          "--threads", "N", Range{0, 1024}, [](int count) { set_threads(count); },
          "Number of threads; 0 is one per core. The result does not depend on it.", "0")
      .not_in_job();
}

App& add_stack_output(App& app, bool& half, std::string& compression) {
  app.flag("--half", half, "Store 16-bit floats.").not_in_job();
  return app
      .choice("--compression", compression, {"none", "rle", "zip", "zips", "piz", "pxr24"},
              "Compression of a stack written to a file; a pipe is never compressed.")
      .not_in_job();
}

}  // namespace vam::cli
