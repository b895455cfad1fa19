#include "metrology/ost/run_out.hpp"

#include <cmath>

#include "base/json.hpp"

namespace vam::metrology {

double RunOut::size_mm() const { return std::hypot(mm[0], mm[1]); }

double RunOut::size_sigma_mm() const {
  const double size = size_mm();
  if (size == 0) return std::hypot(sigma_mm[0], sigma_mm[1]) / std::sqrt(2.0);
  return std::hypot(mm[0] * sigma_mm[0], mm[1] * sigma_mm[1]) / size;
}

bool RunOut::seen() const { return determined && size_mm() > 3 * size_sigma_mm(); }

Json to_json(const RunOut& found) {
  if (!found.determined) return nullptr;
  return {{"x_mm", found.mm[0]},
          {"y_mm", found.mm[1]},
          {"x_sigma_mm", found.sigma_mm[0]},
          {"y_sigma_mm", found.sigma_mm[1]},
          {"size_mm", found.size_mm()},
          {"size_sigma_mm", found.size_sigma_mm()},
          {"removed", found.seen()}};
}

}  // namespace vam::metrology
