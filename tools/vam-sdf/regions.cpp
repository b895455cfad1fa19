// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "session/surface.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

namespace {

std::vector<metrology::Region> read_faces(const Options& options) {
  std::vector<metrology::Region> regions;
  for (const std::string& text : options.regions) {
    regions.push_back(metrology::parse_region(text));
    metrology::Region& region = regions.back();
    const auto same = [&](const auto& other) { return other.name == region.name; };
    if (std::count_if(regions.begin(), regions.end(), same) > 1) {
      throw Error{Fault::usage, "--region " + text + ": a region of this name is given already"};
    }
    if (region.faces_file.empty()) continue;
    region.faces = std::make_shared<solid::Surface>(session::read_surface(region.faces_file, options.design_isovalue));
  }
  return regions;
}

/// The target of a tolerance "0.05" or "top=0.05".
std::optional<double>& place_for(const std::string& text, Toleranced& all) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) return all.tolerance_mm;
  const std::string name = text.substr(0, equals);
  const auto found =
      std::find_if(all.regions.begin(), all.regions.end(), [&](const auto& region) { return region.name == name; });
  if (found == all.regions.end()) {
    throw Error{Fault::usage, "--tolerance " + text + ": '" + name + "' is not a name that --region gives"};
  }
  return found->tolerance_mm;
}

}  // namespace

Toleranced read_regions(const Options& options) {
  Toleranced all;
  all.regions = read_faces(options);
  for (const std::string& text : options.tolerances) {
    std::optional<double>& tolerance_mm = place_for(text, all);
    if (tolerance_mm) throw Error{Fault::usage, "--tolerance " + text + ": is given already"};
    tolerance_mm = parse_number(text.substr(text.find('=') + 1));  // npos + 1 is 0
    if (!tolerance_mm || !std::isfinite(*tolerance_mm) || *tolerance_mm <= 0) {
      throw Error{Fault::usage, "--tolerance " + text + ": must be more than 0 mm, e.g. 0.05 or top=0.05"};
    }
  }
  for (metrology::Region& region : all.regions) {
    if (!region.tolerance_mm) region.tolerance_mm = all.tolerance_mm;
  }
  return all;
}

}  // namespace vam::sdf_tool
