// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/limited_by.hpp"

#include <vector>

#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::optimize {

namespace {

struct Limitation {
  const char* what;
  double SliceDemand::*value;
  bool least;  // the least decides, not the largest
  const char* reason;
};

constexpr Limitation kinds[] = {
    {"peak", &SliceDemand::peak, false, "the brightest pixel, which is shown at full grey and determines the duration"},
    {"part", &SliceDemand::min_part, true, "the least dose of the part, which the threshold must not exceed"},
    {"void", &SliceDemand::max_void, false, "the largest dose of the void, which the threshold must exceed"}};

}  // namespace

Json limited_by(std::span<const SliceDemand> demands, const std::function<double(int k)>& height_mm) {
  Json list = Json::array();
  for (const Limitation& kind : kinds) {
    std::vector<double> values;
    int at = -1;
    for (int k = 0; k < count_of(demands); ++k) {
      const double value = demands[k].*kind.value;
      if (value < 0 || (kind.value == &SliceDemand::peak && value == 0)) continue;
      values.push_back(value);
      const double now = at < 0 ? value : demands[at].*kind.value;
      if (at < 0 || (kind.least ? value < now : value > now)) at = k;
    }
    if (at < 0) continue;
    const double value = demands[at].*kind.value;
    const double middle = stats::median(values);
    list.push_back({{"what", kind.what},
                    {"z_mm", height_mm(at)},
                    {"value", value},
                    {"median", middle},
                    {"why", "the slice at z = " + format_number(height_mm(at), 4) + " mm has " + kind.reason + ": " +
                                format_number(value, 3) + " (median slice " + format_number(middle, 3) + ")"}});
  }
  return list;
}

}  // namespace vam::optimize
