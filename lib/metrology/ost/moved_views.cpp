// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/moved_views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "base/compute/parallel.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/specks.hpp"

namespace vam::metrology {

namespace {

// An edge must not be sharper than what the views sample between their angles: beside the axis it moves by
// pi columns / views from one to the next.
double blur_of(const std::vector<Image>& level) {
  constexpr double part = 0.5;  // of that
  return std::max(1.5, part * std::numbers::pi * level.front().width / static_cast<double>(level.size()));
}

void blur_columns(std::vector<Image>& level) {
  const double sigma = blur_of(level);
  const int taps = 2 * ceil_int(3 * sigma) + 1;
  parallel_for(count_of(level), [&](int i) {
    cv::Mat pixels(level[i].height, level[i].width, CV_32F, level[i].values.data());
    cv::GaussianBlur(pixels, pixels, {taps, 1}, sigma, sigma, cv::BORDER_REPLICATE);
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

// Gain of each ray if the light were not absorbed, mu per column: mu M, M the integral of u rho along it. As
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

// Removes the part of the gain that is common to all rays of an angle, the median over the heights: views that were
// divided by their intensities do not have it.
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
  RayMask hidden = grown(speck_rays(sinograms), width, count_of(sinograms), ceil_int(2 * blur_px));
  mark_too(other_ends(hidden, width), hidden);
  return hidden;
}

std::vector<ColumnMotion> motion_of(const PairVector& p, const PairBasis& basis) {
  std::vector<ColumnMotion> motion(basis.motion[0].size());
  for (int i = 0; i < pair_motions; ++i) {
    for (std::size_t v = 0; v < motion.size(); ++v) {
      motion[v].shift_px += p[i] * basis.motion[i][v].shift_px;
      motion[v].stretch += p[i] * basis.motion[i][v].stretch;
    }
  }
  return motion;
}

bool is_near(const PairVector& value, const PairVector& other) {
  constexpr double near_px = 0.1;  // of edges that are blurred by more than one
  double most = 0;
  for (int i = 0; i < pair_motions; ++i) most = std::max(most, std::abs(value[i] - other[i]));
  return most <= near_px;
}

}  // namespace

MovedViews::MovedViews(const std::vector<Image>& level, const PairBasis& basis, const SinogramsOf& sinograms_of)
    : basis_(basis),
      sinograms_of_(sinograms_of),
      blurred_(level),
      hidden_(hidden_lines(sinograms_of(level), blur_of(level))) {
  blur_columns(blurred_);
  blurred_ = along_parallel_lines(blurred_, basis, blur_of(blurred_));
}

Lines MovedViews::lines(const PairVector& value) const {
  Lines made;
  made.hidden = hidden_;
  move(value, made);
  return made;
}

void MovedViews::move(const PairVector& value, Lines& lines) const {
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

}  // namespace vam::metrology
