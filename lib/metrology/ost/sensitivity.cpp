// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/sensitivity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/json.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "metrology/ost/cured.hpp"

namespace vam::metrology {

namespace {

constexpr int terms = SensitivityField::terms;
constexpr int numbers = SensitivityField::numbers;
using Vector = Eigen::Matrix<double, numbers, 1>;
using Matrix = Eigen::Matrix<double, numbers, numbers>;

constexpr double least_dose = 0.3;    // of the critical one: with less nothing is in question
constexpr double together = 27;       // voxels whose noise is one, over which rays are interpolated and filtered
constexpr double least_sigma = 0.03;  // of the saturation: what the noise does not contain, as streaks and kinetics
// Of the saturation: densities beyond tell no more than that they are, as the tails of the curve are not the resin's.
constexpr double hardly = 0.1;
constexpr double nearly = 0.9;
constexpr int steps = 12;
constexpr double certain = 1e-6;  // px: an axis that is where it is
constexpr double settled = 1e-4;  // of the logarithm

Vector vector_of(const SensitivityField::Terms& value, double axis_px) {
  Vector vector;
  for (int t = 0; t < terms; ++t) vector[t] = value[t];
  vector[terms] = axis_px;
  return vector;
}
void put(const Vector& vector, SensitivityField& field) {
  for (int t = 0; t < terms; ++t) field.value[t] = vector[t];
  field.axis_px = vector[terms];
}
Matrix matrix_of(const std::vector<double>& covariance) { return Eigen::Map<const Matrix>(covariance.data()); }

void put_covariance(const Matrix& covariance, SensitivityField& field) {
  field.covariance.assign(covariance.data(), covariance.data() + covariance.size());
}

/// The voxels that the fit looks at: a box of the scattering volume.
struct Sight {
  model::Grid grid;
  std::array<int, 3> first{};            // in the scattering volume
  std::vector<float> density, weight;    // over the saturation, and one over its variance
  std::vector<std::vector<float>> dose;  // one, or three by the place of the axis
};

// Box of the voxels whose dose ended above `least`, by the scattering volume's indices.
Sight sight_of(const model::Volume& scatter, const model::Volume* sigma, const ActedDose& dose,
               const ScatterCurve& curve, int margin) {
  const model::Grid& g = scatter.grid;
  const auto dose_at = [&](const model::Volume& volume, int i, int j, int k) {
    return value_at(volume, g.x_mm(i), g.y_mm(j), g.z_mm(k) * dose.stretch_z);
  };
  const auto least = static_cast<float>(least_dose * curve.critical_dose_mj_cm3);
  std::vector<std::array<int, 6>> of_slice(g.nz, {g.nx, g.ny, g.nz, 0, 0, 0});
  parallel_for(g.nz, [&](int k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        if (dose_at(dose.dose.middle(), i, j, k) < least) continue;
        auto& box = of_slice[k];
        box = {std::min(box[0], i), std::min(box[1], j), k, std::max(box[3], i + 1), std::max(box[4], j + 1), k + 1};
      }
    }
  });
  std::array<int, 6> box{g.nx, g.ny, g.nz, 0, 0, 0};
  for (const auto& one : of_slice) {
    for (int a = 0; a < 3; ++a) {
      box[a] = std::min(box[a], one[a]);
      box[a + 3] = std::max(box[a + 3], one[a + 3]);
    }
  }
  if (box[3] <= box[0]) {
    throw Error{Fault::data, "no voxel of the scattering volume has received a third of the critical dose"};
  }
  const std::array<int, 3> size{g.nx, g.ny, g.nz};
  Sight sight;
  for (int a = 0; a < 3; ++a) {
    sight.first[a] = std::max(0, box[a] - margin);
    box[a + 3] = std::min(size[a], box[a + 3] + margin);
  }
  sight.grid = {box[3] - sight.first[0],
                box[4] - sight.first[1],
                box[5] - sight.first[2],
                g.voxel_mm,
                {g.x_mm(sight.first[0]), g.y_mm(sight.first[1]), g.z_mm(sight.first[2])}};
  const std::size_t n = sight.grid.size();
  for (auto* values : {&sight.density, &sight.weight}) values->resize(n);
  sight.dose.assign(dose.dose.at.size(), std::vector<float>(n));
  const auto one_over = static_cast<float>(1 / curve.saturation);
  parallel_for(sight.grid.nz, [&](int k) {
    std::size_t v = product(k, sight.grid.slice_size());
    for (int j = 0; j < sight.grid.ny; ++j) {
      for (int i = 0; i < sight.grid.nx; ++i, ++v) {
        const int at[3] = {i + sight.first[0], j + sight.first[1], k + sight.first[2]};
        const std::size_t from = flat_index(at[1], g.nx, at[0]);
        sight.density[v] = one_over * scatter.slice(at[2])[from];
        const double noise = sigma != nullptr ? static_cast<double>(one_over * sigma->slice(at[2])[from]) : 0;
        sight.weight[v] = static_cast<float>(1 / (together * (noise * noise + least_sigma * least_sigma)));
        for (std::size_t d = 0; d < sight.dose.size(); ++d) {
          sight.dose[d][v] = dose_at(dose.dose.at[d], at[0], at[1], at[2]);
        }
      }
    }
  });
  return sight;
}

