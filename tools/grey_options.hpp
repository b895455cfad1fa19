// SPDX-License-Identifier: GPL-3.0-or-later
// How a dose is judged against a target that is a dose for every voxel.
#pragma once

#include <string>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "score/grey_score.hpp"

namespace vam::tool {

struct GreyChoice {
  bool is_target = false;
  std::string void_rule = "met";
  std::string band_volume;
  score::GreyOptions how;

  /// The circle and the unit are not known yet. Throws Fault::usage for a band of a void that has another rule.
  [[nodiscard]] score::GreyOptions options() const {
    if (how.void_band && void_rule != "met")
      throw Error{Fault::usage, "--void " + void_rule + ": stands for --void-band; omit it"};
    score::GreyOptions chosen = how;
    chosen.void_rule = void_rule == "met"     ? score::VoidRule::met
                       : void_rule == "below" ? score::VoidRule::below
                                              : score::VoidRule::free;
    return chosen;
  }
};

inline void add_grey_target(cli::App& app, GreyChoice& grey) {
  app.group("Grey target");
  app.flag("--grey-target", grey.is_target,
           "The target specifies a relative dose for every voxel, to be met within --band.");
  app.option("--band", "EPSILON", grey.how.band, cli::non_negative, "Maximum deviation of the dose from the target.")
      .needs({"--grey-target"});
  app.choice("--void", grey.void_rule, {"met", "below", "free"},
             "Void, where the target is 0: must be 0 within --band (met) or not exceed --dose-low (below), or is not "
             "scored (free).")
      .needs({"--grey-target"});
  app.option("--dose-low", "DOSE", grey.how.void_limit, cli::non_negative,
             "LOW: upper bound on the dose of the void with --void below.")
      .needs({"--grey-target"});
  app.option("--void-band", "EPSILON", grey.how.void_band, cli::non_negative, "--band in the void with --void met.")
      .needs({"--grey-target"});
  app.default_is("--band");
  app.option("--band-volume", "FILE", grey.band_volume,
             "Volume (VDB) with a grid 'tolerance', or with a single grid: --band for each voxel.")
      .reads()
      .needs({"--grey-target"});
  app.default_is("the grid 'tolerance' of the target file, if present");
}

}  // namespace vam::tool
