// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/response.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::resin {

bool is_dark(const Image& image, int y) {
  std::uint32_t bits = 0;
  for (const float* value = image.row(y); value != image.row(y) + image.width; ++value) {
    bits |= std::bit_cast<std::uint32_t>(*value);
  }
  return bits == 0;
}

namespace {

void require_monotone(const model::ResponseTable& table) {
  const auto& grey = table.grey;
  const auto& intensity = table.intensity;
  if (grey.size() < 2 || grey.size() != intensity.size() || grey[0] != 0 || !(intensity[0] >= 0)) {
    throw Error{Fault::data, table.source + ": a response needs at least two points and begins at grey 0"};
  }
  for (std::size_t i = 1; i < grey.size(); ++i) {
    if (!(grey[i] > grey[i - 1]) || !(intensity[i] >= intensity[i - 1]) || !std::isfinite(intensity[i])) {
      throw Error{Fault::data, table.source + ": the response falls between grey " + format_number(grey[i - 1]) +
                                   " and " + format_number(grey[i]) + "; measure again or smooth it"};
    }
  }
  if (intensity.back() <= 0) throw Error{Fault::data, table.source + ": zero intensity at full grey"};
}

// Slope at an inner point from its two secants a, b over widths h, k: their weighted harmonic mean, which keeps the
// cubic inside the monotone region ([FB84], as in PCHIP).
double inner_slope(double a, double b, double h, double k) {
  if (a * b <= 0) return 0;
  const double w1 = 2 * k + h;
  const double w2 = k + 2 * h;
  return (w1 + w2) / (w1 / a + w2 / b);
}

// Slope at an end: three-point formula, held within [0, 3 secant] so that the end segment stays monotone.
double end_slope(double a, double b, double h, double k) {
  return std::clamp(((2 * h + k) * a - h * b) / (h + k), 0.0, 3 * a);
}

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  const auto width = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / width(i); };
  if (n == 2) return {secant(0), secant(0)};
  std::vector<double> slope(n);
  for (std::size_t i = 1; i + 1 < n; ++i) slope[i] = inner_slope(secant(i - 1), secant(i), width(i - 1), width(i));
  slope[0] = end_slope(secant(0), secant(1), width(0), width(1));
  slope[n - 1] = end_slope(secant(n - 2), secant(n - 3), width(n - 2), width(n - 3));
  return slope;
}

// Index of the first of the values that is not below `value`; the values rise.
template <class T>
std::size_t first_at_least(const std::vector<T>& values, T value) {
  return std::lower_bound(values.begin(), values.end(), value) - values.begin();
}

}  // namespace

Response::Response(double dark_fraction) : grey_{0, 1}, intensity_{dark_fraction, 1}, slope_(2, 1 - dark_fraction) {}

Response::Response(const model::ResponseTable& table) : grey_(table.grey), intensity_(table.intensity) {
  require_monotone(table);
  const double full_grey = grey_.back();
  const double full_intensity = intensity_.back();
  for (double& g : grey_) g /= full_grey;
  for (double& i : intensity_) i /= full_intensity;
  slope_ = monotone_slopes(grey_, intensity_);
}

double Response::intensity(double grey) const {
  if (!(grey > 0)) return intensity_.front();
  if (grey >= 1) return 1;
  const auto above = static_cast<std::size_t>(std::upper_bound(grey_.begin(), grey_.end(), grey) - grey_.begin());
  const std::size_t below = above - 1;
  const double h = grey_[above] - grey_[below];
  const double t = (grey - grey_[below]) / h;
  const double s = 1 - t;
  // Cubic Hermite polynomial on [0, 1].
  return s * s * (1 + 2 * t) * intensity_[below] + t * t * (3 - 2 * t) * intensity_[above] +
         h * t * s * (s * slope_[below] - t * slope_[above]);
}

double Response::grey(double intensity) const {
  if (!(intensity > intensity_.front())) return 0;
  const std::size_t above = first_at_least(intensity_, std::min(intensity, 1.0));
  if (intensity >= 1) return grey_[above];
  double low = grey_[above - 1];
  double high = grey_[above];
  for (int step = 0; step < 60; ++step) {  // bisection: the segment is monotone, 2^-60 is below double precision
    const double middle = 0.5 * (low + high);
    (this->intensity(middle) < intensity ? low : high) = middle;
  }
  return high;
}

Response projector_response(const model::Projector& projector) {
  return Response(projector.min_intensity_mw_cm2 / projector.max_intensity_mw_cm2);
}

