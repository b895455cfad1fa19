// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/shown_light.hpp"

#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"

namespace vam::print_tool {

namespace {
constexpr double last_run_up_deg = -360;  // from this angle on missed blanks are counted
}

ShownLight::ShownLight(std::string run) : file_(std::move(run) + "/flips.jsonl") {}

void ShownLight::read() {
  if (broken_) return;
  try {
    if (!lines_ && !io::has_regular_file(file_)) return;
    if (!lines_) lines_.emplace(file_);
    for (Json event; lines_->next(event);) take(event);
  } catch (const Error&) {
    broken_ = true;
  }
}

void ShownLight::take(const Json& event) {
  const std::string name = text_at(event, "event");
  if (name == "frames" && event.contains("turns")) corrected_ = true;
  if (name != "flip") return;
  last_ = Flip{static_cast<int>(number_at(event, "frame", -1)), number_at(event, "t_monotonic_s"),
               number_at(event, "angle_deg")};
  if (last_->angle_deg >= last_run_up_deg) missed_ += std::lround(number_at(event, "missed"));
  if (last_->frame < 0) return;
  ++lit_;
  lit_deg_ = last_->angle_deg;
}

Json ShownLight::reached() const {
  constexpr double digits = 1e4;
  return {{"turns", std::round(lit_deg_ / 360 * digits) / digits}, {"lit_flips", lit_}, {"missed_flips", missed_}};
}

}  // namespace vam::print_tool
