#include "vam-dose/shown.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "io/settings/flip_log.hpp"
#include "io/stream/stream.hpp"

namespace vam::dose_tool {

std::vector<double> shown_turns(const Options& options, const model::StackInfo& info, const model::Printer& printer) {
  if (options.shown.empty()) return {};
  if (info.space != model::Space::projector) {
    throw Error{Fault::usage, "--shown: applies to a projector sinogram, which a print shows"};
  }
  std::vector<double> turns(static_cast<std::size_t>(info.height));
  const auto from = static_cast<int>(std::lround(info.angle_start_deg / info.angle_step_deg));
  const std::string sinogram = options.input == "-" ? "" : io::sha256_of(options.input);
  for (const std::string& run : options.shown) {
    const std::string armed = io::armed_sinogram(run);
    if (!armed.empty() && !sinogram.empty() && armed != sinogram) {
      throw Error{Fault::data, options.input + ": is not the sinogram of " + run + ", whose SHA-256 begins " +
                                   armed.substr(0, 8) + "; give the one that was shown"};
    }
    const auto of_run = io::turns_shown(io::read_shown(run), info.height, printer.stage.speed_deg_s);
    for (int row = 0; row < info.height; ++row) {
      turns[row] += of_run[static_cast<std::size_t>(((row + from) % info.height + info.height) % info.height)];
    }
  }
  if (std::all_of(turns.begin(), turns.end(), [](double t) { return t == 0; })) {
    throw Error{Fault::data, options.shown.front() + ": no light was shown in this run"};
  }
  return turns;
}

void weigh(const std::vector<double>& turns, std::span<Image> sinograms) {
  if (turns.empty()) return;
  for (Image& image : sinograms) {
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) image(column, row) *= static_cast<float>(turns[row]);
    }
  }
}

}  // namespace vam::dose_tool
