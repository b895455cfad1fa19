// SPDX-License-Identifier: GPL-3.0-or-later
// vam-project: projector frames from sinograms, for files or a screen; one frame per time step of the turning stage.
#include <filesystem>

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

void freeze(const Options& options, model::Printer printer) {
  io::StackReader reader(options.input);
  project::require_whole(options.input, reader.info());
  require_printer(options, reader.info(), printer);
  if (reader.info().kind == model::Kind::sinogram) {
    session::Exposure shown = session::exposure_of(options.input, reader.info(), printer, 0);
    if (!shown.planned && resin::dose_per_radian_mj_cm3(printer)) {
      const double peak = read_light(options, reader, printer.projector).peak;
      shown = session::exposure_of(options.input, reader.info(), printer, peak);
    }
    if (shown.planned) printer.stage.turns = ceil_int(shown.turns);
  }
  io::write_text(options.freeze, io::printer_toml(io::frozen(printer)));
}

/// Of a projector's sinogram, where it can be read twice.
model::Metadata facts_of(const Options& options) {
  if (!options.pattern.plan.name.empty() || !std::filesystem::is_regular_file(options.input)) return {};
  const io::StackReader reader(options.input);
  const bool of_projector =
      reader.info().kind == model::Kind::sinogram && reader.info().space == model::Space::projector;
  return of_projector ? reader.info().extra : model::Metadata{};
}

void run(const cli::App& app, Options& options) {
  const model::Printer printer = settle(options, facts_of(options));
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
