// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/sweep.hpp"

#include <algorithm>
#include <string>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "resin/curethrough/slice_correction.hpp"

namespace vam::resin {

namespace {

void check(const std::vector<double>& values, double least, const char* name) {
  if (values.empty()) throw Error{Fault::usage, std::string(name) + ": no values; give a list or a range"};
  for (const double value : values) {
    if (!(value >= least && value > 0)) {
      throw Error{Fault::usage, std::string(name) + ": " + format_number(value) + " is out of range; give " +
                                    (least > 0 ? "at least " + format_number(least) : std::string("more than 0"))};
    }
  }
}

PartColumns column_of(const std::vector<std::uint8_t>& part, ExposureMode exposure) {
  PartColumns column(1, 1, count_of(part), exposure);
  for (int n = 0; n < count_of(part); ++n) column.fill(0, n, 1, part[n] != 0);
  return column;
}

StudyPoint judge(const std::vector<std::uint8_t>& part, const Study& study, const CureTotals& plain, double factor,
                 double omega_max) {
  StudyPoint point;
  point.dose_factor = factor;
  point.omega_max = omega_max;
  Process assumed = study.process;
  assumed.full_cure_dose_mj_cm3 = factor * study.gel_dose_mj_cm3;
  const CureLimits limits = limits_of(assumed);
  point.printable = burst_slices(limits) > 0 && limits.settled(limits.phi_min) < 1;
  if (!point.printable) return point;
  const PartColumns column = column_of(part, assumed.exposure);
  point.extra_slices = extra_slices(survey(column).last_slice, count_of(part), limits);
  SliceCorrection correction(column, limits, {omega_max}, count_of(part) + point.extra_slices);
  // The same light in units of the dose that really cures.
  const double scale = assumed.full_cure_dose_mj_cm3 / study.process.full_cure_dose_mj_cm3;
  std::vector<double> phi;
  for (Image slice; count_of(phi) < correction.slices();) {
    correction.next(slice);
    phi.push_back(scale * limits.phi_max * static_cast<double>(slice(0, 0)));
  }
  const CureTotals corrected = judge_column(part, phi, limits_of(study.process));

  const double slice_um = study.process.slice_um;
  for (std::size_t h = 1; h < plain.by_height.size(); ++h) {
    if (plain.by_height[h].features == 0) continue;
    point.sizes.push_back(
        {static_cast<int>(h), plain.by_height[h].mean() * slice_um, corrected.by_height[h].mean() * slice_um});
  }
  const double before = plain.all().mean();
  point.ratio = before > 0 ? corrected.all().mean() / before : 0;
  return point;
}

}  // namespace

std::vector<std::uint8_t> graded_ladder(const std::vector<int>& heights) {
  std::vector<std::uint8_t> part;
  for (const int height : heights) {
    part.insert(part.end(), height, std::uint8_t{0});
    part.insert(part.end(), height, std::uint8_t{1});
  }
  if (!heights.empty()) part.insert(part.end(), heights.back(), std::uint8_t{0});
  return part;
}

std::vector<double> plain_column(const std::vector<std::uint8_t>& part, const CureLimits& limits) {
  std::vector<double> phi;
  for (const std::uint8_t solid : part) phi.push_back(solid != 0 ? limits.phi_max : limits.phi_min);
  return phi;
}

std::vector<StudyPoint> run_study(const std::vector<std::uint8_t>& part, const Study& study) {
  check(study.dose_factors, 0, "df_over_dc");
  check(study.omega_max, 1, "omega_max");
  if (std::find(part.begin(), part.end(), std::uint8_t{1}) == part.end()) {
    throw Error{Fault::data, "parameter study: the part is empty"};
  }
  const CureLimits truth = limits_of(study.process);
  const CureTotals plain = judge_column(part, plain_column(part, truth), truth);
  std::vector<StudyPoint> points(study.dose_factors.size() * study.omega_max.size());
  parallel_for(count_of(points), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    points[index] = judge(part, study, plain, study.dose_factors[index / study.omega_max.size()],
                          study.omega_max[index % study.omega_max.size()]);
  });
  return points;
}

}  // namespace vam::resin
