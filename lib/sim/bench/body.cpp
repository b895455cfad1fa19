// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/body.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::sim {

namespace {

// One key=value of a body; false when it is none.
bool set_key(SimBody& body, bool cylinder, const std::string& pair) {
  const std::size_t equals = pair.find('=');
  if (equals == std::string::npos) return false;
  const double value = parse_number(pair.substr(equals + 1)).value_or(NAN);
  const std::string key = pair.substr(0, equals);
  if (!std::isfinite(value)) return false;
  const std::map<std::string, double*> places{{"x", &body.x_mm}, {"y", &body.y_mm}, {"z", &body.z_mm}};
  if (const auto place = places.find(key); place != places.end()) {
    *place->second = value;
    return true;
  }
  if (value <= 0) return false;
  if (key == "diameter") body.radius_mm = 0.5 * value;
  if (key == "height") body.height_mm = value;
  return key == "diameter" || (key == "height" && cylinder);
}

}  // namespace

std::vector<SimBody> parse_bodies(const std::string& text) {
  std::vector<SimBody> bodies;
  for (const auto& one : split(text, ';')) {
    const std::size_t colon = std::min(one.find(':'), one.size());
    const std::string kind = one.substr(0, colon);
    SimBody body;
    if (kind == "cylinder") body.height_mm = 4;
    bool good = kind == "sphere" || kind == "cylinder";
    for (const auto& pair : split(colon == one.size() ? "" : one.substr(colon + 1), ',')) {
      good = good && set_key(body, kind == "cylinder", pair);
    }
    if (!good) {
      throw Error{Fault::usage,
                  "part '" + one + "': expected a form like sphere:x=2,diameter=4 or cylinder:diameter=6,height=3"};
    }
    bodies.push_back(body);
  }
  return bodies;
}

double chord_mm(const SimBody& body, double growth, double z_mm, double distance_mm) {
  const double radius = body.radius_mm * growth;
  double square = radius * radius - distance_mm * distance_mm;
  if (body.height_mm > 0) {
    if (std::abs(z_mm - body.z_mm) > 0.5 * body.height_mm) return 0;
  } else {
    square -= (z_mm - body.z_mm) * (z_mm - body.z_mm);
  }
  return square > 0 ? 2 * std::sqrt(square) : 0;
}

}  // namespace vam::sim
