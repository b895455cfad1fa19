// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sinogram: the projections of a part, plain, filtered or exponential.
#include <algorithm>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/compute/slab.hpp"
#include "base/error.hpp"
#include "base/image.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "io/exr/stack_batches.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "model/grid_size.hpp"
#include "session/printer.hpp"
#include "tomo/fbp.hpp"
#include "tomo/filtered_projections.hpp"
#include "tomo/negative_values.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string grid = "target";
  int angles = 360;
  std::optional<int> bins;
  std::string filter = "none";
  std::optional<double> cutoff;
  std::string negative = "keep";
  std::optional<double> absorption_per_mm;
  bool printer_absorption = false;
  bool at_wall = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

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

/// Calls use(slabs, count) for the sinograms of all slices, a pass of up to 64 at a time, the next slices being read
/// meanwhile.
void for_each_pass(const io::SparseVolume& volume, const tomo::ProjectionSpec& spec,
                   const std::function<void(std::vector<Slab>& sinograms, int count)>& use) {
  const model::Grid& grid = volume.grid();
  const tomo::FilteredProjections projections(spec);
  const int slices = tomo::slabs_a_pass(spec.geometry) * lanes;
  // Two passes of slices that are read, one of them in slabs, and two of sinograms.
  require_memory(
      sizeof(float) * static_cast<double>(slices) *
          (3.0 * static_cast<double>(grid.slice_size()) + 2.0 * spec.geometry.columns * spec.geometry.angles),
      volume.name() + ": " + model::size_text(grid), "use larger voxels or fewer --angles");
  const auto read = [&](int first) {
    std::vector<float> dense(static_cast<std::size_t>(std::clamp(grid.nz - first, 0, slices)) * grid.slice_size());
    if (first < grid.nz) volume.read_slices(first, std::min(slices, grid.nz - first), dense.data());
    return dense;
  };
  Progress progress("projecting", grid.nz);
  auto ahead = std::async(std::launch::async | std::launch::deferred, read, 0);
  for (int first = 0; first < grid.nz; first += slices) {
    const std::vector<float> dense = ahead.get();
    ahead = std::async(std::launch::async | std::launch::deferred, read, first + slices);
    const int count = std::min(slices, grid.nz - first);
    std::vector<Slab> images;
    std::vector<Slab> sinograms;
    for (int s = 0; s < count; s += lanes) {
      images.emplace_back(grid.nx, grid.ny);
      sinograms.emplace_back(spec.geometry.columns, spec.geometry.angles);
      pack(dense.data() + product(s, grid.slice_size()), std::min(lanes, count - s), images.back());
    }
    projections.apply(images, sinograms);
    use(sinograms, count);
    progress.tick(count);
  }
}

/// The first `count` slices of the slabs.
std::vector<Image> unpacked(const std::vector<Slab>& slabs, int count) {
  std::vector<Image> images;
  std::vector<float> values;
  for (const Slab& slab : slabs) {
    const int used = std::min(lanes, count - count_of(images));
    const std::size_t size = slab.values.size() / lanes;
    values.resize(size * static_cast<std::size_t>(used));
    unpack(slab, used, values.data());
    for (int i = 0; i < used; ++i) {
      Image& image = images.emplace_back(slab.width, slab.height);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size) * i, size, image.values.begin());
    }
  }
  return images;
}

tomo::ProjectionSpec make_spec(const Options& options, const model::Printer& printer, const model::Grid& grid) {
  tomo::ProjectionSpec spec;
  const double mu =
      options.printer_absorption ? printer.resin.absorption_per_mm : options.absorption_per_mm.value_or(0);
  spec.geometry = tomo::full_turn(grid, options.angles, options.bins.value_or(0), mu);
  spec.voxel_mm = grid.voxel_mm;
  spec.filter.window = tomo::window_from_name(options.filter);
  spec.filter.cutoff = options.cutoff.value_or(1);
  if (options.at_wall) spec.wall_radius_mm = model::resin_radius_mm(printer.vial);
  return spec;
}

model::StackInfo make_info(const tomo::ProjectionSpec& spec, const io::SparseVolume& volume,
                           const std::string& history) {
  model::StackInfo info;
  info.width = spec.geometry.columns;
  info.height = spec.geometry.angles;
  info.count = volume.grid().nz;
  info.pixel_mm = info.row_mm = spec.voxel_mm;
  info.z_start_mm = volume.grid().z_mm(0);
  info.angle_step_deg = 360.0 / spec.geometry.angles;
  info.units = spec.filter.window == tomo::FilterWindow::none ? "mm" : "1/rad";
  info.history = volume.history;
  info.history.push_back(history);
  info.extra = volume.metadata;
  return info;
}

void run(const cli::App& app, const Options& options) {
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, options.output)) return;
  session::require_settings(app, printer);
  const io::SparseVolume volume = io::read_volume(options.input, options.grid);
  io::check_values(options.input, volume);
  if (volume.name() == "target" && io::farthest_mm(volume, 0) < 0) {
    throw Error{Fault::data, io::input_name(options.input) +
                                 ": the target is empty (no coverage anywhere); there is nothing to project"};
  }
  const tomo::ProjectionSpec spec = make_spec(options, printer, volume.grid());
  io::StackWriter out(options.output, make_info(spec, volume, app.history()), options.stack);

  float raise = 0;
  if (options.negative == "offset") {
    for_each_pass(volume, spec, [&](const std::vector<Slab>& slabs, int) {
      for (const Slab& slab : slabs) raise = std::max(raise, -tomo::lowest(slab));
    });
  }
  io::WriteBehind writer(out);
  for_each_pass(volume, spec, [&](std::vector<Slab>& slabs, int count) {
    if (options.negative != "keep") {
      for (Slab& slab : slabs) tomo::raise_and_clip(slab, raise, 0);
    }
    writer.put(unpacked(slabs, count));
  });
  writer.finish();
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-sinogram", "project a part along parallel rays, with or without ramp filter", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
