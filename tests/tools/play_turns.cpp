// SPDX-License-Identifier: GPL-3.0-or-later
// play_turns FLIPS.jsonl [key=value...] [printer.key=value...]: a simulated print without a clock. The light of
// sinograms cures the resin of lib/sim, and a camera views it. The printer is that of $VAM_PRINTER or ./printer.toml,
// but for what printer.key=value says of the true one. A command a line on standard input:
//   play SINOGRAM FROM TO VIEWS.exr   the stage turns from FROM to TO deg, counted from the first light; SINOGRAM - :
//                                     dark; VIEWS.exr - : none, + : with the next ones
//   settled CURED.vdb                 conversion over that of the gel point, when all radicals are spent; light may go
//   on
// after which a line "done" follows. FLIPS.jsonl is the log of the light, as vam-project writes it.
//   views: of a turn    noise specks background (of full scale)    seed    columns rows: of the camera
//   voxel (mm)  induction  delay (s)  gradient  diffusion (mm2/s): of the resin    drift (1/min): of the lamp
//   centre (px): of the vial in the projector's columns
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/sha256.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "optics/projector_frames.hpp"
#include "sim/bench/print.hpp"

namespace {

using namespace vam;

struct Turn {
  std::vector<GreyImage> frames;
  double full_scale = 0;
};

/// The frames of a turn, one for each angle. Its full scale is stated, or that of the first one, or else its peak.
Turn read_turn(const std::string& path, const model::Projector& projector, double& full_scale) {
  io::StackReader reader(path);
  optics::FrameComposer composer(path, reader.info(), optics::frame_place(projector, 0, 0));
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about);) composer.add(slice, about.z_mm);
  composer.check();
  const auto stated = reader.info().extra.find("vam:full_scale");
  if (full_scale == 0) full_scale = static_cast<double>(composer.peak());
  Turn turn;
  turn.full_scale = stated == reader.info().extra.end() ? full_scale : std::stod(stated->second);
  const double step_deg = 360.0 / reader.info().height;
  for (int k = 0; k < reader.info().height; ++k) {
    const Image light = composer.frame(k * step_deg, step_deg);
    GreyImage& grey = turn.frames.emplace_back(light.width, light.height, 8);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double share = static_cast<double>(light.values[i]) / turn.full_scale;
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    }
  }
  return turn;
}

class Play {
 public:
  Play(const sim::SimBench& bench, int views, const char* log)
      : bench_(bench), print_(bench), scene_(bench, 1, 16), views_(views), log_(log) {
    say({{"event", "display"}});
  }

  void turn(const std::string& path, double from_deg, double to_deg, const std::string& views) {
    const bool dark = path == "-";
    if (!dark && path != shown_) {
      turn_ = read_turn(path, bench_.printer.projector, full_scale_);
      say({{"event", shown_.empty() ? "sinogram" : "frames"},
           {"sinogram", path},
           {"sinogram_sha256", io::sha256_of(path)},
           {"full_scale", turn_.full_scale}});
      shown_ = path;
    }
    const int steps = static_cast<int>(turn_.frames.size());
    const double step_deg = 360.0 / steps;
    const double step_s = step_deg / bench_.printer.stage.speed_deg_s;
    for (long n = std::lround(from_deg / step_deg); n < std::lround(to_deg / step_deg); ++n) {
      const double angle_deg = static_cast<double>(n) * step_deg;
      say({{"event", "flip"},
           {"t_monotonic_s", static_cast<double>(n) * step_s},
           {"frame", dark ? -1 : n % steps},
           {"angle_deg", angle_deg}});
      print_.pass(dark ? nullptr : &turn_.frames[n % steps], angle_deg, step_s);
      if (views == "-" || (n + 1) * views_ / steps == n * views_ / steps) continue;
      const double view_deg = (static_cast<double>(n) + 0.5) * step_deg;
      const sim::SimMoment moment{view_deg, nullptr, print_.lit_s(), 1, &print_};
      const GreyImage levels = scene_.render(moment, bench_.printer.camera.exposure_us, number_++);
      Image& image = seen_.emplace_back(levels.width, levels.height);
      for (std::size_t i = 0; i < image.size(); ++i) image.values[i] = static_cast<float>(levels.values[i]) / 65535.0F;
      model::ImageInfo info;
      info.has_angle = info.has_time = true;
      info.angle_deg = view_deg;
      info.time_s = view_deg / bench_.printer.stage.speed_deg_s;
      about_.push_back(info);
    }
    if (views == "-" || views == "+") return;
    write(views);
    seen_.clear();
    about_.clear();
  }

