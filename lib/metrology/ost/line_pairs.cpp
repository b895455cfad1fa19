// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/line_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/line_ranges.hpp"
#include "metrology/ost/private/moved_views.hpp"

namespace vam::metrology {

namespace {

constexpr int unknowns = pair_unknowns;
constexpr int angle_ranges = 24;
constexpr int offset_ranges = 12;

using Vector = PairVector;
using Matrix = cv::Matx<double, unknowns, unknowns>;

// The lines of an angle, seen from both of their ends.
class LineEnds {
 public:
  LineEnds(const Image& s, int angle)
      : near_(s.row(angle)), far_(s.row((angle + s.height / 2) % s.height) + s.width - 1) {}
  /// Difference of the line of offset t between this end and the other.
  [[nodiscard]] double difference(int t) const { return static_cast<double>(near_[t]) - static_cast<double>(far_[-t]); }

 private:
  const float* near_;
  const float* far_;
};

struct Sums {
  Matrix normal{};
  Vector right{};
  RangePulls<unknowns, angle_ranges, offset_ranges> by_both{};
};

// The height whose slopes stand for those of height k: near, and made of other rows, as slopes of the noise that is in
// the residuals, too, would count as knowledge.
int other_height(int k, int count) {
  constexpr int rows = 4;  // of the interpolation
  return k + rows < count ? k + rows : std::max(0, k - rows);
}

std::array<LineEnds, unknowns> ends_of(const Lines& lines, int k, int angle) {
  const auto& by = lines.by;
  return {LineEnds(by[0][k], angle), LineEnds(by[1][k], angle), LineEnds(by[2][k], angle), LineEnds(by[3][k], angle)};
}

// The lines of one height.
Sums sums_of(const Lines& lines, int k, double bound) {
  Sums sums;
  const int other = other_height(k, count_of(lines.now));
  const Image& s = lines.now[k];
  const int half = s.width / 2;
  for (int a = 0; a < s.height; ++a) {
    auto& by_offset = sums.by_both[a * angle_ranges / s.height];
    const LineEnds now(s, a);
    const auto here = ends_of(lines, k, a);
    const auto there = ends_of(lines, other, a);
    for (int t = 2; t < half; ++t) {
      if (!lines.is_seen(k, t) || !lines.is_seen(other, t)) continue;
      Vector own{};
      Vector row{};
      for (int i = 0; i < unknowns; ++i) {
        own[i] = here[i].difference(t);
        row[i] = there[i].difference(t);
      }
      const double r = now.difference(t);
      const double weight = std::min(1.0, bound / (std::abs(r) + 1e-300));
      Vector& gradient = by_offset[t * offset_ranges / half];
      for (int i = 0; i < unknowns; ++i) {
        gradient[i] += weight * row[i] * r;
        for (int j = 0; j < unknowns; ++j) sums.normal(i, j) += weight * 0.5 * (row[i] * own[j] + own[i] * row[j]);
      }
    }
  }
  return sums;
}

Sums sums_of(const Lines& lines, double bound) {
  std::vector<Sums> heights(lines.now.size());
  parallel_for(count_of(heights), [&](int k) { heights[k] = sums_of(lines, k, bound); });
  Sums all;
  for (const Sums& height : heights) {
    all.normal += height.normal;
    for (int a = 0; a < angle_ranges; ++a) {
      for (int t = 0; t < offset_ranges; ++t) {
        for (int i = 0; i < unknowns; ++i) {
          all.by_both[a][t][i] += height.by_both[a][t][i];
          all.right[i] += height.by_both[a][t][i];
        }
      }
    }
  }
  return all;
}

// Inverse over the first `count` unknowns; the others stay.
bool inverted(Matrix m, int count, Matrix& inverse) {
  double scale = 1;
  for (int i = count; i < unknowns; ++i) {
    for (int j = 0; j < unknowns; ++j) m(i, j) = m(j, i) = i == j ? 1.0 : 0.0;
  }
  for (int i = 0; i < unknowns; ++i) scale *= m(i, i);
  if (!(cv::determinant(m) > 1e-9 * scale)) return false;
  inverse = m.inv();
  for (int i = count; i < unknowns; ++i) inverse(i, i) = 0;
  return true;
}

Vector times(const Matrix& m, const Vector& v) {
  Vector out{};
  for (int i = 0; i < unknowns; ++i) {
    for (int j = 0; j < unknowns; ++j) out[i] += m(i, j) * v[j];
  }
  return out;
}

// Variances by how much ranges of lines disagree: those of angle, and those of offset, as structures that turn with the
// part err alike over a whole range. Both, less what both count; wider where few of the narrow ones pull. The largest
// of those of narrow and wide ranges: bubbles drift through many narrow ones, and err alike in all of them.
Vector variances(const Sums& sums, const Matrix& inverse) {
  Vector most{};
  for (const std::size_t merged : {1, 2, 4}) {
    const auto [angles, offsets, both, few] =
        range_moves(sums.by_both, merged, [&](const Vector& gradient) { return times(inverse, gradient); });
    for (int i = 0; i < unknowns; ++i) {
      const double all = std::max({angles[i] + offsets[i] - both[i], angles[i], offsets[i]});
      most[i] = std::max(most[i], merged == 1 ? few[i] * few[i] * all : all);
    }
  }
  return most;
}

// Differences between the ends of lines on edges, which see a motion best.
std::vector<double> edge_differences(const Lines& lines) {
  std::vector<std::vector<SeenLine>> heights(lines.now.size());
  parallel_for(count_of(heights), [&](int k) {
    const Image& s = lines.now[k];
    for (int a = 0; a < s.height; ++a) {
      const LineEnds now(s, a);
      const auto here = ends_of(lines, k, a);
      for (int t = 2; t < s.width / 2; ++t) {
        if (!lines.is_seen(k, t)) continue;
        double sight = 0;
        for (int i = 0; i < pair_motions; ++i) sight += std::pow(here[i].difference(t), 2);
        heights[k].push_back({sight, std::abs(now.difference(t))});
      }
    }
  });
  return edge_differences(heights);
}

// Their mean, each counted up to a few times the usual one: what is in single lines hardly counts.
double usual_difference(const std::vector<double>& differences, double most) {
  double sum = 0;
  for (const double d : differences) sum += std::min(d, most);
  return sum / static_cast<double>(std::max<std::size_t>(1, differences.size()));
}

}  // namespace

std::vector<double> edge_differences(const std::vector<std::vector<SeenLine>>& heights) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& lines : heights) {
    for (const SeenLine& line : lines) sum += line.sight;
    count += lines.size();
  }
  std::vector<double> out;
  for (const auto& lines : heights) {
    for (const auto& [sight, difference] : lines) {
      if (sight * static_cast<double>(count) >= sum) out.push_back(difference);
    }
  }
  return out;
}

