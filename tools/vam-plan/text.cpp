// SPDX-License-Identifier: GPL-3.0-or-later
// A plan as a table, and as JSON.
#include "base/text/text.hpp"

#include <algorithm>

#include "base/text/json.hpp"
#include "solid/voxel/placement.hpp"
#include "solid/voxel/trapped_resin.hpp"
#include "solid/voxel/wall.hpp"
#include "vam-plan/plan.hpp"

namespace vam::plan_tool {

namespace {

std::string number(double value) { return format_number(value, 3); }

std::string row(const std::string& name, const std::string& value) {
  constexpr std::size_t width = 18;
  return name + std::string(width - std::min(width, name.size()), ' ') + " " + value + "\n";
}

std::string fit_words(const Fit& fit) {
  const std::string room = "a cylinder of " + number(2 * fit.writable_radius_mm) + " mm diameter, " +
                           number(fit.writable_height_mm) + " mm high, can be written";
  return (fit.fits() ? "yes: " : "no: ") + room;
}

/// Relative to the largest dose.
double window(const optimize::Printed& printed) { return printed.figures.pw / printed.figures.max_dose; }

/// The smaller window of both signs.
double worst_window(const optimize::Single& single) { return std::min(window(single.minus), window(single.plus)); }

/// "axis +-0.5 px"
std::string deviation_name(std::size_t tolerance, double expected) {
  const model::Tolerance& of = model::tolerance_table[tolerance];
  return std::string(of.name) + (of.one_way ? " " : " +-") + format_number(expected, 3) +
         (of.unit.empty() ? "" : " " + std::string(of.unit));
}

std::string signed_number(double value) { return (value >= 0 ? "+" : "") + number(value); }

/// The fewest angles with hardly a smaller window than most of them.
int angles_needed(const Estimate& estimate) {
  constexpr double same = 0.01;  // of the largest dose
  const auto& all = estimate.by_angles;
  return std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.second > all.back().second - same; })
      ->first;
}

std::string angles_words(const Estimate& estimate) {
  std::string text = "--angles " + std::to_string(angles_needed(estimate)) + ": process window";
  for (const auto& [angles, pw] : estimate.by_angles)
    text += " " + signed_number(pw) + " with " + std::to_string(angles) +
            (angles == estimate.by_angles.back().first ? "" : ",");
  return text + ", as the stage turns while a frame is shown; computing takes as long as there are angles";
}

std::string duration_words(const Estimate& estimate) {
  if (!estimate.resin_known) return "not known; set resin.critical_dose_mj_cm3 and resin.absorption_per_mm";
  if (!estimate.exposure) return "not known: the part gets no light in the estimate";
  return number(estimate.exposure->seconds) + " s in " + format_number(estimate.exposure->turns) +
         (estimate.exposure->turns == 1 ? " turn" : " turns") + ", brightest pixel " +
         number(estimate.exposure->peak_intensity_mw_cm2) + " mW/cm2";
}

std::string estimate_rows(const Estimate& estimate) {
  std::string text = row("verdict", estimate.verdict.words);
  for (const std::string& doubt : estimate.too_coarse) text += row("  too coarse", doubt);
  if (estimate.iterations == 0) return text;
  text += row("estimate", "voxels of " + number(estimate.voxel_mm) + " mm, " + std::to_string(estimate.angles) +
                              " angles, " + std::to_string(estimate.iterations) + " iterations");
  if (const auto& wrong = estimate.wrong) {
    text += row("  wrong voxels", "z = " + number(wrong->low_mm) + " to " + number(wrong->high_mm) + " mm, most at " +
                                      number(wrong->worst_mm) + " mm");
  }
  for (const auto& single : estimate.trials.singles)
    text += row("  " + deviation_name(single.tolerance, estimate.trials.tolerances[single.tolerance]),
                "process window " + signed_number(worst_window(single)));
  text += row("  what ends it", words_of_ends(estimate.trials, !estimate.fails).substr(2));
  if (!estimate.by_angles.empty()) text += row("angles", angles_words(estimate));
  return text + row("duration", duration_words(estimate));
}

void append_json(Json& json, const Estimate& estimate) {
  json["estimate_voxel_mm"] = estimate.voxel_mm;
  if (estimate.iterations > 0) {
    json["iterations"] = estimate.iterations;
    json["angles"] = estimate.angles;
    json["latitude"] = estimate.verdict.print.whole.latitude;
    json["ver"] = estimate.verdict.print.whole.ver;
    json["pw"] = estimate.verdict.print.whole.pw;
  }
  append_json(json, estimate.verdict);
  if (const auto& wrong = estimate.wrong)
    json["wrong"] = {{"low_mm", wrong->low_mm}, {"high_mm", wrong->high_mm}, {"worst_mm", wrong->worst_mm}};
  for (const auto& single : estimate.trials.singles) {
    const std::string name(model::tolerance_table[single.tolerance].name);
    json["pw_deviating"][name] = worst_window(single);
    if (single.ends_at != 0 && !estimate.fails) json["ends_at"][name] = single.ends_at;
  }
  for (const auto& [angles, pw] : estimate.by_angles) json["pw_by_angles"][std::to_string(angles)] = pw;
  if (!estimate.by_angles.empty()) json["angles_needed"] = angles_needed(estimate);
  if (estimate.exposure) score::append_json(json, *estimate.exposure);
}

