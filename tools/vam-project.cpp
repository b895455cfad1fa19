// SPDX-License-Identifier: GPL-3.0-or-later
// vam-project: projector frames from sinograms, for files or a screen; one frame per time step of the turning stage.
#include "device/os/interrupt.hpp"
#include "io/exr/stack.hpp"
#include "io/image/frame_sink.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "session/printer.hpp"
#include "vam-project/files.hpp"
#include "vam-project/match.hpp"
#include "vam-project/options.hpp"
#include "vam-project/patterns.hpp"
#include "vam-project/plan.hpp"
#include "vam-project/print.hpp"
#include "vam-project/slices.hpp"

namespace {

using namespace vam;
using project::Options;

void freeze(const Options& options, const model::Printer& printer) {
  const io::StackReader reader(options.input);
  project::require_whole(options.input, reader.info());
  require_printer(options, reader.info(), printer);
  project::write_frozen(options.freeze, printer);
}

void run(const cli::App& app, Options& options) {
  const model::Printer printer = settle(options);
  if (session::print_printer(options.printer, printer, options.output)) return;
  if (!options.freeze.empty()) return freeze(options, printer);
  const bool live = project::is_live(app, options.output);
  if (!options.pattern.plan.name.empty()) {
    if (options.only_plan) return project::print_devices(options, printer);
    return show_pattern(app, options, printer.projector);
  }
  if (options.only_plan) return print_plan(app, options, printer);
  if (live) return device::interruptible([&] { print_live(app, options, printer); });
  if (project::is_folder(options.input)) {
    return write_slices(app, options, printer, project::slice_folder(options.input));
  }
  io::StackReader reader(options.input);
  if (reader.info().kind == model::Kind::frames) {
    return write_slices(app, options, printer, project::slices_of(options.input, reader));
  }
  write_turns(app, options, printer, reader);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(
      {"vam-project", "convert sinograms into projector frames and show them", manual_page, cli::device_statuses});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
