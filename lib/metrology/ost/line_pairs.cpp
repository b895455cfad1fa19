// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/line_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/stats/measured.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/ray_mask.hpp"
#include "metrology/ost/private/specks.hpp"

namespace vam::metrology {

namespace {

constexpr int unknowns = pair_unknowns;
constexpr int angle_ranges = 24;
constexpr int offset_ranges = 12;

using Vector = PairVector;
using Matrix = cv::Matx<double, unknowns, unknowns>;

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
    std::vector<float> padded(image.width + 2 * reach);
    for (int k = 0; k < image.height; ++k) {
      float* row = image.row(k);
      std::fill_n(padded.begin(), reach, row[0]);
      std::copy_n(row, image.width, padded.begin() + reach);
      std::fill_n(padded.end() - reach, reach, row[image.width - 1]);
      std::fill_n(row, image.width, 0.0F);
      for (int j = 0; j <= 2 * reach; ++j) {
        for (int x = 0; x < image.width; ++x) row[x] += kernel[j] * padded[x + j];
      }
    }
  });
}

// Neighbouring columns see lines of other directions, by `lean` a column: a blur along the columns is wider before the
// axis than behind it, or the other way round, and draws edges there, so that the two ends of a line do not see it
// alike. Gives columns what a blur along parallel lines has, to the first order in their lean: less lean sigma^2 d2/(dx
// dphi).
std::vector<Image> along_parallel_lines(const std::vector<Image>& blurred, const PairBasis& basis, double sigma) {
  constexpr double widest_rad = 0.5;  // between the views before and after
  constexpr double least_rad = 1e-3;
  const auto views = count_of(blurred);
  std::vector<Image> out = blurred;
  parallel_for(views, [&](int i) {
    const int before = (i + views - 1) % views;
    const int after = (i + 1) % views;
    const double turned = std::remainder(basis.angle_rad[after] - basis.angle_rad[before], 2 * std::numbers::pi);
    if (std::abs(turned) < least_rad || std::abs(turned) > widest_rad) return;
    const int width = out[i].width;
    std::vector<float> factor(width);
    for (int x = 0; x < width; ++x) factor[x] = static_cast<float>(basis.lean[x] * sigma * sigma / (2 * turned));
    for (int k = 0; k < out[i].height; ++k) {
      const float* low = blurred[before].row(k);
      const float* high = blurred[after].row(k);
      float* to = out[i].row(k);
      for (int x = 1; x + 1 < width; ++x)
        to[x] -= factor[x] * ((high[x + 1] - high[x - 1]) - (low[x + 1] - low[x - 1]));
    }
  });
  return out;
}

// Slopes along the columns, times the motion that one unit makes.
std::vector<Image> slopes(const std::vector<Image>& level, const std::vector<ColumnMotion>& motion,
                          double axis_column) {
  std::vector<Image> out(level.size());
  parallel_for(count_of(level), [&](int i) {
    const Image& in = level[i];
    out[i] = Image(in.width, in.height);
    std::vector<float> half(in.width);
    for (int x = 0; x < in.width; ++x) half[x] = static_cast<float>(0.5 * motion[i].at(x - axis_column));
    for (int k = 0; k < in.height; ++k) {
      const float* from = in.row(k);
      float* to = out[i].row(k);
      for (int x = 1; x + 1 < in.width; ++x) to[x] = half[x] * (from[x + 1] - from[x - 1]);
    }
  });
  return out;
}

// The lines of an angle, seen from both of their ends.
class LineEnds {
 public:
  LineEnds(const Image& s, int angle)
      : near_(s.row(angle)), far_(s.row((angle + s.height / 2) % s.height) + s.width - 1) {}
  /// What the line of offset t shows from this end less what it shows from the other.
  [[nodiscard]] double difference(int t) const { return static_cast<double>(near_[t]) - static_cast<double>(far_[-t]); }

 private:
  const float* near_;
  const float* far_;
};

