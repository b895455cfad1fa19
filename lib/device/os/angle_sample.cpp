// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/angle_sample.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "base/text/format_version.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"

namespace vam::device {

std::string to_line(const AngleSample& sample, bool first) {
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), R"({"t_monotonic_s":%.7f,"angle_deg":%.5f,"sigma_deg":%.5f%s)", sample.t_s,
                sample.angle_deg, sample.sigma_deg, sample.ramp ? R"(,"ramp":true)" : "");
  return text.data() + (first ? R"(,"schema":")" + FormatKind("vam-angles").schema() + R"("})" : "}");
}

AngleSample parse_angle_line(const std::string& line, long number) {
  const Json parsed = parse_distinct(line, "stage angles: line " + std::to_string(number));
  AngleSample sample;
  const auto read = [&](const char* key, double& target) {
    if (!parsed.is_object() || !parsed.contains(key) || !parsed[key].is_number()) {
      throw Error{Fault::data, "stage angles: line " + std::to_string(number) + ": no number '" + key +
                                   "'; expected the output of vam-stage spin or follow"};
    }
    target = parsed[key].get<double>();
    if (!std::isfinite(target)) {
      throw Error{Fault::data, "stage angles: line " + std::to_string(number) + ": '" + key + "' is not finite"};
    }
  };
  read("t_monotonic_s", sample.t_s);
  read("angle_deg", sample.angle_deg);
  read("sigma_deg", sample.sigma_deg);
  sample.ramp = parsed.value("ramp", Json()) == true;
  return sample;
}

}  // namespace vam::device