GreyLevels::GreyLevels(const Response& response, int bits) : bits_(bits) {
  if (bits < 1 || bits > 16) throw Error{Fault::usage, "bits " + std::to_string(bits) + " is not between 1 and 16"};
  const int last = (1 << bits) - 1;
  for (int level = 0; level <= last; ++level) {
    intensity_.push_back(static_cast<float>(response.intensity(static_cast<double>(level) / last)));
  }
  // The nearest level rises with the intensity: so the least float of each is found by halving what floats there are.
  float from = 0;
  for (int level = 0; level < nearest(intensity_.back()); ++level) {
    auto low = std::bit_cast<std::uint32_t>(from);
    auto high = std::bit_cast<std::uint32_t>(intensity_.back());
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      if (nearest(std::bit_cast<float>(middle)) > level) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    from = std::bit_cast<float>(low);
    least_.push_back(from);
  }
  const int steps = 4 * count();
  for (int step = 0; step <= steps; ++step) {  // one too low, for rounding
    first_.push_back(nearest(static_cast<float>(step - 1) / static_cast<float>(steps)));
  }
  int most = 1;
  for (int step = 0; step <= steps; ++step) {
    const int end = step + 3 <= steps ? first_[step + 3] : nearest(intensity_.back());
    most = std::max(most, end - first_[step]);
  }
  reach_ = std::bit_floor(static_cast<unsigned>(most));
  least_.resize(intensity_.size() + 2 * reach_, std::numeric_limits<float>::infinity());
}

int GreyLevels::nearest(float intensity) const {
  if (!(intensity > intensity_.front())) return 0;
  const std::size_t above = first_at_least(intensity_, std::min(intensity, intensity_.back()));
  const float below = intensity_[above - 1];
  const bool lower = intensity - below <= intensity_[above] - intensity && intensity < intensity_.back();
  // Of several levels of the same intensity, the lowest.
  return static_cast<int>(lower ? first_at_least(intensity_, below) : above);
}

int GreyLevels::level(float intensity) const {
  if (!(intensity > 0)) return 0;
  const float held = std::min(intensity, 1.0F);
  const auto step = static_cast<std::size_t>(held * static_cast<float>(first_.size() - 1));
  auto level = static_cast<std::size_t>(first_[step]);
  // Halves what may follow, by arithmetic: a branch would be guessed wrongly at every other pixel.
  for (std::size_t half = reach_; half > 0; half /= 2) {
    level += half * static_cast<std::size_t>(held >= least_[level + half - 1]);
  }
  return static_cast<int>(level);
}

LightTally& LightTally::operator+=(const LightTally& other) {
  light += other.light;
  pixels += other.pixels;
  lit += other.lit;
  clipped += other.clipped;
  return *this;
}

LightTally limit_to_full(Image& image, float scale) {
  constexpr float full = 1;
  constexpr float rounding = 1e-6F;  // the peak itself, divided by the peak in float
  LightTally tally;
  tally.pixels = image.size();
  for (int y = 0; y < image.height; ++y) {
    if (is_dark(image, y)) continue;
    for (float* value = image.row(y); value != image.row(y) + image.width; ++value) {
      *value *= scale;
      tally.lit += *value > 0 ? 1 : 0;
      tally.clipped += *value > full + rounding ? 1 : 0;
      *value = std::min(*value, full);
      tally.light += *value;
    }
  }
  return tally;
}

void to_levels(const Image& intensity, const GreyLevels& levels, GreyImage& image) {
  image.width = intensity.width;
  image.height = intensity.height;
  image.bits = levels.bits();
  image.values.resize(intensity.size());
  put_levels(intensity, 0, 0, levels, image);
}

void put_levels(const Image& part, int left, int top, const GreyLevels& levels, GreyImage& image) {
  const auto dark = static_cast<std::uint16_t>(levels.level(0));
  for (int y = 0; y < part.height; ++y) {
    std::uint16_t* to = image.values.data() + image.index(left, top + y);
    std::fill_n(to, part.width, dark);
    if (is_dark(part, y)) continue;
    const float* from = part.row(y);
    for (int x = 0; x < part.width; ++x) {
      if (from[x] != 0) to[x] = static_cast<std::uint16_t>(levels.level(from[x]));
    }
  }
}

Image to_intensity(const GreyImage& image, const GreyLevels& levels) {
  Image intensity(image.width, image.height);
  for (std::size_t i = 0; i < image.values.size(); ++i) intensity.values[i] = levels.intensity(image.values[i]);
  return intensity;
}

void to_intensity(Image& greys, const Response& response) {
  parallel_for(greys.height, [&](int y) {
    float grey = -1;  // rows are runs of few values
    float intensity = 0;
    for (float* pixel = greys.row(y); pixel != greys.row(y) + greys.width; ++pixel) {
      if (*pixel != grey) {
        grey = *pixel;
        intensity = static_cast<float>(response.intensity(grey));
      }
      *pixel = intensity;
    }
  });
}

}  // namespace vam::resin
