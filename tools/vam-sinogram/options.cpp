#include "vam-sinogram/options.hpp"

#include "tomo/fbp.hpp"
#include "tomo/projections.hpp"

namespace vam::sinogram_tool {

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with values 0...1 and the rotation axis at x = y = 0.");
  cli::add_output(app, options.output);
  app.option("--grid", "NAME", options.grid, "The grid to project.");
  app.option("--angles", "N", options.angles, {1, 1000000}, "Angles over 360 degrees, endpoint excluded.");
  app.option("--columns", "N", options.columns, {1, 65536},
             "Columns, each a voxel wide; without it all that see the grid, corners included. Fewer cut the rim off.");
  app.choice("--filter", options.filter, tomo::window_names(), "Filter across the columns.");
  app.option("--cutoff", "FRACTION", options.cutoff, {0, 1000, true},
             "Where the filter's window ends (its scale k0 for gaussian and exponential), as a fraction of the Nyquist "
             "frequency. Without it 1.");
  app.choice("--negative", options.negative, tomo::negative_names(),
             "Negative values: keep them, clip them to 0, or offset all by the lowest of the stack.");
  app.group("Absorption");
  app.option("--attenuation", "PER_MM", options.attenuation_per_mm, cli::non_negative,
             "Absorption coefficient MU of the resin: exponential Radon transform.");
  app.flag("--resin", options.resin, "Take MU from the printer file (resin.absorption_per_mm).");
  app.flag("--at-wall", options.at_wall, "Give the light at the inner wall of the printer's vial, not at the axis.");
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
}

}  // namespace vam::sinogram_tool