/// Gaussian of the resolution, in place.
class Blur {
 public:
  explicit Blur(double sigma_px) : sigma_(sigma_px) {}
  void apply(const model::Grid& g, std::vector<float>& values) const {
    if (!(sigma_ > 0.1)) return;
    const auto rows = [&](int k) { return cv::Mat(g.ny, g.nx, CV_32F, values.data() + product(k, g.slice_size())); };
    parallel_for(g.nz, [&](int k) {
      cv::Mat slice = rows(k);
      cv::GaussianBlur(slice, slice, {}, sigma_, sigma_, cv::BORDER_REPLICATE);
    });
    parallel_for(g.ny, [&](int j) {
      cv::Mat plane(g.nz, g.nx, CV_32F);
      for (int k = 0; k < g.nz; ++k) rows(k).row(j).copyTo(plane.row(k));
      cv::GaussianBlur(plane, plane, {1, 0}, 0.01, sigma_, cv::BORDER_REPLICATE);
      for (int k = 0; k < g.nz; ++k) plane.row(k).copyTo(rows(k).row(j));
    });
  }

 private:
  double sigma_;
};

struct Normal {
  Matrix matrix = Matrix::Zero();
  Vector gradient = Vector::Zero();
  double cost = 0;  // sum of the squared residuals
  double squares = 0;
  long voxels = 0;
};

/// What the densities are expected to be, and their derivatives by the logarithm of the dose and by the axis.
struct Expected {
  std::vector<float> density, by_log, by_axis;
};

double mix(const std::vector<std::vector<float>>& doses, const std::array<double, 3>& weights, std::size_t v) {
  if (doses.size() == 1) return static_cast<double>(doses[0][v]);
  double sum = 0;
  for (std::size_t d = 0; d < 3; ++d) sum += weights[d] * static_cast<double>(doses[d][v]);
  return std::max(0.0, sum);
}

Expected expected_at(const Sight& sight, const ScatterCurve& curve, const ActedDose& dose,
                     const SensitivityField& field, const Blur& blur) {
  const model::Grid& g = sight.grid;
  const bool moves = sight.dose.size() > 1;
  constexpr double step = 0.05;  // of the distance between the doses
  const double step_px = step * dose.dose.offset_px;
  Expected expected{std::vector<float>(g.size()), std::vector<float>(g.size()),
                    std::vector<float>(moves ? g.size() : 0)};
  const auto weights = dose.dose.weights(field.axis_px);
  const auto low = dose.dose.weights(field.axis_px - step_px);
  const auto high = dose.dose.weights(field.axis_px + step_px);
  parallel_for(g.nz, [&](int k) {
    std::size_t v = product(k, g.slice_size());
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i, ++v) {
        const double s = std::exp(field.log_at(g.x_mm(i), g.y_mm(j), g.z_mm(k) * dose.stretch_z));
        const auto acting = [&](const std::array<double, 3>& by) { return s * mix(sight.dose, by, v); };
        const double acts = acting(weights);
        const double density = curve.density(acts);
        expected.density[v] = static_cast<float>(density);
        expected.by_log[v] = static_cast<float>(density * (1 - density) * acts / curve.width_mj_cm3);
        if (!moves) continue;
        const double change = curve.density(acting(high)) - curve.density(acting(low));
        expected.by_axis[v] = static_cast<float>(change / (2 * step_px));
      }
    }
  });
  blur.apply(g, expected.density);
  blur.apply(g, expected.by_log);
  if (moves) blur.apply(g, expected.by_axis);
  return expected;
}

