// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-correct/renewal.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/image.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "session/exposure.hpp"

namespace vam::correct_tool {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr double turn_deg = 360;
constexpr auto replace = fs::copy_options::overwrite_existing;

// The print goes on as it does.
[[noreturn]] void hold(const std::string& reason) { throw Error{Fault::judged, reason}; }

std::string text(double number) { return format_number(number, 9); }

std::string numbered(const std::string& stem, int number, const std::string& ending) {
  const std::string digits = std::to_string(number);
  return stem + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits + ending;
}

bool is_same(const std::string& one, const std::string& other) {
  return fs::file_size(one) == fs::file_size(other) && io::read_all(one) == io::read_all(other);
}

// The time of a volume, by its line in the log of vam-ost.
std::optional<double> time_of(const std::string& path, int number) {
  LogLines log(path);
  for (Json line; log.next(line);) {
    if (!line.contains("waiting") && number-- == 0) return number_at(line, "time_s");
  }
  return {};
}

// Reports of the sensitivity, the newest one without a doubt: what was doubted is no measure for what comes after it.
std::string report_before(const std::string& folder) {
  std::string newest, sure;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string path = entry.path().string();
    if (!entry.path().filename().string().starts_with("sensitivity-") || entry.path().extension() != ".json") continue;
    newest = std::max(newest, path);
    if (path > sure && text_at(parse_json(io::read_all(path)), "verdict") == "go") sure = path;
  }
  return sure.empty() ? newest : sure;
}

// The turns for which a sinogram was planned, and their fraction of full intensity.
std::pair<double, double> plan_of(const std::string& run, const model::Printer& printer) {
  io::StackReader light(run + "/sinogram.exr");
  float peak = 0;
  Image image;
  for (model::ImageInfo about; light.next(image, about);) {
    for (const float value : image.values) peak = std::max(peak, value);
  }
  const auto shown = session::exposure_of(run + "/sinogram.exr", light.info(), printer, static_cast<double>(peak));
  if (shown.share) return {shown.turns, static_cast<double>(peak) / shown.full_scale};
  throw Error{Fault::data, run +
                               "/sinogram.exr: has no planned exposure; compute it by vam-optimize for a printer "
                               "with resin.critical_dose_mj_cm3"};
}

}  // namespace

std::string scatter_name(int number) { return numbered("scatter-", number, ".vdb"); }

Renewal::Renewal(const RenewOptions& options) : options_(options), log_(options.run + "/renewed.jsonl") {
  const auto printer = io::load_printer(file("printer.toml"), {});
  std::tie(planned_turns_, multiplier_) = plan_of(options.run, printer);
  speed_deg_s_ = printer.stage.speed_deg_s;
  delay_s_ = number_at(parse_json(io::read_all(options.curve)), "delay_s");
  lead_deg_ = turn_deg * options.lead;
  fs::create_directories(file("renewed"));
}

double Renewal::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}

std::string Renewal::take(int number) {
  std::string reason;
  try {
    renew(number);
    return "";
  } catch (const std::runtime_error& error) {  // ours, or of a file that is gone
    reason = join(split(trimmed(error.what()), '\n'), " ");
  }
  const std::string folder = scratch_.path() + "/";
  for (std::size_t at = 0; (at = reason.find(folder)) != std::string::npos;) reason.erase(at, folder.size());
  log_("hold", {{"volume", number}, {"reason", reason}});
  return reason;
}

// A command, within what is left of a turn's time; what it says is the reason if it fails.
void Renewal::attempt(const Words& words) const {
  const device::Talk talk;
  const double left_s = turn_deg / speed_deg_s_ - elapsed_s();
  const int status =
      left_s < 0.1 ? device::timed_out
                   : device::run_to_end({words.front(), words}, talk.path("said"), static_cast<int>(1000 * left_s));
  if (status == device::timed_out) hold("a turn has passed");
  if (status != 0) hold(talk.text("said"));
}

