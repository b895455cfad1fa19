// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/figures.hpp"

#include <limits>
#include <utility>

namespace vam::model {

namespace {
using Entry = std::pair<std::string, double DoseMetrics::*>;
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{{"latitude", &DoseMetrics::latitude},
                                      {"ver", &DoseMetrics::ver},
                                      {"pw", &DoseMetrics::pw},
                                      {"ipdr", &DoseMetrics::ipdr},
                                      {"cv", &DoseMetrics::cv},
                                      {"iou", &DoseMetrics::iou},
                                      {"threshold", &DoseMetrics::iou_threshold},
                                      {"min_part", &DoseMetrics::min_part},
                                      {"max_part", &DoseMetrics::max_part},
                                      {"mean_part", &DoseMetrics::mean_part},
                                      {"max_void", &DoseMetrics::max_void},
                                      {"max_dose", &DoseMetrics::max_dose}};
  return all;
}
}  // namespace

const std::vector<std::string>& figure_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : entries()) list.push_back(entry.first);
    return list;
  }();
  return names;
}

double figure(const DoseMetrics& metrics, const std::string& name) {
  for (const auto& [known, member] : entries()) {
    if (known == name) return metrics.*member;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace vam::model
