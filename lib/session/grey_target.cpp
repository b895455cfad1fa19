// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/grey_target.hpp"

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "model/dose/grey_share.hpp"
#include "model/metadata.hpp"

namespace vam::session {

score::GreyOptions GreyChoice::options() const {
  score::GreyOptions chosen = how;
  chosen.void_rule = void_rule == "met"     ? score::VoidRule::met
                     : void_rule == "below" ? score::VoidRule::below
                                            : score::VoidRule::free;
  return chosen;
}

void add_grey_target(cli::App& app, GreyChoice& grey, const std::vector<std::string>& not_beside,
                     const std::vector<std::string>& not_for, const std::vector<std::string>& unjudged) {
  const std::string heading = "Grey target";
  app.group(heading, {}, not_for);
  app.flag("--grey-target", grey.is_target,
           "The target specifies a relative dose for every voxel, to be met within --band.");
  if (!not_beside.empty()) app.excludes(not_beside);
  app.group(heading, {"--grey-target"}, unjudged);
  app.option("--band", "EPSILON", grey.how.band, cli::non_negative, "Maximum deviation of the dose from the target.");
  app.choice("--void", grey.void_rule, {"met", "below", "free"},
             "Void, where the target is 0: must be 0 within --band (met) or not exceed --dose-low (below), or is not "
             "scored (free).");
  app.option("--dose-low", "DOSE", grey.how.void_limit, cli::non_negative, "LOW: upper bound on the dose of the void.")
      .only_with({"--void below"});
  app.option("--void-band", "EPSILON", grey.how.void_band, cli::non_negative, "--band in the void.")
      .only_with({"--void met"});
  app.default_is("--band");
  app.option("--band-volume", "FILE", grey.band_volume,
             "Volume (VDB) with a grid 'tolerance', or with a single grid: --band for each voxel.")
      .reads();
  app.default_is("the grid 'tolerance' of the target file, if present");
}

void warn_of_grey(const io::SparseVolume& target, const std::string& path, const std::string& remedy) {
  const double share = model::grey_share(target.grid(), [&](int k, float* out) { target.read_slices(k, 1, out); });
  if (share < model::least_grey_share) return;
  warn(io::input_name(path) +
       ": the target is grey, or its voxels are too coarse for it: " + format_number(100 * share, 2) +
       " % of its voxels above 0 are between 0 and 1 and no surface, and are taken for surface that nothing is asked "
       "of; " +
       remedy);
}

void require_linear(const io::SparseVolume& dose, const std::string& file) {
  const auto response = dose.metadata.find("vam:response");
  if (response == dose.metadata.end()) return;
  throw Error{Fault::data, io::input_name(file) + ": its projections were made for the response " +
                               excerpt(response->second) +
                               " of the resin, and doses are judged here; see the report of vam-optimize, or use "
                               "--resin-response linear there"};
}

double grey_unit(const io::SparseVolume& target, const io::SparseVolume& dose, const std::string& file) {
  const std::string relative = "relative";
  if (dose.units == target.units) return 1;
  const auto unit = model::dose_unit_mj_cm3(dose.metadata);
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

}  // namespace vam::session