// What each ray would gain if the light were not absorbed, mu per column: mu M, M the integral of u rho along it. As
// dP/dtheta = -dM/dt, the views hold it: P is the mean of both ends of a line, and the integral over t is the mean of
// those from either side.
Image absorbed(const Image& s) {
  constexpr int around = 2;  // angles, of the derivative
  const int n = s.height;
  const auto line = [&](int t, int a) {
    const int row = (a + n) % n;
    return 0.5 * (static_cast<double>(s(t, row)) + static_cast<double>(s(s.width - 1 - t, (row + n / 2) % n)));
  };
  Image out(s.width, n);
  std::vector<double> sum(s.width + 1);
  for (int a = 0; a < n; ++a) {
    for (int t = 0; t < s.width; ++t) {
      sum[t + 1] = sum[t] - (line(t, a + around) - line(t, a - around)) * n / (4 * std::numbers::pi * around);
    }
    for (int t = 0; t < s.width; ++t) out(t, a) = static_cast<float>(0.5 * (sum[t] + sum[t + 1] - sum[s.width]));
  }
  return out;
}

/// All that a fit needs of the views after some motion.
struct Lines {
  std::vector<Image> now;
  std::array<std::vector<Image>, unknowns> by;  // one unit of each unknown
  Vector by_at{};                               // the motion after which those are
  RayMask hidden;                               // by specks at either end, [height][column]

  [[nodiscard]] bool is_seen(int k, int t) const { return hidden[product(k, now.front().width) + t] == 0; }
};

struct Sums {
  Matrix normal{};
  Vector right{};
  std::array<std::array<Vector, offset_ranges>, angle_ranges> by_both{};
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

// Of the first `count` unknowns; the others stay.
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

// Variances by how much ranges of lines, `merged` of them together, disagree: those of angle, and those of offset, as
// structures that turn with the part err alike over a whole range. Both, less what both count; wider where few of the
// narrow ones pull.
Vector variances(const Sums& sums, const Matrix& inverse, int merged) {
  std::array<Vector, offset_ranges> by_offset{};
  std::array<std::vector<double>, unknowns> single;
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
      Vector alone{};
      add(cell, alone);
      for (int i = 0; i < unknowns; ++i) {
        both[i] += alone[i];
        single[i].push_back(alone[i]);
      }
    }
    add(of_angle, angle);
  }
  for (const Vector& of_offset : by_offset) add(of_offset, offset);
  Vector out{};
  for (int i = 0; i < unknowns; ++i) {
    const double all = std::max({angle[i] + offset[i] - both[i], angle[i], offset[i]});
    out[i] = merged == 1 ? std::pow(stats::few_parts_factor(single[i]), 2) * all : all;
  }
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
  struct Line {
    double sight;
    double difference;
  };
  std::vector<std::vector<Line>> heights(lines.now.size());
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
  double sum = 0;
  std::size_t count = 0;
  for (const auto& height : heights) {
    for (const Line& line : height) sum += line.sight;
    count += height.size();
  }
  std::vector<double> out;
  for (const auto& height : heights) {
    for (const auto& [sight, difference] : height) {
      if (sight * static_cast<double>(count) >= sum) out.push_back(difference);
    }
  }
  return out;
}

// Their mean, each counted up to a few times the usual one: what is in single lines hardly counts.
double usual_difference(const std::vector<double>& differences, double most) {
  double sum = 0;
  for (const double d : differences) sum += std::min(d, most);
  return sum / static_cast<double>(std::max<std::size_t>(1, differences.size()));
}

// What views lack that were divided by their intensities: what absorption takes from all rays of an angle alike, the
// median over the heights.
void leave_even_light(const std::vector<Image>& sinograms, std::vector<Image>& gain) {
  parallel_for(gain.front().height, [&](int a) {
    std::vector<double> shares;
    for (std::size_t k = 0; k < gain.size(); ++k) {
      const auto total = [&](const Image& s) { return std::accumulate(s.row(a), s.row(a) + s.width, 0.0); };
      const double light = total(sinograms[k]);
      if (light > 0) shares.push_back(total(gain[k]) / light);
    }
    if (shares.empty()) return;
    const auto share = static_cast<float>(stats::median(shares));
    for (std::size_t k = 0; k < gain.size(); ++k) {
      for (int t = 0; t < gain[k].width; ++t) gain[k](t, a) -= share * sinograms[k](t, a);
    }
  });
}

