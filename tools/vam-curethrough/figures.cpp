// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and JSON of the cure map.
#include "vam-curethrough/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::curethrough {

namespace {

using Heights = std::pair<int, int>;  // from, to; in slices

// At most 20 groups of neighbouring heights that occur; the report has each by itself.
std::vector<std::pair<Heights, resin::FeatureErrors>> grouped(const std::vector<resin::FeatureErrors>& by_height) {
  const auto occurs = [](const resin::FeatureErrors& e) { return e.features > 0; };
  const auto sizes = static_cast<std::size_t>(std::count_if(by_height.begin(), by_height.end(), occurs));
  const std::size_t each = std::max<std::size_t>(1, (sizes + 19) / 20);
  std::vector<std::pair<Heights, resin::FeatureErrors>> groups;
  std::size_t taken = 0;
  for (int h = 0; h < count_of(by_height); ++h) {
    const resin::FeatureErrors& e = by_height[h];
    if (!occurs(e)) continue;
    if (taken++ % each == 0) groups.push_back({{h, h}, {}});
    auto& [heights, sum] = groups.back();
    heights.second = h;
    sum.add(e);
  }
  return groups;
}

}  // namespace

Json to_json(const resin::CureTotals& totals, const resin::Process& process) {
  const double voxel_mm3 = std::pow(process.slice_um * 1e-3, 3);
  const auto entry = [&](std::int64_t voxels) {
    return Json{{"voxels", voxels}, {"volume_mm3", static_cast<double>(voxels) * voxel_mm3}};
  };
  const auto errors = [&](const resin::FeatureErrors& e) {
    const double per = e.features > 0 ? process.slice_um / static_cast<double>(e.features) : 0;
    return Json{{"features", e.features},
                {"mean_error_um", e.mean() * process.slice_um},
                {"mean_cure_through_um", e.through * per},
                {"mean_undercured_um", e.under * per},
                {"worst_error_um", e.worst * process.slice_um}};
  };
  Json report{{"correctly_cured", entry(totals.correct)},
              {"cure_through", entry(totals.through)},
              {"undercured", entry(totals.under)},
              {"height_error", errors(totals.all())}};
  Json sizes = Json::array();
  for (std::size_t h = 0; h < totals.by_height.size(); ++h) {
    if (totals.by_height[h].features == 0) continue;
    Json size{{"height_um", static_cast<double>(h) * process.slice_um}};
    size.update(errors(totals.by_height[h]));
    sizes.push_back(size);
  }
  report["height_error_by_size"] = sizes;
  return report;
}

std::string table_of(const resin::CureTotals& totals, const resin::Process& process) {
  const double voxel_mm3 = std::pow(process.slice_um * 1e-3, 3);
  std::string text;
  char line[160];
  const auto count = [&](const char* what, std::int64_t voxels) {
    std::snprintf(line, sizeof line, "%-16s %12lld voxels %12.4f mm3\n", what, static_cast<long long>(voxels),
                  static_cast<double>(voxels) * voxel_mm3);
    text += line;
  };
  count("correctly cured", totals.correct);
  count("cure-through", totals.through);
  count("undercured", totals.under);
  text += "feature height   features   mean error  cure-through   undercured        worst  (um)\n";
  const auto errors = [&](const std::string& what, const resin::FeatureErrors& e) {
    const double per = e.features > 0 ? process.slice_um / static_cast<double>(e.features) : 0;
    std::snprintf(line, sizeof line, "%14s %10lld %12.4g %13.4g %12.4g %12.4g\n", what.c_str(),
                  static_cast<long long>(e.features), e.mean() * process.slice_um, e.through * per, e.under * per,
                  e.worst * process.slice_um);
    text += line;
  };
  for (const auto& [heights, sum] : grouped(totals.by_height)) {
    const std::string from = format_number(heights.first * process.slice_um);
    errors(heights.first == heights.second ? from : from + "-" + format_number(heights.second * process.slice_um), sum);
  }
  errors("all", totals.all());
  return text;
}

}  // namespace vam::curethrough
