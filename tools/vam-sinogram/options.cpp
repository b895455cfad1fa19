// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-sinogram/options.hpp"

#include "tomo/fbp.hpp"
#include "tomo/negative_values.hpp"

namespace vam::sinogram_tool {

void declare(cli::App& app, Options& options) {
  app.positional("TARGET", options.input, "Volume (VDB) with values 0...1 and the rotation axis at x = y = 0.").reads();
  cli::add_output(app, options.output).writes_as({".exr", ".toml"});
  app.option("--grid", "NAME", options.grid, "Grid to project.");
  app.option("--angles", "N", options.angles, {1, 1000000}, "Number of angles over 360 degrees, endpoint excluded.");
  app.option("--detector-bins", "N", options.bins, {1, 65536},
             "Number of detector bins, each one voxel wide. Fewer than the default truncate the projections.");
  app.default_is("as many as cover the grid with its corners");
  app.choice("--filter", options.filter, tomo::window_names(), "Window of the ramp filter.");
  app.option("--cutoff", "FRACTION", options.cutoff, {0, 1000, true},
             "Cutoff of the window (scale k0 for gaussian and exponential), as a fraction of the Nyquist frequency.")
      .excludes({"--filter none"});
  app.default_is("1");
  app.choice("--negative", options.negative, tomo::negative_names(),
             "Negative values: keep them, clip them to 0, or subtract the minimum of the stack from all values.")
      .excludes({"--filter none"});
  app.group("Absorption");
  app.option("--absorption", "PER_MM", options.absorption_per_mm, cli::non_negative,
             "Absorption coefficient MU of the resin: exponential Radon transform.");
  app.flag("--printer-absorption", options.printer_absorption, "Use resin.absorption_per_mm of the printer file as MU.")
      .only_with({"resin.absorption_per_mm"})
      .excludes({"--absorption"});
  app.flag("--at-wall", options.at_wall,
           "Give the values at the inner wall of the printer's vial instead of at the plane through the axis.");
  app.only_with({"--absorption", "--printer-absorption"});
  cli::add_printer(app, options.printer);
  app.group("Output and performance");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  app.usual({"--output", "--angles", "--detector-bins", "--filter", "--cutoff", "--negative", "--absorption",
             "--printer-absorption", "--printer", "--set"});
}

}  // namespace vam::sinogram_tool