Renewal::Moment Renewal::look(int number) const {
  Moment moment;
  const auto seen_s = time_of(file("ost.jsonl"), number);
  constexpr const char* unknown = "no light, or no time of the volume, is known yet";
  if (!seen_s || !fs::exists(file("flips.jsonl"))) hold(unknown);
  moment.flips = scratch("flips.jsonl");  // a copy: the print goes on
  fs::copy_file(file("flips.jsonl"), moment.flips, replace);
  io::FlipLog log(moment.flips);
  log.read();
  const io::LoggedFlip* const last = log.last_lit();
  if (last == nullptr) hold(unknown);
  moment.seen_s = *seen_s;
  moment.from_turn = static_cast<int>((last->angle_deg + lead_deg_) / turn_deg) + 1;
  moment.at_s = last->t_s + (turn_deg * moment.from_turn - last->angle_deg) / speed_deg_s_;
  moment.sinograms = {file("sinogram.exr")};
  for (const io::ShownSinogram& one : log.sinograms()) {
    const std::string name = fs::path(one.name).filename();
    if (name.starts_with("turn-")) moment.sinograms.push_back(file("renewed/" + name));
  }
  // What was published, and is shown by now or can still be; what came too late is none.
  int turn = 0;
  double end_turn = 0;
  LogLines renewed(file("renewed.jsonl"));
  for (Json line; renewed.next(line);) {
    const auto from = static_cast<int>(number_at(line, "from_turn"));
    const std::string path = file("renewed/turn-" + std::to_string(from) + ".exr");
    const bool shown = std::find(moment.sinograms.begin(), moment.sinograms.end(), path) != moment.sinograms.end();
    if (text_at(line, "event") != "renewed" || (!shown && turn_deg * from <= last->angle_deg)) continue;
    turn = shown ? 0 : from;
    end_turn = number_at(line, "end");
  }
  if (end_turn > 0 && moment.from_turn >= end_turn)
    hold("the print ends before turn " + std::to_string(moment.from_turn));
  expect(moment, turn, log);
  moment.before = report_before(file("renewed"));
  return moment;
}

// The log of flips as it will be: images go on from angle to angle, from that turn on (0: none) those of new light.
void Renewal::expect(Moment& moment, int turn, const io::FlipLog& log) const {
  if (turn == 0) return;
  const std::string stem = file("renewed/turn-" + std::to_string(turn));
  if (!fs::exists(stem + ".exr"))
    hold("the projections of turn " + std::to_string(turn) + " are gone from " + file("renewed"));
  moment.sinograms.push_back(stem + ".exr");
  const auto& flips = log.flips();
  if (flips.size() < 2) return;
  const io::LoggedFlip& last = flips.back();
  const double step_deg = last.angle_deg - flips[flips.size() - 2].angle_deg;
  const double step_s = last.t_s - flips[flips.size() - 2].t_s;
  if (!(step_deg > 0)) return;
  device::EventLog expected(moment.flips);
  bool told = false;
  for (int n = 1; last.angle_deg + step_deg * n < turn_deg * moment.from_turn - step_deg / 4; ++n) {
    const double angle_deg = last.angle_deg + step_deg * n;
    if (!told && angle_deg > turn_deg * turn - step_deg / 4) {
      told = true;
      expected.line({{"event", "frames"},
                     {"sinogram_sha256", io::sha256_of(stem + ".exr")},
                     {"full_scale", number_at(parse_json(io::read_all(stem + ".json")), "full_scale")}});
    }
    expected.line(
        {{"event", "flip"}, {"t_monotonic_s", last.t_s + step_s * n}, {"frame", 0}, {"angle_deg", angle_deg}});
  }
}

// Of all light before a time, for each place that the axis may have; the words of vam-correct.
Words Renewal::doses(const std::string& flag, const Moment& moment, double before_s,
                     const std::vector<double>& offsets_px) const {
  Words given;
  for (std::size_t i = 0; i < offsets_px.size(); ++i) {
    const std::string dose = scratch(flag + std::to_string(i) + ".vdb");
    Words words{"vam-dose"};
    words.insert(words.end(), moment.sinograms.begin(), moment.sinograms.end());
    words.insert(words.end(), {"--shown", moment.flips, "--printer", file("printer.toml"), "--before", text(before_s),
                               "--like", options_.target, "--column-offset", text(offsets_px[i]), "-o", dose});
    attempt(words);
    given.insert(given.end(), {"--" + flag, dose});
  }
  return given;
}