/// Residuals and their derivatives at a field.
Normal normal_at(const Sight& sight, const ScatterCurve& curve, const ActedDose& dose, const SensitivityField& field,
                 const Blur& blur) {
  const model::Grid& g = sight.grid;
  const Expected expected = expected_at(sight, curve, dose, field, blur);
  std::vector<Normal> of_slice(g.nz);
  parallel_for(g.nz, [&](int k) {
    Normal& sum = of_slice[k];
    std::size_t v = product(k, g.slice_size());
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i, ++v) {
        const double seen = std::clamp(static_cast<double>(sight.density[v]), hardly, nearly);
        const double should = std::clamp(static_cast<double>(expected.density[v]), hardly, nearly);
        const double residual = seen - should;
        const auto weight = static_cast<double>(sight.weight[v]);
        if ((seen == hardly && should == hardly) || (seen == nearly && should == nearly)) continue;
        sum.cost += weight * residual * residual;
        sum.squares += residual * residual;
        sum.voxels += 1;
        if (should == hardly || should == nearly) continue;  // it has no slope
        Vector by = static_cast<double>(expected.by_log[v]) *
                    vector_of(field.basis(g.x_mm(i), g.y_mm(j), g.z_mm(k) * dose.stretch_z), 0);
        if (!expected.by_axis.empty()) by[terms] = static_cast<double>(expected.by_axis[v]);
        sum.matrix.noalias() += weight * by * by.transpose();
        sum.gradient += weight * residual * by;
      }
    }
  });
  Normal all;
  for (const Normal& one : of_slice) {
    all.matrix += one.matrix;
    all.gradient += one.gradient;
    all.cost += one.cost;
    all.squares += one.squares;
    all.voxels += one.voxels;
  }
  return all;
}

struct Attempt {
  Vector value;
  Normal normal;
  double cost = 0;  // with that of the deviation from what was known before
};

/// The best whole, over what it may be: far from the truth the densities have no slope.
template <class Try>
Vector whole_first(const Vector& start, double wide, const Try& try_at) {
  Attempt best = try_at(start);
  const int count = std::max(1, floor_int(wide / std::max(0.04, wide / 8)));
  for (int n = -count; n <= count; ++n) {
    Vector other = start;
    other[0] += n * wide / count;
    const Attempt tried = try_at(other);
    if (tried.cost < best.cost) best = tried;
  }
  return best.value;
}

/// Gauss-Newton, as long a step as the cost falls by.
template <class Try>
Attempt descend(Attempt best, const Vector& expected, const Matrix& precision, const Try& try_at) {
  for (int step = 0; step < steps; ++step) {
    const Vector move =
        (best.normal.matrix + precision).ldlt().solve(best.normal.gradient - precision * (best.value - expected));
    double part = 1;
    Attempt tried = try_at(best.value + move);
    while (tried.cost >= best.cost && part > 0.05) tried = try_at(best.value + (part *= 0.5) * move);
    if (tried.cost >= best.cost) break;
    best = tried;
    if (part * move.cwiseAbs().maxCoeff() < settled) break;
  }
  return best;
}

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
  for (int t = 0; t < terms; ++t) sum += at[t] * value[t];
  return sum;
}

double SensitivityField::sigma_at(double x_mm, double y_mm, double z_mm) const {
  const Vector at = vector_of(basis(x_mm, y_mm, z_mm), 0);
  return std::sqrt(std::max(0.0, at.dot(matrix_of(covariance) * at)));
}

double SensitivityField::axis_sigma_px() const { return std::sqrt(covariance.back()); }

