// vam-sinogram: the projections of a part, plain, filtered or exponential.
#include <algorithm>
#include <future>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "printer.hpp"
#include "tomo/fbp.hpp"
#include "tomo/projections.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string grid = "target";
  int angles = 360;
  std::optional<int> columns;
  std::string filter = "none";
  std::optional<double> cutoff;
  std::string negative = "keep";
  std::optional<double> attenuation_per_mm;
  bool resin = false;
  bool at_wall = false;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

cli::Manual manual() {
  return {
      "vam-sinogram",
      "project a part along parallel rays, with or without the filter of back-projection",
      {"vam-sinogram reads the target of a part and writes its sinograms: for every z slice an image with one row per "
       "stage angle and one column per offset from the rotation axis. Column c lies at (c - (columns - 1)/2) voxels "
       "from the axis, row a at a * 360/angles degrees. The ray of offset t at angle theta is the line t (cos theta, "
       "sin theta) + u (-sin theta, cos theta) of the part, u along the light.",
       "Without a filter the values are integrals of coverage along the rays, in mm: the Radon transform. With "
       "--filter they are the light to project: adding up light * (angle step in radian) over all angles along the "
       "rays gives the part again. Such light is negative in places, which no projector can show; --negative says what "
       "to do about it. Setting it to 0 (clip) is the simplest recipe that prints; vam-optimize finds better light.",
       "In resin that absorbs, with coefficient MU, --attenuation weights every point of a ray by e^(MU u): the "
       "exponential Radon transform. With a filter the result is its exact inverse, so that light whose intensity "
       "falls as e^(-MU u) adds up to the part. Its values are those at the plane through the axis; --at-wall gives "
       "them where the light enters the resin, larger by e^(MU sqrt(R^2 - t^2))."},
      {{"The Radon transform of a disc grid:",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-sinogram part.vdb -o radon.exr"},
       {"Projections to print, through a pipe:",
        "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-resample -o frames.exr"},
       {"A softer filter, 500 angles:", "vam-sinogram --filter hann --cutoff 0.5 --angles 500 part.vdb -o soft.exr"},
       {"For resin that absorbs a tenth per mm:",
        "vam-sinogram --filter ram-lak --negative clip --attenuation 0.1 --at-wall part.vdb -o absorbing.exr"}},
      {"Accuracy: every voxel is a square of uniform density, and a column is the exact area that its strip of one "
       "voxel width cuts out of it, so that every row holds the whole mass of the slice. The transform used for "
       "back-projection everywhere in these tools is its exact transpose.",
       "Filters: ram-lak is the ramp |f| built from its band-limited kernel; the others multiply it by a window of x = "
       "f / (cutoff * Nyquist): shepp-logan sin(pi x/2)/(pi x/2), cosine cos(pi x/2), hamming 0.54 + 0.46 cos(pi x), "
       "hann 0.5 + 0.5 cos(pi x), all 0 beyond x = 1; gaussian e^(-x^2), exponential e^(-|x|).",
       "Memory: the target as it is in the file, and at most 1 GiB for slices on their way (16 slices at least). "
       "--negative offset works everything out twice, first for the lowest value of the stack.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, eq 1-3; Kak and Slaney, Principles of Computerized "
       "Tomographic Imaging, 1988, chapter 3; Tretiak and Metz, The exponential Radon transform, 1980; Long and "
       "Fessler, 3D forward and back-projection using separable footprints, 2010."},
      {"vam-dose", "vam-optimize", "vam-resample", "vam-slice", "vam-view"}};
}

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

tomo::ProjectionSpec make_spec(const Options& options, const model::Printer& printer, const model::Grid& grid) {
  tomo::ProjectionSpec spec;
  const double mu = options.resin ? printer.resin.absorption_per_mm : options.attenuation_per_mm.value_or(0);
  spec.geometry = tomo::full_turn(grid, options.angles, options.columns.value_or(0), mu);
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
  info.units = spec.filter.window == tomo::Window::none ? "mm" : "1/rad";
  info.history = volume.history;
  info.history.push_back(history);
  info.extra = volume.metadata;
  return info;
}

/// Calls use(slabs, count) for the sinograms of all slices, a pass of up to 64 at a time, the next slices being read
/// meanwhile.
template <class Use>
void for_each_pass(const io::SparseVolume& volume, const tomo::ProjectionSpec& spec, const Use& use) {
  const model::Grid& grid = volume.grid();
  const tomo::Projections projections(spec);
  const int slices = tomo::slabs_a_pass(spec.geometry) * tomo::lanes;
  const auto read = [&](int first) {
    std::vector<float> dense(static_cast<std::size_t>(std::clamp(grid.nz - first, 0, slices)) * grid.slice_size());
    if (first < grid.nz) volume.read_slices(first, std::min(slices, grid.nz - first), dense.data());
    return dense;
  };
  Progress progress("projecting", grid.nz);
  auto ahead = std::async(std::launch::async, read, 0);
  for (int first = 0; first < grid.nz; first += slices) {
    const std::vector<float> dense = ahead.get();
    ahead = std::async(std::launch::async, read, first + slices);
    const int count = std::min(slices, grid.nz - first);
    std::vector<tomo::Slab> images;
    std::vector<tomo::Slab> sinograms;
    for (int s = 0; s < count; s += tomo::lanes) {
      images.emplace_back(grid.nx, grid.ny);
      sinograms.emplace_back(spec.geometry.columns, spec.geometry.angles);
      tomo::pack(dense.data() + static_cast<std::size_t>(s) * grid.slice_size(), std::min(tomo::lanes, count - s),
                 images.back());
    }
    projections.work_out(images, sinograms);
    use(sinograms, count);
    progress.tick(count);
  }
}

std::vector<Image> unpacked(const std::vector<tomo::Slab>& slabs, int count) {
  std::vector<Image> images;
  std::vector<float> values;
  for (const tomo::Slab& slab : slabs) {
    const int used = std::min(tomo::lanes, count - static_cast<int>(images.size()));
    const std::size_t size = slab.values.size() / tomo::lanes;
    values.resize(size * static_cast<std::size_t>(used));
    tomo::unpack(slab, used, values.data());
    for (int i = 0; i < used; ++i) {
      Image& image = images.emplace_back(slab.width, slab.height);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size) * i, size, image.values.begin());
    }
  }
  return images;
}

