// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/sensitivity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/dose/stray_cure.hpp"

namespace vam::metrology {

namespace {

using Covariance = Eigen::Map<const Eigen::Matrix<double, SensitivityField::numbers, SensitivityField::numbers>>;

double squared(double value) { return value * value; }

}  // namespace

SensitivityField::Terms SensitivityField::basis(double x_mm, double y_mm, double z_mm) const {
  const double x = (x_mm - centre_mm[0]) / half_mm[0];
  const double y = (y_mm - centre_mm[1]) / half_mm[1];
  const double z = (z_mm - centre_mm[2]) / half_mm[2];
  return {1, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z};
}

double SensitivityField::log_at(double x_mm, double y_mm, double z_mm) const {
  const Terms at = basis(x_mm, y_mm, z_mm);
  double sum = 0;
  for (int t = 0; t < SensitivityField::terms; ++t) sum += at[t] * value[t];
  return sum;
}

double SensitivityField::sigma_at(double x_mm, double y_mm, double z_mm) const {
  const Terms basis_here = basis(x_mm, y_mm, z_mm);
  const Eigen::Map<const Eigen::Matrix<double, SensitivityField::terms, 1>> at(basis_here.data());
  return std::sqrt(std::max(
      0.0,
      at.dot(Covariance(covariance.data()).topLeftCorner<SensitivityField::terms, SensitivityField::terms>() * at)));
}

double SensitivityField::axis_sigma_px() const { return std::sqrt(covariance.back()); }

std::array<double, 3> PlannedDose::weights(double axis_px) const {
  const double t = (axis_px - middle_px) / offset_px;
  return {0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)};
}

model::Volume PlannedDose::with(double axis_px) const {
  model::Volume sum = middle();
  if (at.size() == 1) return sum;
  const auto by = weights(axis_px);
  for (std::size_t v = 0; v < sum.values.size(); ++v) {
    double value = 0;
    for (std::size_t d = 0; d < 3; ++d) value += by[d] * static_cast<double>(at[d].values[v]);
    sum.values[v] = static_cast<float>(std::max(0.0, value));
  }
  return sum;
}

SensitivityField expected_sensitivity(const model::Volume& dose, const ScatterCurve& curve,
                                      const SensitivityPrior& prior) {
  const model::Grid& g = dose.grid;
  const auto half_critical = static_cast<float>(0.5 * curve.critical_dose_mj_cm3);
  const auto [low, high] = model::covered_box(dose, std::nextafter(half_critical, 0.0F));
  if (low[0] > high[0]) throw Error{Fault::data, "no voxel has received half of the critical dose"};
  SensitivityField field;
  for (int a = 0; a < 3; ++a) {
    const double first_mm = g.origin_mm[a] + g.voxel_mm * low[a];
    const double last_mm = g.origin_mm[a] + g.voxel_mm * high[a];
    field.centre_mm[a] = 0.5 * (first_mm + last_mm);
    field.half_mm[a] = std::max(g.voxel_mm, 0.5 * (last_mm - first_mm));
  }
  field.covariance.assign(product(SensitivityField::numbers, SensitivityField::numbers), 0);
  for (int t = 0; t < SensitivityField::terms; ++t)
    field.covariance[t * SensitivityField::numbers + t] = squared(prior.term);
  const double critical = curve.critical_sigma_mj_cm3 / curve.critical_dose_mj_cm3;
  field.covariance.front() = squared(prior.whole) + squared(critical);
  field.covariance.back() = squared(std::max(prior.axis_px, SensitivityField::certain_px));
  return field;
}

SensitivityField carried_on(SensitivityField field, const SensitivityPrior& prior) {
  for (int t = 0; t < SensitivityField::terms; ++t)
    field.covariance[t * SensitivityField::numbers + t] += prior.drift * prior.drift;
  return field;
}

model::Volume delivered_dose(const model::Volume& planned, const SensitivityField& field, double critical_dose_mj_cm3) {
  model::Volume dose = planned;
  const model::Grid& g = dose.grid;
  parallel_for(g.nz, [&](int k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        float& value = dose.slice(k)[flat_index(j, g.nx, i)];
        const double log_s = field.log_at(g.x_mm(i), g.y_mm(j), g.z_mm(k));
        value = std::max(0.0F, value + static_cast<float>(-critical_dose_mj_cm3 * std::expm1(-log_s)));
      }
    }
  });
  return dose;
}

