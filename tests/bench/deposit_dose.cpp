// SPDX-License-Identifier: GPL-3.0-or-later
// deposit_dose LIGHT.exr DOSE.vdb OUT.vdb (RAYS): the dose of a projector stack by the deposition oracle, on the voxels
// of vam-dose's DOSE; RAYS x RAYS rays a pixel. Prints as JSON how far DOSE is from it: rms, the root mean square
// difference over the root mean square dose within 0.95 of the radius that all angles light, and mean, relative; and
// the share of the power that was absorbed. For tests/bench/climbing.py.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "io/exr/stack.hpp"
#include "io/settings/printer_match.hpp"
#include "io/vdb/vdb.hpp"
#include "model/magnification.hpp"
#include "model/printer.hpp"
#include "oracle/deposited_dose.hpp"

namespace {

using namespace vam;

oracle::Deposit setup_of(const model::Printer& printer, const model::StackInfo& light, const model::Grid& grid,
                         int rays) {
  oracle::Deposit setup;
  if (!printer.projector.telecentric) setup.bench.lens_distance = model::columns_lens_mm(printer.projector).value();
  setup.bench.bath = printer.bath.index;
  if (printer.bath.index != 1) setup.bench.window = printer.bath.window_mm;
  if (printer.vial.wall_mm > 0) {
    setup.bench.cylinders.push_back({printer.vial.radius_mm, printer.vial.index_glass});
  }
  setup.bench.cylinders.push_back({model::resin_radius_mm(printer.vial), printer.resin.index});
  setup.pixel = light.pixel_mm;
  setup.row = light.row_mm;
  setup.axis_column = printer.projector.axis_column;
  setup.rays = rays;
  setup.absorption = printer.resin.absorption_per_mm;
  setup.angles = light.height;
  setup.first_angle = printer.stage.direction * light.angle_start_deg * std::numbers::pi / 180;
  setup.angle_step = printer.stage.direction * light.angle_step_deg * std::numbers::pi / 180;
  setup.size = grid.nx;
  setup.slices = grid.nz;
  setup.voxel = grid.voxel_mm;
  const double scale = model::vertical_magnification(printer);
  setup.height = scale * grid.voxel_mm;
  setup.first_slice = scale * grid.z_mm(0);
  return setup;
}

oracle::Deposited deposit_all(const oracle::Deposit& setup, const std::vector<Image>& rows,
                              const model::StackInfo& light) {
  const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<oracle::Deposited> parts(threads);
  std::vector<std::thread> workers;
  for (unsigned t = 0; t < threads; ++t) {
    parts[t].dose.assign(static_cast<std::size_t>(setup.size) * setup.size * static_cast<std::size_t>(setup.slices), 0);
    workers.emplace_back([&, t] {
      for (std::size_t r = t; r < rows.size(); r += threads) {
        oracle::deposit(setup, rows[r], light.z_start_mm + static_cast<double>(r) * light.row_mm, parts[t]);
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  for (unsigned t = 1; t < threads; ++t) {
    for (std::size_t i = 0; i < parts[0].dose.size(); ++i) parts[0].dose[i] += parts[t].dose[i];
    parts[0].entered += parts[t].entered;
    parts[0].absorbed += parts[t].absorbed;
  }
  return std::move(parts[0]);
}

int run(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "deposit_dose LIGHT.exr DOSE.vdb OUT.vdb (RAYS)\n";
    return 64;
  }
  io::StackReader in(argv[1]);
  const model::StackInfo light = in.info();
  const model::Printer printer = io::parse_settings(light.extra.at("vam:printer"), argv[1]);
  std::vector<Image> rows;
  Image image;
  for (model::ImageInfo about; in.next(image, about);) rows.push_back(image);
  const io::SparseVolume judged = io::read_volume(argv[2], "dose");
  const model::Grid grid = judged.grid();
  const oracle::Deposit setup = setup_of(printer, light, grid, argc > 4 ? std::stoi(argv[4]) : 4);
  const oracle::Deposited result = deposit_all(setup, rows, light);

  io::SparseVolume out("dose", grid);
  out.metadata = judged.metadata;
  const double radius = 0.95 * std::min(setup.size * 0.5 * setup.voxel, model::resin_radius_mm(printer.vial) *
                                                                            printer.bath.index / printer.resin.index);
  std::vector<float> want(grid.slice_size());
  std::vector<float> got(grid.slice_size());
  double error = 0, square = 0, sum = 0, sum_got = 0;
  for (int k = 0; k < grid.nz; ++k) {
    const double* dose = result.dose.data() + static_cast<std::size_t>(k) * grid.slice_size();
    judged.read_slices(k, 1, got.data());
    for (std::size_t i = 0; i < want.size(); ++i) {
      want[i] = static_cast<float>(dose[i]);
      const auto x = static_cast<int>(i % static_cast<std::size_t>(grid.nx));
      const auto y = static_cast<int>(i / static_cast<std::size_t>(grid.nx));
      if (std::hypot(grid.x_mm(x), grid.y_mm(y)) > radius) continue;
      const double off = static_cast<double>(got[i]) - dose[i];
      error += off * off;
      square += dose[i] * dose[i];
      sum += dose[i];
      sum_got += static_cast<double>(got[i]);
    }
    out.write_slices(k, 1, want.data());
  }
  io::write_volume(argv[3], out);
  std::printf("{\"rms\": %.3g, \"mean\": %.3g, \"absorbed\": %.6g}\n", std::sqrt(error / square), sum_got / sum - 1,
              result.entered > 0 ? result.absorbed / result.entered : 0.0);
  return 0;
}

}  // namespace

int main(int argc, char** argv) try { return run(argc, argv); } catch (const std::exception& error) {
  std::cerr << "deposit_dose: " << error.what() << '\n';
  return 70;
}