std::string wall_words(const Plan& plan) {
  const auto voxels = [](double count, double mm) {
    return number(count) + (count == 1 ? " voxel (" : " voxels (") + number(mm) + " mm)";
  };
  if (!plan.wall_voxels) {
    return "below " + voxels(plan.wall_resolution, plan.wall_resolution * plan.grid.voxel_mm) +
           ": enlarge the part, or use smaller pixels";
  }
  return voxels(*plan.wall_voxels, plan.wall_mm) +
         (*plan.wall_voxels < solid::least_printed_voxels ? "; walls below 3 voxels may not print" : "");
}

/// A strut, or what else is thinner than nearly all walls.
std::string place_row(const Plan& plan) {
  const auto& place = plan.thinnest_place;
  if (!place) return "";
  const auto& at = place->at_mm;
  return row("  thinnest place", number(place->voxels) + (place->voxels == 1 ? " voxel (" : " voxels (") +
                                     number(place->mm) + " mm) at x, y, z = " + number(at[0]) + ", " + number(at[1]) +
                                     ", " + number(at[2]) + " mm" +
                                     (place->voxels < solid::least_printed_voxels ? "; it may not print" : ""));
}

double cavity_voxel_mm(const Plan& plan) { return plan.wall_resolution * plan.grid.voxel_mm; }

Json fit_json(const Fit& fit) {
  Json json;
  json["fits"] = fit.fits();
  json["scale_that_fits"] = fit.factor;
  json["writable_radius_mm"] = fit.writable_radius_mm;
  json["writable_height_mm"] = fit.writable_height_mm;
  return json;
}

}  // namespace

std::string table(const Plan& plan) {
  const auto& size = plan.now.size_mm;
  std::string text =
      row("part", plan.subject + ": " + number(size[0]) + " x " + number(size[1]) + " x " + number(size[2]) + " mm");
  text += row("fits", fit_words(plan.now));
  if (!plan.now.fits())
    text += row("scale needed", "--scale " + format_number(plan.scale, 6) + "; what follows is of that size");
  if (plan.bath) {
    const std::string needed = plan.bath->fits()
                                   ? "the part fits"
                                   : "--scale " + number(solid::three_digits(plan.given_scale * plan.bath->factor));
    text += row("index bath", "a bath of the resin's index widens it to " + number(2 * plan.bath->writable_radius_mm) +
                                  " mm: " + needed);
  }
  text += row("slices", std::to_string(plan.grid.nz) + " of " + number(plan.grid.voxel_mm / plan.stretch_z) + " mm");
  text += row("thinnest wall", wall_words(plan)) + place_row(plan);
  const std::string trapped = solid::trapped_resin(plan.cavities, cavity_voxel_mm(plan), plan.stretch_z);
  if (!trapped.empty()) text += row("trapped resin", trapped);
  if (plan.sharp_edges)
    text += row("sharp edges", "some, or tips, taper to less than 3 voxels, and may not print there");
  return plan.estimate ? text + estimate_rows(*plan.estimate) : text;
}

Json report(const Plan& plan) {
  Json json = fit_json(plan.now);
  json["size_mm"] = plan.now.size_mm;
  json["scale"] = plan.scale;
  if (plan.bath) json["index_bath"] = fit_json(*plan.bath);
  json["slices"] = plan.grid.nz;
  json["voxel_mm"] = plan.grid.voxel_mm;
  if (plan.wall_voxels) {
    json["thinnest_wall_voxels"] = *plan.wall_voxels;
    json["thinnest_wall_mm"] = plan.wall_mm;
    if (plan.thinnest_place) {
      json["thinnest_place_voxels"] = plan.thinnest_place->voxels;
      json["thinnest_place_mm"] = plan.thinnest_place->mm;
      json["thinnest_place_at_mm"] = plan.thinnest_place->at_mm;
    }
  }
  json["sharp_edges"] = plan.sharp_edges;
  json["trapped_resin"] = solid::trapped_resin_figures(plan.cavities, cavity_voxel_mm(plan), plan.stretch_z);
  if (plan.estimate) append_json(json, *plan.estimate);
  return json;
}

}  // namespace vam::plan_tool
