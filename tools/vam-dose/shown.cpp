#include "vam-dose/shown.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/stream/stream.hpp"

namespace vam::dose_tool {

std::vector<double> shown_turns(const Options& options, const model::StackInfo& info, const model::Printer& printer) {
  if (options.shown.empty()) return {};
  if (info.space != model::Space::projector) {
    throw Error{Fault::usage, "--shown: applies to a projector sinogram, which a print shows"};
  }
  const io::StageRows rows{info.height, info.angle_start_deg, info.angle_step_deg};
  if (std::abs(std::abs(rows.step_deg) * rows.count - 360) > 0.01 * std::abs(rows.step_deg)) {
    throw Error{Fault::data, options.input + ": has " + format_number(std::abs(rows.step_deg) * rows.count) +
                                 " degrees of stage angles; --shown needs one turn"};
  }
  std::vector<double> turns(static_cast<std::size_t>(info.height));
  const std::string sinogram = options.input == "-" ? "" : io::sha256_of(options.input);
  for (const std::string& run : options.shown) {
    const std::string armed = io::armed_sinogram(run);
    if (!armed.empty() && !sinogram.empty() && armed != sinogram) {
      throw Error{Fault::data, options.input + ": is not the sinogram of " + run + ", whose SHA-256 begins " +
                                   armed.substr(0, 8) + "; give the one that was shown"};
    }
    const auto of_run = io::turns_shown(io::read_shown(run), rows, printer.stage.speed_deg_s);
    std::transform(turns.begin(), turns.end(), of_run.begin(), turns.begin(), std::plus<>{});
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
