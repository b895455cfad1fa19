// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "metrology/cure/sensitivity.hpp"
#include "model/dose/stray_cure.hpp"
#include "model/value_at.hpp"

namespace vam::metrology {

namespace {

constexpr int terms = SensitivityField::terms;
constexpr int numbers = SensitivityField::numbers;
using Vector = Eigen::Matrix<double, numbers, 1>;
using Matrix = Eigen::Matrix<double, numbers, numbers>;

constexpr double least_dose = 0.3;        // of the critical one: with less nothing is in question
constexpr double correlated_voxels = 27;  // voxels whose noise is one, over which rays are interpolated and filtered
constexpr double least_noise = 0.03;      // of the saturation: what the noise does not contain, as streaks and kinetics
// Fractions of the saturation. Densities beyond are only classified, as the tails of the curve are not the resin's.
constexpr double hardly = 0.1;
constexpr double nearly = 0.9;
constexpr int steps = 12;
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
/// The voxels that the fit looks at: a box of the scattering volume.
struct Sight {
  model::Grid grid;
  std::vector<float> density, weight;    // over the saturation, and one over its variance
  std::vector<std::vector<float>> dose;  // one, or three by the place of the axis
};

// Those whose dose is above least_dose, and a margin around them.
Sight sight_of(const model::Volume& scatter, const model::Volume* sigma, const ActedDose& dose,
               const ScatterCurve& curve, int margin) {
  const model::Grid& g = scatter.grid;
  const auto dose_at = [&](const model::Volume& volume, int i, int j, int k) {
    return model::value_at(volume, g.x_mm(i), g.y_mm(j), g.z_mm(k) * dose.stretch_z);
  };
  model::Volume dose_here{g, std::vector<float>(g.size())};
  parallel_for(g.nz, [&](int k) {
    float* to = dose_here.slice(k);
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) *to++ = dose_at(dose.dose.middle(), i, j, k);
    }
  });
  const auto least = static_cast<float>(least_dose * curve.critical_dose_mj_cm3);
  model::VoxelBox box = model::covered_box(dose_here, std::nextafter(least, 0.0F));
  if (box.low[0] > box.high[0]) {
    throw Error{Fault::data, "no voxel of the scattering volume has received a third of the critical dose"};
  }
  const std::array<int, 3> size{g.nx, g.ny, g.nz};
  for (int a = 0; a < 3; ++a) {
    box.low[a] = std::max(0, box.low[a] - margin);
    box.high[a] = std::min(size[a] - 1, box.high[a] + margin);
  }
  const auto& first = box.low;
  Sight sight;
  sight.grid = {box.high[0] - first[0] + 1,
                box.high[1] - first[1] + 1,
                box.high[2] - first[2] + 1,
                g.voxel_mm,
                {g.x_mm(first[0]), g.y_mm(first[1]), g.z_mm(first[2])}};
  const std::size_t n = sight.grid.size();
  for (auto* values : {&sight.density, &sight.weight}) values->resize(n);
  sight.dose.assign(dose.dose.at.size(), std::vector<float>(n));
  const auto one_over = static_cast<float>(1 / curve.saturation);
  parallel_for(sight.grid.nz, [&](int k) {
    std::size_t v = product(k, sight.grid.slice_size());
    for (int j = 0; j < sight.grid.ny; ++j) {
      for (int i = 0; i < sight.grid.nx; ++i, ++v) {
        const int at[3] = {i + first[0], j + first[1], k + first[2]};
        const std::size_t from = flat_index(at[1], g.nx, at[0]);
        sight.density[v] = one_over * scatter.slice(at[2])[from];
        const double noise = sigma != nullptr ? static_cast<double>(one_over * sigma->slice(at[2])[from]) : 0;
        sight.weight[v] = static_cast<float>(1 / (correlated_voxels * (noise * noise + least_noise * least_noise)));
        for (std::size_t d = 0; d < sight.dose.size(); ++d) {
          sight.dose[d][v] = dose_at(dose.dose.at[d], at[0], at[1], at[2]);
        }
      }
    }
  });
  return sight;
}

/// Gaussian of the resolution, in place.
void blur(double sigma_px, const model::Grid& g, std::vector<float>& values) {
  if (!(sigma_px > 0.1)) return;
  const auto rows = [&](int k) { return cv::Mat(g.ny, g.nx, CV_32F, values.data() + product(k, g.slice_size())); };
  parallel_for(g.nz, [&](int k) {
    cv::Mat slice = rows(k);
    cv::GaussianBlur(slice, slice, {}, sigma_px, sigma_px, cv::BORDER_REPLICATE);
  });
  parallel_for(g.ny, [&](int j) {
    cv::Mat plane(g.nz, g.nx, CV_32F);
    for (int k = 0; k < g.nz; ++k) rows(k).row(j).copyTo(plane.row(k));
    cv::GaussianBlur(plane, plane, {1, 0}, 0.01, sigma_px, cv::BORDER_REPLICATE);
    for (int k = 0; k < g.nz; ++k) plane.row(k).copyTo(rows(k).row(j));
  });
}

struct Normal {
  Matrix matrix = Matrix::Zero();
  Vector gradient = Vector::Zero();
  double cost = 0;  // sum of the squared residuals
  double squares = 0;
  long voxels = 0;
};

/// Expected densities, and their derivatives by the logarithm of the dose and by the axis.
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
                     const SensitivityField& field, double blur_px) {
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
  blur(blur_px, g, expected.density);
  blur(blur_px, g, expected.by_log);
  if (moves) blur(blur_px, g, expected.by_axis);
  return expected;
}

/// Residuals and their derivatives at a field.
Normal normal_at(const Sight& sight, const ScatterCurve& curve, const ActedDose& dose, const SensitivityField& field,
                 double blur_px) {
  const model::Grid& g = sight.grid;
  const Expected expected = expected_at(sight, curve, dose, field, blur_px);
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

SensitivityFit fit_sensitivity(const model::Volume& scatter, const model::Volume* sigma, const ActedDose& dose,
                               const ScatterCurve& curve, const SensitivityField& before, double resolution_mm) {
  const double sigma_px = resolution_mm / scatter.grid.voxel_mm;
  const Sight sight = sight_of(scatter, sigma, dose, curve, ceil_int(3 * sigma_px));
  const Matrix precision = Eigen::Map<const Matrix>(before.covariance.data()).inverse();
  const Vector expected = vector_of(before.value, before.axis_px);
  SensitivityField field = before;
  const auto try_at = [&](const Vector& value) {
    put(value, field);
    Attempt attempt{value, normal_at(sight, curve, dose, field, sigma_px), 0};
    attempt.cost = attempt.normal.cost + (value - expected).dot(precision * (value - expected));
    return attempt;
  };
  const double nothing = try_at(expected).normal.squares;
  std::optional<Attempt> best;
  // The dose hardly changes with a small displacement of the axis, and much the same to either side: from both.
  const double aside = before.axis_sigma_px() > 2 * SensitivityField::certain_px ? dose.dose.offset_px : 0;
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
  fit.rms = normal.voxels > 0 ? std::sqrt(normal.cost * correlated_voxels / static_cast<double>(normal.voxels)) : 0;
  // Residuals that are larger than their sigmas are of a model that is wrong by as much.
  const Matrix covariance = (normal.matrix / std::max(1.0, fit.rms * fit.rms) + precision).inverse();
  field.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  fit.field = field;
  fit.voxels = normal.voxels;
  fit.explained = nothing > 0 ? std::sqrt(normal.squares / nothing) : 1;
  return fit;
}

}  // namespace vam::metrology
