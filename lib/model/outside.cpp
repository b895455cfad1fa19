#include "model/outside.hpp"

#include "base/json.hpp"

namespace vam::model {

void add_to(Json& report, const Outside& outside) {
  report["outside_voxels"] = outside.voxels;
  report["outside_gelled_voxels"] = outside.gelled_voxels;
  report["outside_max_dose"] = outside.max_dose;
}

}  // namespace vam::model
