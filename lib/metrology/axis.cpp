#include "metrology/axis.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"

namespace vam::metrology {

namespace {

struct Centre {
  double column = 0;
  double weight = 0;  // 1 / variance; 0 when the row says nothing
};

float linear_at(const float* row, int width, double x) {
  const double at = std::clamp(x, 0.0, width - 1.0);
  const int low = std::min(static_cast<int>(at), width - 2);
  const auto f = static_cast<float>(at - low);
  return (1 - f) * row[low] + f * row[low + 1];
}

// Mass centre of what stands above the row's median: a start for the symmetry search.
double start_column(const float* row, int width) {
  std::vector<float> sorted(row, row + width);
  std::nth_element(sorted.begin(), sorted.begin() + width / 2, sorted.end());
  const float floor = sorted[static_cast<std::size_t>(width / 2)];
  double mass = 0;
  double moment = 0;
  for (int x = 0; x < width; ++x) {
    const auto above = static_cast<double>(std::max(0.0F, row[x] - floor));
    mass += above;
    moment += above * x;
  }
  return mass > 0 ? moment / mass : 0.5 * (width - 1);
}

// Gauss-Newton on E(c) = sum over x > 0 of (M(c + x) - M(c - x))^2, over the x that stay inside the image.
Centre symmetry_centre(const float* row, int width, double start) {
  constexpr int max_steps = 30;
  constexpr double small = 1e-4;
  Centre centre{start, 0};
  for (int step = 0; step < max_steps; ++step) {
    const double reach = std::min(centre.column - 1, width - 2 - centre.column);
    if (reach < 8) return {centre.column, 0};
    double gg = 0;
    double gr = 0;
    double rr = 0;
    int count = 0;
    for (double x = 0.5; x < reach; x += 1, ++count) {
      const auto m = [&](double at) { return static_cast<double>(linear_at(row, width, at)); };
      const double right = centre.column + x;
      const double left = centre.column - x;
      const double r = m(right) - m(left);
      const double g = 0.5 * (m(right + 1) - m(right - 1)) - 0.5 * (m(left + 1) - m(left - 1));
      gg += g * g;
      gr += g * r;
      rr += r * r;
    }
    if (!(gg > 0)) return {centre.column, 0};
    const double move = std::clamp(-gr / gg, -5.0, 5.0);
    centre.column += move;
    centre.weight = gg / (rr / count + 1e-12 * gg);
    if (std::abs(move) < small) return centre;
  }
  return {centre.column, 0};
}

struct Line {
  double at_middle = 0;
  double slope = 0;
  double sigma_middle = 0;
  double sigma_slope = 0;
  int rows = 0;
};

// Weighted least squares; rows farther than 4 robust deviations from the line are dropped once.
Line fit_line(const std::vector<Centre>& centres) {
  const double middle = 0.5 * (static_cast<double>(centres.size()) - 1);
  std::vector<bool> use(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) use[i] = centres[i].weight > 0;
  Line line;
  for (int pass = 0; pass < 3; ++pass) {
    double s = 0, sy = 0, syy = 0, sc = 0, syc = 0;
    line.rows = 0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      if (!use[i]) continue;
      const double w = centres[i].weight;
      const double y = static_cast<double>(i) - middle;
      s += w, sy += w * y, syy += w * y * y, sc += w * centres[i].column, syc += w * y * centres[i].column;
      ++line.rows;
    }
    const double determinant = s * syy - sy * sy;
    if (line.rows < 3 || !(determinant > 0)) return {0, 0, 0, 0, 0};
    line.at_middle = (syy * sc - sy * syc) / determinant;
    line.slope = (s * syc - sy * sc) / determinant;
    double chi2 = 0;
    std::vector<double> deviations;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      if (!use[i]) continue;
      const double d = centres[i].column - line.at_middle - line.slope * (static_cast<double>(i) - middle);
      chi2 += centres[i].weight * d * d;
      deviations.push_back(std::abs(d));
    }
    const double scale = chi2 / std::max(1, line.rows - 2);  // weights are relative; the scatter sets the scale
    line.sigma_middle = std::sqrt(scale * syy / determinant);
    line.sigma_slope = std::sqrt(scale * s / determinant);
    std::nth_element(deviations.begin(), deviations.begin() + line.rows / 2, deviations.end());
    const double limit = 4 * 1.4826 * deviations[static_cast<std::size_t>(line.rows / 2)] + 1e-6;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      const double d = centres[i].column - line.at_middle - line.slope * (static_cast<double>(i) - middle);
      if (std::abs(d) > limit) use[i] = false;
    }
  }
  return line;
}

}  // namespace

AxisEstimate find_axis(const Image& mean_view) {
  AxisEstimate estimate;
  estimate.pose.column = 0.5 * (mean_view.width - 1);
  constexpr int rounds = 4;  // a row of a leaning image is symmetric only once the image is straight
  for (int round = 0; round < rounds; ++round) {
    const Image image = straightened(mean_view, estimate.pose);
    std::vector<Centre> centres(static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y) {
      centres[static_cast<std::size_t>(y)] =
          symmetry_centre(image.row(y), image.width, start_column(image.row(y), image.width));
    }
    const Line line = fit_line(centres);
    if (line.rows == 0) {
      throw Error{Fault::data, "views: no rotation axis found, the mean view of " + std::to_string(image.width) +
                                   " x " + std::to_string(image.height) +
                                   " pixels has no contrast that is symmetric about a column"};
    }
    estimate.pose.column = line.at_middle;
    estimate.pose.tilt_rad += std::atan(line.slope);
    estimate.column_sigma = line.sigma_middle;
    estimate.tilt_sigma_rad = line.sigma_slope;
    estimate.rows = line.rows;
  }
  return estimate;
}

}  // namespace vam::metrology