void run(const cli::App& app, const Options& options) {
  if (options.resin && options.attenuation_per_mm)
    throw Error{Fault::usage, "--attenuation: give it or --resin, not both"};
  if (options.cutoff && options.filter == "none")
    throw Error{Fault::usage, "--cutoff: has no meaning without --filter"};
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, options.output)) return;
  io::refuse_same_file(options.input, options.output);
  const io::SparseVolume volume = io::read_volume(options.input, options.grid);
  const tomo::ProjectionSpec spec = make_spec(options, printer, volume.grid());
  io::StackWriter out(options.output, make_info(spec, volume, app.history()), options.stack);

  float raise = 0;
  if (options.negative == "offset") {
    for_each_pass(volume, spec, [&](const std::vector<tomo::Slab>& slabs, int) {
      for (const tomo::Slab& slab : slabs) raise = std::max(raise, -tomo::lowest(slab));
    });
  }
  std::future<void> writing;
  for_each_pass(volume, spec, [&](std::vector<tomo::Slab>& slabs, int count) {
    if (options.negative != "keep") {
      for (tomo::Slab& slab : slabs) tomo::raise_and_clip(slab, raise, 0);
    }
    std::vector<Image> images = unpacked(slabs, count);
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [&out, done = std::move(images)] {
      for (const Image& image : done) out.write(image);
    });
  });
  if (writing.valid()) writing.get();
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
