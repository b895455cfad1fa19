#include "io/settings/flip_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/json.hpp"

namespace vam::io {

namespace {

struct FlipLine {
  double t_s;
  int frame;
  double angle_deg;
  bool last = false;  // of its run
};

std::vector<FlipLine> read_flips(const std::string& file) {
  std::ifstream stream(file);
  if (!stream.is_open()) throw Error{Fault::no_input, file + ": cannot open: " + std::strerror(errno)};
  std::vector<FlipLine> flips;
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    const Json event = Json::parse(text, nullptr, false);
    if (event.is_discarded() && stream.eof()) break;  // cut by the death of its writer
    try {
      if (event.at("event") == "display" && !flips.empty()) flips.back().last = true;  // another run begins
      if (event.at("event") != "flip") continue;
      flips.push_back({event.at("t_monotonic_s"), event.at("frame"), event.at("angle_deg"), false});
    } catch (const Json::exception&) {
      throw Error{Fault::data, file + ":" + std::to_string(line) + ": is no event of vam-project's log"};
    }
  }
  return flips;
}

}  // namespace

std::vector<ShownImage> read_shown(const std::string& path) {
  const bool folder = std::filesystem::is_directory(path);
  const std::string file = folder ? (std::filesystem::path(path) / "flips.jsonl").string() : path;
  const std::vector<FlipLine> flips = read_flips(file);
  std::vector<ShownImage> shown;
  for (std::size_t i = 0; i < flips.size(); ++i) {
    if (flips[i].frame < 0) continue;
    const bool last = flips[i].last || i + 1 == flips.size();
    const double seconds = !last ? flips[i + 1].t_s - flips[i].t_s : shown.empty() ? 0 : shown.back().seconds;
    shown.push_back({flips[i].angle_deg, std::max(0.0, seconds)});
  }
  return shown;
}

std::string armed_sinogram(const std::string& run) {
  if (!std::filesystem::is_directory(run)) return "";
  std::ifstream events((std::filesystem::path(run) / "events.jsonl").string());
  for (std::string text; std::getline(events, text);) {
    const Json event = Json::parse(text, nullptr, false);
    if (!event.is_object() || !event.contains("sinogram_sha256")) continue;
    if (event["sinogram_sha256"].is_string()) return event["sinogram_sha256"];
  }
  return "";
}

std::vector<double> turns_shown(const std::vector<ShownImage>& shown, const StageRows& rows, double speed_deg_s) {
  std::vector<double> turns(static_cast<std::size_t>(rows.count));
  const double row_s = 360.0 / rows.count / speed_deg_s;
  for (const ShownImage& image : shown) {
    const long nearest = std::lround((image.angle_deg - rows.start_deg) / rows.step_deg) % rows.count;
    turns[static_cast<std::size_t>(nearest < 0 ? nearest + rows.count : nearest)] += image.seconds / row_s;
  }
  return turns;
}

}  // namespace vam::io
