// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/line_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

constexpr int unknowns = pair_unknowns;
constexpr int angle_ranges = 24;
constexpr int offset_ranges = 12;

using Vector = PairVector;
using Matrix = std::array<Vector, unknowns>;

// An edge must not be sharper than what the views sample between their angles: beside the axis it moves by
// pi columns / views from one to the next.
double blur_of(const std::vector<Image>& level) {
  constexpr double part = 0.5;  // of that
  return std::max(1.5, part * std::numbers::pi * level.front().width / static_cast<double>(level.size()));
}

void blur_columns(std::vector<Image>& level) {
  const double sigma = blur_of(level);
  const int reach = ceil_int(3 * sigma);
  std::vector<float> kernel;
  double sum = 0;
  for (int j = -reach; j <= reach; ++j) sum += std::exp(-0.5 * j * j / (sigma * sigma));
  for (int j = -reach; j <= reach; ++j)
    kernel.push_back(static_cast<float>(std::exp(-0.5 * j * j / (sigma * sigma)) / sum));
  parallel_for(count_of(level), [&](int i) {
    Image& image = level[i];
    const Image before = image;
    for (int k = 0; k < image.height; ++k) {
      for (int x = 0; x < image.width; ++x) {
        float value = 0;
        for (int j = -reach; j <= reach; ++j)
          value += kernel[j + reach] * before(std::clamp(x + j, 0, image.width - 1), k);
        image(x, k) = value;
      }
    }
  });
}

// Slopes along the columns, times the motion that one unit makes.
std::vector<Image> slopes(const std::vector<Image>& level, const std::vector<ColumnMotion>& motion,
                          double axis_column) {
  std::vector<Image> out(level.size());
  parallel_for(count_of(level), [&](int i) {
    const Image& in = level[i];
    out[i] = Image(in.width, in.height);
    for (int x = 1; x + 1 < in.width; ++x) {
      const auto half = static_cast<float>(0.5 * motion[i].at(x - axis_column));
      for (int k = 0; k < in.height; ++k) out[i](x, k) = half * (in(x + 1, k) - in(x - 1, k));
    }
  });
  return out;
}

// What the line of (t, a) shows from this end less what it shows from the other.
double difference(const std::vector<Image>& sinograms, int k, int t, int a) {
  const Image& s = sinograms[k];
  return static_cast<double>(s(t, a)) - static_cast<double>(s(s.width - 1 - t, (a + s.height / 2) % s.height));
}

/// All that a fit needs of the views after some motion.
struct Lines {
  std::vector<Image> now;
  std::array<std::vector<Image>, unknowns> by;  // one unit of each unknown
};

struct Sums {
  Matrix normal{};
  Vector right{};
  std::array<std::array<Vector, offset_ranges>, angle_ranges> by_both{};
  double square = 0;  // of the residuals where there is something to see
  double sight = 0;
};

// The height whose slopes stand for those of height k: near, and made of other rows, as slopes of the noise that is in
// the residuals, too, would count as knowledge.
int other_height(int k, int count) {
  constexpr int rows = 4;  // of the interpolation
  return k + rows < count ? k + rows : std::max(0, k - rows);
}

// Adds the lines of one height.
void add_height(const Lines& lines, int k, double bound, Sums& sums) {
  const auto& [now, by] = lines;
  const int other = other_height(k, count_of(now));
  const Image& s = now[k];
  const int half = s.width / 2;
  for (int a = 0; a < s.height; ++a) {
    const int angle_range = a * angle_ranges / s.height;
    for (int t = 2; t < half; ++t) {
      Vector own{};
      Vector row{};
      double sight = 0;
      for (int i = 0; i < unknowns; ++i) {
        own[i] = difference(by[i], k, t, a);
        row[i] = difference(by[i], other, t, a);
        sight += row[i] * row[i];
      }
      const double r = difference(now, k, t, a);
      const double weight = std::min(1.0, bound / (std::abs(r) + 1e-300));
      sums.square += sight * r * r;
      sums.sight += sight;
      Vector gradient{};
      for (int i = 0; i < unknowns; ++i) {
        gradient[i] = weight * row[i] * r;
        for (int j = 0; j < unknowns; ++j) sums.normal[i][j] += weight * 0.5 * (row[i] * own[j] + own[i] * row[j]);
      }
      const int offset_range = t * offset_ranges / half;
      for (int i = 0; i < unknowns; ++i) {
        sums.right[i] += gradient[i];
        sums.by_both[angle_range][offset_range][i] += gradient[i];
      }
    }
  }
}

bool inverted(const Matrix& m, Matrix& inverse) {
  const auto minor = [&](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  if (!(determinant > 1e-9 * m[0][0] * m[1][1] * m[2][2])) return false;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) inverse[c][r] = minor(r, c) / determinant;
  }
  return true;
}

Vector times(const Matrix& m, const Vector& v) {
  Vector out{};
  for (int i = 0; i < unknowns; ++i) {
    for (int j = 0; j < unknowns; ++j) out[i] += m[i][j] * v[j];
  }
  return out;
}

