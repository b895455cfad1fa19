// SPDX-License-Identifier: GPL-3.0-or-later
// vam-project: projector frames from sinograms, for files or a screen; one frame per time step of the turning stage.
#include <optional>

#include "base/index.hpp"
#include "device/os/interrupt.hpp"
#include "io/exr/stack.hpp"
#include "io/image/frame_sink.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/log_lines.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "resin/absolute_dose.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "vam-project/files.hpp"
#include "vam-project/match.hpp"
#include "vam-project/options.hpp"
#include "vam-project/patterns.hpp"
#include "vam-project/plan.hpp"
#include "vam-project/print.hpp"
#include "vam-project/slices.hpp"
#include "vam-project/turn.hpp"

namespace {

using namespace vam;
using project::Options;

void freeze(const Options& options, model::Printer printer, io::StackReader& reader) {
  project::require_whole(options.input, reader.info());
  require_printer(options, reader.info(), printer);
  if (reader.info().kind == model::Kind::sinogram) {
    const std::string name = io::input_name(options.input);
    const session::GivenExposure given{.sets = options.printer.sets};
    session::Exposure shown = session::exposure_of(name, reader.info(), printer, 0, given);
    if (!shown.share && resin::dose_per_radian_mj_cm3(printer)) {
      const double peak = read_light(options, reader, printer.projector).peak;
      shown = session::exposure_of(name, reader.info(), printer, peak, given);
    }
    session::warn_of_turns(shown, name);
    if (shown.share) printer.stage.turns = ceil_int(shown.turns);
  }
  io::write_text(options.freeze, io::printer_toml(io::frozen(printer)));
}

/// Whether the input is a stack: neither a test pattern nor a folder of images, nor without need on a pipe.
bool takes_stack(const cli::App& app, const Options& options) {
  const bool folder = project::is_folder(options.input);
  if (folder && options.only_plan) app.require_for("slices", options.input);
  const bool needless = options.printer.print && options.input == "-";
  return options.pattern.plan.name.empty() && !needless && (!folder || !options.freeze.empty());
}

void run(const cli::App& app, Options& options) {
  const bool live = options.freeze.empty() && !options.printer.print && project::is_live(app, options.output);
  std::optional<io::StackReader> stack;
  if (takes_stack(app, options)) stack.emplace(options.input);
  const bool turns = stack && stack->info().kind == model::Kind::sinogram;
  const model::Printer printer = settle(options, turns ? stack->info().extra : model::Metadata{});
  if (session::print_printer(options.printer, printer, options.output)) return;
  if (!options.freeze.empty()) return freeze(options, printer, *stack);
  if (!options.pattern.plan.name.empty()) {
    if (options.only_plan) return project::print_devices(options, printer);
    return show_pattern(app, options, printer.projector);
  }
  if (options.only_plan) return print_plan(app, options, printer, *stack);
  if (live) return device::interruptible([&] { print_live(app, options, printer, stack ? &*stack : nullptr); });
  if (turns) return write_turns(app, options, printer, *stack);
  write_slices(app, options, printer,
               stack ? project::slices_of(options.input, *stack) : project::slice_folder(options.input));
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(
      {"vam-project", "convert sinograms into projector frames and show them", manual_page, cli::device_statuses});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