// One turn: volume and log -> doses -> sensitivity -> light for the rest, from the turn at which it can be ready.
void Renewal::renew(int number) {
  begun_ = std::chrono::steady_clock::now();
  const std::string volume = file("ost/" + scatter_name(number));
  for (int n = 0; n < number; ++n) {  // noise makes no two turns the same
    const std::string earlier = scatter_name(n);
    if (fs::exists(file("ost/" + earlier)) && is_same(file("ost/" + earlier), volume))
      hold("is the volume " + earlier + " again");
  }
  Moment moment = look(number);
  Words words{
      "vam-correct", volume, "--curve", options_.curve, "--max-uncertainty", text(options_.max_uncertainty_percent)};
  std::vector<double> offsets_px{0};
  if (options_.axis_sigma_px > 0) {  // where the axis may be: three places about that which the last turn found
    const Json before = moment.before.empty() ? Json::object() : parse_json(io::read_all(moment.before));
    double middle = 0;
    double half = 2 * options_.axis_sigma_px;
    if (number_at(before, "axis_offset_sigma_px", 1) < 0.1) {
      // Close together the parabola through three doses is that of light of any detail.
      middle = number_at(before, "axis_offset_px");
      half = std::min(half, 0.5);
    }
    offsets_px = {middle - half, middle, middle + half};
    words.insert(words.end(),
                 {"--column-offset", text(half), "--axis", text(middle), "--axis-sigma", text(options_.axis_sigma_px)});
  }
  const double acted_s = moment.seen_s - turn_deg / speed_deg_s_ / 2 - delay_s_;
  for (const auto& [flag, time_s] : {std::pair{"acted", acted_s}, {"dose", moment.at_s}}) {
    const Words given = doses(flag, moment, time_s, offsets_px);
    words.insert(words.end(), given.begin(), given.end());
  }
  if (const std::string sigma = file("ost/" + numbered("uncertainty-", number, ".vdb")); fs::exists(sigma))
    words.insert(words.end(), {"--uncertainty", sigma});
  if (!moment.before.empty()) words.insert(words.end(), {"--before", moment.before});
  const std::string report = file("renewed/" + numbered("sensitivity-", number, ".json"));
  words.insert(words.end(),
               {"--sensitivity", file("renewed/sensitivity.vdb"), "--report", report, "-o", scratch("delivered.vdb")});
  attempt(words);
  const Json found = parse_json(io::read_all(report));
  // One more than full light takes where the resin is least sensitive: with none to spare there is no light to correct
  // with.
  const double rest = (planned_turns_ / number_at(found, "sensitivity_low") - moment.from_turn) * multiplier_;
  const double turns = rest <= 0 ? 1 : std::ceil(rest) + 1;
  attempt({"vam-optimize", options_.target, "--printer", file("printer.toml"), "--delivered", scratch("delivered.vdb"),
           "--init", moment.sinograms.back(), "--column-offset", text(number_at(found, "axis_offset_px")), "--turns",
           text(turns), "--iterations", std::to_string(options_.iterations), "-o", scratch("light.exr"), "--report",
           scratch("light.json")});
  publish(moment.from_turn);
  log_("renewed", {{"volume", number},
                   {"from_turn", moment.from_turn},
                   {"turns", static_cast<int>(turns)},
                   {"end", moment.from_turn + static_cast<int>(turns)},
                   {"sensitivity", number_at(found, "sensitivity_mean")},
                   {"seconds", elapsed_s()}});
}

// A turn too late it would be the wrong light.
void Renewal::publish(int from_turn) {
  if (!options_.once) {
    io::FlipLog log(options_.run);
    log.read();
    if (log.flips().back().angle_deg >= turn_deg * from_turn) {
      lead_deg_ += 60;
      hold("late for turn " + std::to_string(from_turn));
    }
    lead_deg_ = elapsed_s() * 1.3 * speed_deg_s_ + 20;
  }
  const std::string name = "turn-" + std::to_string(from_turn);
  for (const std::string ending : {".json", ".exr"}) {  // vam-project takes what is whole
    const std::string part = file("renewed/." + name + ending);
    fs::copy_file(scratch("light" + ending), part, replace);
    fs::rename(part, file("renewed/" + name + ending));
  }
}

}  // namespace vam::correct_tool