std::array<double, 3> PlannedDose::weights(double axis_px) const {
  const double t = axis_px / offset_px;
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
  std::array<double, 3> low{1e30, 1e30, 1e30};
  std::array<double, 3> high{-1e30, -1e30, -1e30};
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        if (static_cast<double>(dose.slice(k)[flat_index(j, g.nx, i)]) < 0.5 * curve.critical_dose_mj_cm3) continue;
        const std::array<double, 3> at{g.x_mm(i), g.y_mm(j), g.z_mm(k)};
        for (int a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], at[a]);
          high[a] = std::max(high[a], at[a]);
        }
      }
    }
  }
  if (low[0] > high[0]) throw Error{Fault::data, "no voxel has received half of the critical dose"};
  SensitivityField field;
  for (int a = 0; a < 3; ++a) {
    field.centre_mm[a] = 0.5 * (low[a] + high[a]);
    field.half_mm[a] = std::max(g.voxel_mm, 0.5 * (high[a] - low[a]));
  }
  Matrix covariance = Matrix::Identity() * prior.term * prior.term;
  const double critical = curve.critical_sigma_mj_cm3 / curve.critical_dose_mj_cm3;
  covariance(0, 0) = prior.whole * prior.whole + critical * critical;
  covariance(terms, terms) = std::max(prior.axis_px * prior.axis_px, certain * certain);
  put_covariance(covariance, field);
  return field;
}

SensitivityField carried_on(SensitivityField field, const SensitivityPrior& prior) {
  for (int t = 0; t < terms; ++t) field.covariance[t * numbers + t] += prior.drift * prior.drift;
  return field;
}

SensitivityFit fit_sensitivity(const model::Volume& scatter, const model::Volume* sigma, const ActedDose& dose,
                               const ScatterCurve& curve, const SensitivityField& before, double resolution_mm) {
  const double sigma_px = resolution_mm / scatter.grid.voxel_mm;
  const Blur blur(sigma_px);
  const Sight sight = sight_of(scatter, sigma, dose, curve, ceil_int(3 * sigma_px));
  const Matrix precision = matrix_of(before.covariance).inverse();
  const Vector expected = vector_of(before.value, before.axis_px);
  SensitivityField field = before;
  const auto try_at = [&](const Vector& value) {
    put(value, field);
    Attempt attempt{value, normal_at(sight, curve, dose, field, blur), 0};
    attempt.cost = attempt.normal.cost + (value - expected).dot(precision * (value - expected));
    return attempt;
  };
  const double nothing = try_at(expected).normal.squares;
  std::optional<Attempt> best;
  // The dose hardly changes with a small displacement of the axis, and much the same to either side: from both.
  const double aside = before.axis_sigma_px() > 2 * certain ? dose.dose.offset_px : 0;
  for (const double axis : aside > 0 ? std::vector<double>{0, -aside, aside} : std::vector<double>{0}) {
    Vector start = best ? best->value : expected;
    start[terms] = expected[terms] + axis;
    if (!best) start = whole_first(start, 3 * std::sqrt(before.covariance[0]), try_at);
    const Attempt found = descend(try_at(start), expected, precision, try_at);
    if (!best || found.cost < best->cost) best = found;
  }
  SensitivityFit fit;
  put(best->value, field);
  const Normal& normal = best->normal;
  fit.rms = normal.voxels > 0 ? std::sqrt(normal.cost * together / static_cast<double>(normal.voxels)) : 0;
  // Residuals that are larger than their sigmas are of a model that is wrong by as much.
  const Matrix covariance = (normal.matrix / std::max(1.0, fit.rms * fit.rms) + precision).inverse();
  put_covariance(covariance, field);
  fit.field = field;
  fit.voxels = normal.voxels;
  fit.explained = nothing > 0 ? std::sqrt(normal.squares / nothing) : 1;
  return fit;
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
                                const CorrectionLimits& limits) {
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
  if (count_of(field.covariance) != numbers * numbers) {
    throw Error{Fault::data, "its covariance is not of eleven numbers"};
  }
  const bool sized = std::all_of(field.half_mm.begin(), field.half_mm.end(), [](double half) { return half > 0; });
  if (!sized || matrix_of(field.covariance).llt().info() != Eigen::Success) {
    throw Error{Fault::data, "its box or covariance is none"};
  }
  return field;
}

}  // namespace vam::metrology
