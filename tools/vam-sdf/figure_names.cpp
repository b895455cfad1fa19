// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

namespace {

const std::vector<std::pair<std::string, std::string>>& figure_places() {
  static const std::vector<std::pair<std::string, std::string>> all{
      {"rms", "/print_to_design/rms_mm"},   {"trimmed", "/print_to_design/trimmed_rms_mm"},
      {"mean", "/print_to_design/mean_mm"}, {"sigma", "/print_to_design/sigma_mm"},
      {"mad", "/print_to_design/mad_mm"},   {"max", "/print_to_design/max_abs_mm"},
      {"hausdorff", "/hausdorff_mm"},       {"rms_percent", "/print_to_design/rms_percent"},
      {"within", "/within_percent"}};
  return all;
}

}  // namespace

std::vector<std::string> figure_names(const std::vector<metrology::Region>& regions) {
  std::vector<std::string> names;
  for (const auto& [name, place] : figure_places()) names.push_back(name);
  for (const auto& region : regions) {
    for (const std::string& name : metrology::region_figures(region.kind)) names.push_back(region.name + "." + name);
  }
  return names;
}

std::string place_of(const std::string& name) {
  for (const auto& [known, place] : figure_places()) {
    if (known == name) return place;
  }
  const auto dot = name.find('.');
  const std::string figure = name.substr(dot + 1);
  const std::string unit = figure == "within" ? "_percent" : figure == "tilt" ? "_deg" : "_mm";
  return "/regions/" + name.substr(0, dot) + "/" + figure + unit;
}

}  // namespace vam::sdf_tool