PairFit fit_line_pairs(const std::vector<Image>& level, const PairBasis& basis, int count,
                       const SinogramsOf& sinograms_of) {
  const MovedViews views(level, basis, sinograms_of);
  PairFit fit;
  double bound = 1e300;
  constexpr int steps = 12;
  constexpr double near_px = 1e-2;      // a last step below this leaves far less
  constexpr double near_per_px = 1e-4;  // of the absorption
  constexpr double most = 300;          // of these in one step
  Lines lines = views.lines(fit.value);
  for (int step = 0; step < steps && !fit.converged; ++step) {
    if (step > 0) views.move(fit.value, lines);
    const Sums sums = sums_of(lines, bound);
    Matrix inverse{};
    if (!inverted(sums.normal, count, inverse)) return {};
    const Vector move = times(inverse, sums.right);
    const Vector variance = variances(sums, inverse);
    double farthest = 0;
    for (int i = 0; i < unknowns; ++i) {
      const double near = i < pair_motions ? near_px : near_per_px;
      fit.value[i] -= std::clamp(move[i], -most * near, most * near);
      fit.sigma[i] = std::sqrt(variance[i]);
      farthest = std::max(farthest, std::abs(move[i]) / near);
    }
    fit.converged = step > 0 && farthest < 1;
    if (!fit.converged) bound = 2.5 * stats::robust_sigma(edge_differences(lines)) + 1e-30;
  }
  return fit;
}

bool motion_explains(const std::vector<Image>& level, const PairBasis& basis, const PairVector& value,
                     const SinogramsOf& sinograms_of) {
  const MovedViews views(level, basis, sinograms_of);
  Vector unmoved{};
  unmoved[pair_motions] = value[pair_motions];
  const auto before = edge_differences(views.lines(unmoved));
  constexpr double few = 3;
  const double limit = few * stats::median(before);
  return usual_difference(edge_differences(views.lines(value)), limit) < usual_difference(before, limit);
}

}  // namespace vam::metrology
