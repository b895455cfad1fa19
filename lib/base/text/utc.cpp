// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/utc.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>

#include "base/error.hpp"
#include "base/index.hpp"

namespace vam {

double utc_seconds() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string utc_text(double utc_s) {
  const auto total_ms = static_cast<std::int64_t>(std::llround(1000 * utc_s));
  const auto whole = static_cast<std::time_t>(std::floor(static_cast<double>(total_ms) / 1000));
  tm parts{};
  gmtime_r(&whole, &parts);
  std::array<char, 32> day{};
  std::strftime(day.data(), day.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  const int ms = static_cast<int>(total_ms - 1000 * whole);
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s.%03dZ", day.data(), ms);
  return text.data();
}

double parse_utc(const std::string& text, const std::string& subject) {
  tm parts{};
  int ms = 0;
  int read = 0;
  const int fields = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d.%3dZ%n", &parts.tm_year, &parts.tm_mon,
                                 &parts.tm_mday, &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &ms, &read);
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  const double utc_s = static_cast<double>(timegm(&parts)) + 1e-3 * ms;
  if (fields != 7 || read != count_of(text) || utc_text(utc_s) != text) {  // there is no day 99
    throw Error{Fault::data, subject + ": '" + text + "' is not a time like 2026-11-21T16:58:00.123Z"};
  }
  return utc_s;
}

}  // namespace vam