SensitivityRange range_of(const SensitivityField& field, const model::Volume& dose, double critical_dose_mj_cm3) {
  const model::Grid& g = dose.grid;
  SensitivityRange range{1e30, 0, 0, 0};
  double voxels = 0;
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        if (static_cast<double>(dose.slice(k)[flat_index(j, g.nx, i)]) < 0.5 * critical_dose_mj_cm3) continue;
        const double s = std::exp(field.log_at(g.x_mm(i), g.y_mm(j), g.z_mm(k)));
        range.low = std::min(range.low, s);
        range.high = std::max(range.high, s);
        range.mean += s;
        range.sigma = std::max(range.sigma, field.sigma_at(g.x_mm(i), g.y_mm(j), g.z_mm(k)));
        voxels += 1;
      }
    }
  }
  if (voxels == 0) throw Error{Fault::data, "no voxel has received half of the critical dose"};
  range.mean /= voxels;
  return range;
}

std::vector<std::string> doubts(const SensitivityFit& fit, const SensitivityRange& range,
                                const SensitivityRange& before, const CorrectionLimits& limits) {
  const auto percent = [](double part) { return format_number(100 * part, 3) + " %"; };
  std::vector<std::string> found;
  if (!(range.sigma <= limits.sigma)) {
    found.push_back("the sensitivity is known to " + percent(range.sigma) + " only, not " + percent(limits.sigma));
  }
  if (!(std::abs(std::log(range.low)) <= limits.deviation && std::abs(std::log(range.high)) <= limits.deviation)) {
    found.push_back("the sensitivity is " + format_number(range.low, 3) + " to " + format_number(range.high, 3) +
                    ", beyond " + format_number(std::exp(-limits.deviation), 3) + " to " +
                    format_number(std::exp(limits.deviation), 3));
  }
  const double most_change = limits.change + 3 * before.sigma;
  if (!(std::abs(std::log(range.mean / before.mean)) <= most_change)) {
    found.push_back("the sensitivity is " + format_number(range.mean, 3) + ", where " + format_number(before.mean, 3) +
                    " was expected, a difference of more than " + percent(most_change));
  }
  if (!(fit.rms <= limits.rms)) {
    found.push_back("the densities differ from those of any smooth sensitivity by " + format_number(fit.rms, 3) +
                    " standard deviations (RMS), more than " + format_number(limits.rms, 3));
  }
  return found;
}

Json to_json(const SensitivityField& field) {
  return {{"centre_mm", field.centre_mm},
          {"half_mm", field.half_mm},
          {"log_terms", field.value},
          {"axis_px", field.axis_px},
          {"covariance", field.covariance}};
}

SensitivityField sensitivity_field(const Json& json) {
  SensitivityField field;
  try {
    field.centre_mm = json.at("centre_mm").get<std::array<double, 3>>();
    field.half_mm = json.at("half_mm").get<std::array<double, 3>>();
    field.value = json.at("log_terms").get<SensitivityField::Terms>();
    field.axis_px = json.at("axis_px").get<double>();
    field.covariance = json.at("covariance").get<std::vector<double>>();
  } catch (const Json::exception&) {
    throw Error{Fault::data, "has no field of vam-correct"};
  }
  if (count_of(field.covariance) != SensitivityField::numbers * SensitivityField::numbers) {
    throw Error{Fault::data,
                "its covariance is not of " + std::to_string(SensitivityField::numbers) + " numbers squared"};
  }
  const bool sized = std::all_of(field.half_mm.begin(), field.half_mm.end(), [](double half) { return half > 0; });
  if (!sized || Covariance(field.covariance.data()).llt().info() != Eigen::Success) {
    throw Error{Fault::data, "its box or covariance is none"};
  }
  return field;
}

namespace {

double positive(const Json& record, const char* key) {
  const auto found = record.find(key);
  if (found != record.end() && found->is_number() && found->get<double>() > 0) return found->get<double>();
  throw Error{Fault::data, std::string(key) + " is not a number above 0; use a record of vam-calibrate working-curve"};
}

}  // namespace

double ScatterCurve::density(double dose_mj_cm3) const {
  return 1 / (1 + std::exp((middle_mj_cm3 - dose_mj_cm3) / width_mj_cm3));
}

ScatterCurve scatter_curve(const Json& record) {
  ScatterCurve curve;
  curve.saturation = positive(record, "saturation");
  curve.width_mj_cm3 = 0.25 / positive(record, "rate_per_mj_cm3");  // the tangent's slope at D_0 is S / 4 w
  curve.critical_dose_mj_cm3 = positive(record, "critical_dose_mj_cm3");
  // At the isovalue I: D = D_0 + w ln(I / (S - I)).
  const double isovalue = positive(record, "isovalue");
  if (!(isovalue < curve.saturation)) throw Error{Fault::data, "isovalue is not below saturation; measure it again"};
  curve.middle_mj_cm3 =
      curve.critical_dose_mj_cm3 - curve.width_mj_cm3 * std::log(isovalue / (curve.saturation - isovalue));
  curve.critical_sigma_mj_cm3 = record.value("critical_dose_sigma_mj_cm3", 0.0);
  curve.delay_s = std::max(0.0, record.value("delay_s", 0.0));
  return curve;
}

}  // namespace vam::metrology