// Variances by how much ranges of lines, `merged` of them together, disagree: those of angle, and those of offset, as
// structures that turn with the part err alike over a whole range. Both, less what both count.
Vector variances(const Sums& sums, const Matrix& inverse, int merged) {
  std::array<Vector, offset_ranges> by_offset{};
  Vector angle{}, offset{}, both{};
  const auto add = [&](const Vector& gradient, Vector& to) {
    const Vector pull = times(inverse, gradient);
    for (int i = 0; i < unknowns; ++i) to[i] += pull[i] * pull[i];
  };
  for (int a = 0; a < angle_ranges; a += merged) {
    Vector of_angle{};
    for (int t = 0; t < offset_ranges; t += merged) {
      Vector cell{};
      for (int n = 0; n < merged * merged; ++n) {
        for (int i = 0; i < unknowns; ++i) cell[i] += sums.by_both[a + n / merged][t + n % merged][i];
      }
      for (int i = 0; i < unknowns; ++i) {
        of_angle[i] += cell[i];
        by_offset[t][i] += cell[i];
      }
      add(cell, both);
    }
    add(of_angle, angle);
  }
  for (const Vector& of_offset : by_offset) add(of_offset, offset);
  Vector out{};
  for (int i = 0; i < unknowns; ++i) out[i] = std::max({angle[i] + offset[i] - both[i], angle[i], offset[i]});
  return out;
}

// The largest of those of narrow and wide ranges: bubbles drift through many narrow ones, and err alike in all of them.
Vector variances(const Sums& sums, const Matrix& inverse) {
  Vector most{};
  for (const int merged : {1, 2, 4}) {
    const Vector now = variances(sums, inverse, merged);
    for (int i = 0; i < unknowns; ++i) most[i] = std::max(most[i], now[i]);
  }
  return most;
}

// What the lines on edges differ by between their ends, those that see a motion best.
std::vector<double> edge_differences(const Lines& lines) {
  std::vector<double> sights;
  std::vector<double> differences;
  double sum = 0;
  for (int k = 0; k < count_of(lines.now); ++k) {
    const Image& s = lines.now[k];
    for (int a = 0; a < s.height; ++a) {
      for (int t = 2; t < s.width / 2; ++t) {
        double sight = 0;
        for (const auto& by : lines.by) sight += std::pow(difference(by, k, t, a), 2);
        sights.push_back(sight);
        differences.push_back(std::abs(difference(lines.now, k, t, a)));
        sum += sight;
      }
    }
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (sights[i] * static_cast<double>(sights.size()) >= sum) out.push_back(differences[i]);
  }
  return out;
}

// Their mean, each counted up to a few times the usual one: what is in single lines hardly counts.
double usual_difference(const std::vector<double>& differences, double most) {
  double sum = 0;
  for (const double d : differences) sum += std::min(d, most);
  return sum / static_cast<double>(std::max<std::size_t>(1, differences.size()));
}

std::vector<ColumnMotion> motion_of(const Vector& p, const PairBasis& basis) {
  std::vector<ColumnMotion> motion(basis.motion[0].size());
  for (int i = 0; i < unknowns; ++i) {
    for (std::size_t v = 0; v < motion.size(); ++v) {
      motion[v].shift_px += p[i] * basis.motion[i][v].shift_px;
      motion[v].stretch += p[i] * basis.motion[i][v].stretch;
    }
  }
  return motion;
}

}  // namespace

PairFit fit_line_pairs(const std::vector<Image>& level, const PairBasis& basis,
                       const std::function<std::vector<Image>(const std::vector<Image>&)>& sinograms_of) {
  std::vector<Image> blurred = level;
  blur_columns(blurred);
  const auto lines_after = [&](const Vector& value) {
    std::vector<Image> moved = blurred;
    undo_motion(moved, motion_of(value, basis), basis.axis_column);
    Lines lines{sinograms_of(moved), {}};
    for (int i = 0; i < unknowns; ++i) {
      lines.by[i] = sinograms_of(slopes(moved, basis.motion[i], basis.axis_column));
    }
    return lines;
  };
  PairFit fit;
  std::vector<double> before;
  double bound = 1e300;
  constexpr int steps = 12;
  constexpr double near_px = 1e-2;  // a last step below this leaves far less
  for (int step = 0; step < steps && !fit.converged; ++step) {
    const Lines lines = lines_after(fit.value);
    if (step == 0) before = edge_differences(lines);
    Sums sums;
    for (int k = 0; k < count_of(lines.now); ++k) add_height(lines, k, bound, sums);
    Matrix inverse{};
    if (!inverted(sums.normal, inverse)) return {};
    const Vector move = times(inverse, sums.right);
    const Vector variance = variances(sums, inverse);
    double farthest = 0;
    for (int i = 0; i < unknowns; ++i) {
      fit.value[i] -= std::clamp(move[i], -3.0, 3.0);
      fit.sigma[i] = std::sqrt(variance[i]);
      farthest = std::max(farthest, std::abs(move[i]));
    }
    bound = 2.5 * stats::median(edge_differences(lines)) / 0.6745 + 1e-30;
    fit.converged = step > 0 && farthest < near_px;
  }
  if (!before.empty()) {
    constexpr double few = 3;
    const double most = few * stats::median(before);
    fit.explains = usual_difference(edge_differences(lines_after(fit.value)), most) < usual_difference(before, most);
  }
  return fit;
}

}  // namespace vam::metrology
