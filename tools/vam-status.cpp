// SPDX-License-Identifier: GPL-3.0-or-later
// vam-status: how far a print is, as a line or as a page.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <thread>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/printable.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "device/os/interrupt.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/flip_log.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "vam-status/light_view.hpp"
#include "vam-status/page.hpp"
#include "vam-status/progress.hpp"

namespace {

using namespace vam;

struct Options {
  std::string run;
  std::string sinogram;
  std::string page;
  bool watch = false;
  double period_s = 1;
  bool with_parent = false;
};

void declare(cli::App& app, Options& o) {
  app.positional("RUN", o.run, "Run folder of vam-print.");
  app.flag("--watch", o.watch, "Repeat until the print has ended, or vam-print was killed.");
  app.option("--interval", "S", o.period_s, {0.2, 3600}, "Time between two lines or updates of the page.");
  app.option("--page", "FILE", o.page, "Write a page that refreshes itself (HTML).").writes_as({".html"});
  app.option("--sinogram", "FILE", o.sinogram, "Sinogram of the print, for the images of projections and dose.")
      .default_is("RUN/sinogram.exr, a link that vam-print creates");
  app.flag("--die-with-parent", o.with_parent, "Exit when the parent process exits.");
  cli::add_threads(app);
}

// A print goes on without its images: a problem with them is reported once.
std::optional<status_tool::LightView> light_of(const Options& o, const status_tool::RunFolder& run) {
  const std::string file = o.sinogram.empty() ? run.file("sinogram.exr") : o.sinogram;
  try {
    if (!has_regular_file(file)) throw Error{Fault::no_input, file + ": cannot open: no such file"};
    (void)io::StackReader(file);  // before all of what may be another file is read for its hash
    io::require_sinogram_of(o.run, file);
    return status_tool::LightView(file, run.printer());
  } catch (const Error& error) {
    if (!o.sinogram.empty()) throw;
    warn(std::string(error.what()) + "; the page is written without projections and dose; give --sinogram FILE");
    return std::nullopt;
  }
}

void run(const Options& o) {
  if (o.with_parent) device::end_with_parent();
  status_tool::RunFolder run(o.run);
  const std::string name = std::filesystem::weakly_canonical(o.run).filename().string();
  run.read();  // what is wrong with its logs comes first
  const auto light = o.page.empty() ? std::nullopt : light_of(o, run);
  const bool in_place = o.watch && isatty(STDOUT_FILENO) == 1;
  for (bool more = true; more;) {
    run.read();
    more = o.watch && !run.progress().outcome && !run.progress().abandoned;
    if (!o.page.empty()) io::write_text(o.page, status_tool::page(name, run, light ? &*light : nullptr, o.period_s));
    if (o.page.empty() || o.watch) {
      std::string line = status_tool::status_line(run.progress(), run.printer().stage.speed_deg_s);
      if (const std::string said = status_tool::correction_text(run); !said.empty()) line += "  light " + briefly(said);
      std::cout << (in_place ? "\r\033[K" : "") << line << (in_place && more ? "" : "\n") << std::flush;
      if (!std::cout) throw Error{Fault::io, "stdout: cannot be written"};
    }
    if (more) std::this_thread::sleep_for(std::chrono::duration<double>(o.period_s));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::App app({"vam-status", "show the progress of a print", manual_page});
  declare(app, options);
  return app.run(argc, argv, [&] { run(options); });
}
