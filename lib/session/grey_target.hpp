// SPDX-License-Identifier: GPL-3.0-or-later
// A target that is a dose for every voxel: its options, and the dose that is judged against it.
#pragma once

#include <string>
#include <vector>

#include "cli/app.hpp"
#include "io/vdb/vdb.hpp"
#include "score/grey_score.hpp"

namespace vam::session {

struct GreyChoice {
  bool is_target = false;
  std::string void_rule = "met";
  std::string band_volume;
  score::GreyOptions how;

  /// The circle and the unit are not known yet.
  [[nodiscard]] score::GreyOptions options() const;
};

/// not_beside: options that such a target has no use for.
void add_grey_target(cli::App& app, GreyChoice& grey, const std::vector<std::string>& not_beside,
                     const std::vector<std::string>& not_for = {}, const std::vector<std::string>& unjudged = {});

/// Warns where a target that is taken as coverage looks like doses. remedy: ends the warning.
void warn_of_grey(const io::SparseVolume& target, const std::string& path,
                  const std::string& remedy = "--grey-target takes the target as the dose of every voxel");

/// --grey-target judges doses. Throws Fault::data for one whose projections were made for a response of the resin.
void require_linear(const io::SparseVolume& dose, const std::string& file);

/// What a target's 1 is in the unit of the dose: a target prescribes relative doses unless it states otherwise.
[[nodiscard]] double grey_unit(const io::SparseVolume& target, const io::SparseVolume& dose, const std::string& file);

}  // namespace vam::session