  void write(const std::string& views) const {
    model::StackInfo info;
    info.kind = model::Kind::frames;
    info.space = model::Space::camera;
    info.width = scene_.columns();
    info.height = scene_.rows();
    info.count = static_cast<int>(seen_.size());
    info.pixel_mm = info.row_mm = bench_.printer.camera.pixel_mm;
    io::StackWriter writer(views, info, about_, {.half = false, .compression = "none"});
    for (const Image& image : seen_) writer.write(image);
    writer.commit();
  }

  void settled(const std::string& path) const {
    sim::Photoresin resin = print_.resin();
    for (int n = 0; n < 20; ++n) resin.react(1);
    const model::Volume volume = resin.conversion();
    io::SparseVolume written("conversion", volume.grid);
    written.units = "conversion of the gel point";
    written.write_slices(0, volume.grid.nz, volume.values.data());
    io::write_volume(path, written);
  }

 private:
  void say(const Json& event) { log_ << event.dump() << std::endl; }

  sim::SimBench bench_;
  sim::SimPrint print_;
  sim::SimScene scene_;
  int views_;
  std::ofstream log_;
  std::string shown_;
  Turn turn_;
  double full_scale_ = 0;  // of the first sinogram
  long number_ = 0;
  std::vector<model::ImageInfo> about_;  // views that wait to be written
  std::vector<Image> seen_;
};

}  // namespace

int main(int argc, char** argv) try {
  std::map<std::string, double> set{{"views", 90},      {"noise", 0.002}, {"specks", 0},   {"background", 0.01},
                                    {"seed", 1},        {"columns", 90},  {"rows", 68},    {"voxel", 0.2},
                                    {"induction", 0.5}, {"delay", 3},     {"gradient", 0}, {"diffusion", 1e-4},
                                    {"drift", 0},       {"centre", 0}};
  std::vector<std::string> sets;
  for (int i = 2; i < argc; ++i) {
    const std::string item = argv[i];
    const auto equals = item.find('=');
    if (item.find('.') < equals) {
      sets.push_back(item);
    } else {
      set.at(item.substr(0, equals)) = std::stod(item.substr(equals + 1));
    }
  }
  const auto whole = [&](const char* key) { return static_cast<int>(set.at(key)); };
  sim::SimBench bench;
  bench.printer = io::load_printer("", sets, io::Records::ignore);
  bench.columns = whole("columns");
  bench.rows = whole("rows");
  bench.glow = 0;
  bench.noise = set["noise"];
  bench.specks = whole("specks");
  bench.background = set["background"];
  bench.seed = whole("seed");
  bench.centre_px = set["centre"];
  bench.lamp_drift_per_min = set["drift"];
  bench.resin = sim::SimResin{};
  bench.resin->voxel_mm = set["voxel"];
  bench.resin->induction = set["induction"];
  bench.resin->delay_s = set["delay"];
  bench.resin->inhibition_gradient = set["gradient"];
  bench.resin->inhibitor_diffusion_mm2_s = set["diffusion"];
  Play play(bench, whole("views"), argv[1]);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command, path, views;
    double from_deg = 0;
    double to_deg = 0;
    words >> command >> path;
    if (command == "play" && words >> from_deg >> to_deg >> views) {
      play.turn(path, from_deg, to_deg, views);
    } else if (command == "settled") {
      play.settled(path);
    } else {
      std::fprintf(stderr, "play_turns: %s: no such command\n", line.c_str());
      return 1;
    }
    std::puts("done");
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "play_turns: %s\n", error.what());
  return 1;
}
