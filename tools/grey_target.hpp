// SPDX-License-Identifier: GPL-3.0-or-later
// A target that is a dose for every voxel is not taken for coverage in silence.
#pragma once

#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/vdb.hpp"
#include "model/grey_share.hpp"

namespace vam::tool {

/// Warns where a target that is taken as coverage looks like doses, and returns whether it does. remedy: ends the
/// warning.
inline bool warn_of_grey(const io::SparseVolume& target, const std::string& path,
                         const std::string& remedy = "--grey-target takes the target as the dose of every voxel") {
  const double share = model::grey_share(target.grid(), [&](int k, float* out) { target.read_slices(k, 1, out); });
  if (share < model::least_grey_share) return false;
  warn(io::input_name(path) +
       ": the target is grey, or its voxels are too coarse for it: " + format_number(100 * share, 2) +
       " % of its voxels above 0 are between 0 and 1 and no surface, and are taken for surface that nothing is asked "
       "of; " +
       remedy);
  return true;
}

/// --grey-target judges doses. Throws Fault::data for one whose projections were made for a response of the resin.
inline void require_linear(const io::SparseVolume& dose, const std::string& file) {
  const auto response = dose.metadata.find("vam:response");
  if (response == dose.metadata.end()) return;
  throw Error{Fault::data, io::input_name(file) + ": its projections were made for the response " +
                               excerpt(response->second) +
                               " of the resin, and doses are judged here; see the report of vam-optimize, or use "
                               "--resin-response linear there"};
}

/// What a target's 1 is in the unit of the dose: a target prescribes relative doses unless it states otherwise.
inline double grey_unit(const io::SparseVolume& target, const io::SparseVolume& dose, const std::string& file) {
  const std::string relative = "relative";
  if (dose.units == target.units) return 1;
  const auto unit = dose_unit_mj_cm3(dose.metadata);
  if (target.units == relative && unit && *unit > 0) return *unit;
  if (dose.units == relative || target.units != relative) {
    throw Error{Fault::data, io::input_name(file) + ": is in " + dose.units + ", but the target is in " + target.units +
                                 "; make both in mJ/cm3: set resin.critical_dose_mj_cm3 and resin.absorption_per_mm in "
                                 "vam-dose, whose dose is of one turn without --exposure-plan or --shown"};
  }
  throw Error{Fault::data, io::input_name(file) + ": is in " + dose.units +
                               ", but the target prescribes relative doses; compute the dose from the projections of "
                               "vam-optimize --grey-target with vam-dose"};
}

}  // namespace vam::tool
