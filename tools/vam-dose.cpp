// SPDX-License-Identifier: GPL-3.0-or-later
// vam-dose: simulates the dose of a print.
#include <malloc.h>

#include "base/constants.hpp"
#include "base/text/json.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "vam-dose/expose.hpp"
#include "vam-dose/light.hpp"
#include "vam-dose/options.hpp"
#include "vam-dose/place.hpp"
#include "vam-dose/shown.hpp"
#include "vam-dose/unit.hpp"

namespace {

using namespace vam;
using dose_tool::Options;

/// Options -> light and voxels -> doses of a turn, slice by slice -> one unit for all -> volume and report.
void run(const cli::App& app, Options& options) {
  options.printer = printer_of(options);
  if (session::print_printer(options.printer, options.output)) return;
  take_sinogram(app, options);

  io::StackReader in(options.inputs.front());
  io::require(options.inputs.front(), in.info(), model::Kind::sinogram);
  const std::string name = io::input_name(options.inputs.front());
  const bool printed = !options.shown.empty();  // a print has settings of its own
  const model::Printer printer =
      session::printer_of(options.printer, printed ? model::Metadata{} : in.info().extra, name);
  session::require_settings(app, printer);
  options.alignment.angle_offset_rad = options.angle_offset_deg * rad_per_deg;
  take_full_scale(options);
  const session::Exposure stated = session::exposure_of(name, in.info(), printer, 0);
  const bool anew = options.exposure_plan && stated.planned;
  if (!options.full_scale && !anew && stated.full_scale > 0) options.full_scale = stated.full_scale;
  const model::StackInfo info = posed(app, in.info(), options);
  const dose_tool::Place place = place_of(options, printer, info);
  io::SparseVolume volume = empty_volume(app, place, printer, info, options);
  dose_tool::Light light(in, info, options, printer, stated.planned && !anew ? stated.turns : 1);
  const dose_tool::Exposed exposed = expose(light, info, options, printer, place, volume);

  const dose_tool::Unit unit = unit_of(exposed, options, printer, info);
  convert(volume, unit);
  io::write_volume(options.output, volume);
  io::write_report(options.report, "vam-dose", figures(exposed, unit, options, printer, info));
}

}  // namespace

int main(int argc, char** argv) {
  // Images of rows come and go among slabs that stay: each in pages of its own, or the gaps count as memory in use.
  mallopt(M_MMAP_THRESHOLD, 1 << 18);
  cli::App app({"vam-dose", "simulate the dose that a print delivers to the resin", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