// Gives the rays back what is absorbed by so much per column.
void restore(Lines& lines, double by_absorption, bool even_light) {
  auto& gain = lines.by[pair_motions];
  gain.resize(lines.now.size());
  parallel_for(count_of(lines.now), [&](int k) { gain[k] = absorbed(lines.now[k]); });
  if (even_light) leave_even_light(lines.now, gain);
  if (by_absorption == 0) return;
  parallel_for(count_of(lines.now), [&](int k) {
    Image& s = lines.now[k];
    for (std::size_t i = 0; i < s.size(); ++i) s.values[i] += static_cast<float>(by_absorption) * gain[k].values[i];
  });
}

// Lines of which an end is behind a speck, or so near that the blur brings some of it there.
RayMask hidden_lines(const std::vector<Image>& sinograms, double blur_px) {
  const int width = sinograms.front().width;
  const RayMask specks = grown(speck_rays(sinograms), width, count_of(sinograms), ceil_int(2 * blur_px));
  RayMask hidden = specks;
  for (std::size_t row = 0; row < hidden.size(); row += static_cast<std::size_t>(width)) {
    for (int t = 0; t < width; ++t) hidden[row + t] = specks[row + t] | specks[row + width - 1 - t];
  }
  return hidden;
}

std::vector<ColumnMotion> motion_of(const Vector& p, const PairBasis& basis) {
  std::vector<ColumnMotion> motion(basis.motion[0].size());
  for (int i = 0; i < pair_motions; ++i) {
    for (std::size_t v = 0; v < motion.size(); ++v) {
      motion[v].shift_px += p[i] * basis.motion[i][v].shift_px;
      motion[v].stretch += p[i] * basis.motion[i][v].stretch;
    }
  }
  return motion;
}

/// The views of a fit, blurred, and their lines after a motion.
class MovedViews {
 public:
  MovedViews(const std::vector<Image>& level, const PairBasis& basis, const SinogramsOf& sinograms_of)
      : basis_(basis),
        sinograms_of_(sinograms_of),
        blurred_(level),
        hidden_(hidden_lines(sinograms_of(level), blur_of(level))) {
    blur_columns(blurred_);
    blurred_ = along_parallel_lines(blurred_, basis, blur_of(blurred_));
  }
  [[nodiscard]] Lines lines(const Vector& value) const {
    Lines made;
    made.hidden = hidden_;
    move(value, made);
    return made;
  }
  /// What one unit of a motion makes is kept while the motion is nearly that after which it was found.
  void move(const Vector& value, Lines& lines) const {
    std::vector<Image> moved = blurred_;
    undo_motion(moved, motion_of(value, basis_), basis_.axis_column);
    lines.now = sinograms_of_(moved);
    if (lines.by.front().empty() || !is_near(value, lines.by_at)) {
      for (int i = 0; i < pair_motions; ++i) {
        lines.by[i] = sinograms_of_(slopes(moved, basis_.motion[i], basis_.axis_column));
      }
      lines.by_at = value;
    }
    restore(lines, value[pair_motions], basis_.even_light);
  }

 private:
  static bool is_near(const Vector& value, const Vector& other) {
    constexpr double near_px = 0.1;  // of edges that are blurred by more than one
    double most = 0;
    for (int i = 0; i < pair_motions; ++i) most = std::max(most, std::abs(value[i] - other[i]));
    return most <= near_px;
  }

  const PairBasis& basis_;
  const SinogramsOf& sinograms_of_;
  std::vector<Image> blurred_;
  RayMask hidden_;
};

}  // namespace

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
    if (!fit.converged) bound = 2.5 * stats::median(edge_differences(lines)) / 0.6745 + 1e-30;
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
