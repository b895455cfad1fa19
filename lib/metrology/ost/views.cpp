// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/views.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/stats/range.hpp"
#include "base/text/image_size.hpp"
#include "base/text/text.hpp"
#include "metrology/ost/private/angle_grid.hpp"

namespace vam::metrology {

namespace {

void require_same_size(const Image& image, const Image& field, const std::string& subject, const char* name) {
  if (field.values.empty() || (field.width == image.width && field.height == image.height)) return;
  throw Error{Fault::data,
              subject + ": " + size_text(image) + " pixels, but the " + name + " field has " + size_text(field)};
}

Image binned(Image image, int binning) {
  if (binning == 1) return image;
  Image small(image.width / binning, image.height / binning);
  const float share = 1.0F / static_cast<float>(binning * binning);
  for (int y = 0; y < small.height * binning; ++y) {
    float* out = small.row(y / binning);
    const float* in = image.row(y);
    for (int x = 0; x < small.width * binning; ++x) out[x / binning] += share * in[x];
  }
  return small;
}

}  // namespace

std::vector<double> angles_deg(std::span<const CameraView> views) {
  std::vector<double> angles;
  for (const CameraView& view : views) angles.push_back(view.angle_deg);
  return angles;
}

Image corrected(Image image, const CameraFields& fields, int binning, const std::string& subject) {
  require_same_size(image, fields.dark, subject, "dark");
  require_same_size(image, fields.flat, subject, "flat");
  if (!fields.dark.values.empty()) {
    for (std::size_t i = 0; i < image.size(); ++i) image.values[i] -= fields.dark.values[i];
  }
  if (!fields.flat.values.empty()) {
    const auto mean = static_cast<float>(stats::mean_value(fields.flat.values));
    for (std::size_t i = 0; i < image.size(); ++i) {
      const float flat = fields.flat.values[i];
      if (!(flat > 0)) {
        throw Error{Fault::data, "flat field: pixel " + std::to_string(i % static_cast<std::size_t>(image.width)) +
                                     ", " + std::to_string(i / static_cast<std::size_t>(image.width)) + " is " +
                                     format_number(flat) + "; every pixel must be above 0"};
      }
      image.values[i] *= mean / flat;
    }
  }
  return binned(std::move(image), binning);
}

Exposure exposure_of(const Image& raw) {
  const auto [low, high] = stats::range_of(raw.values);
  Exposure found{low, high, 0, 0, count_of(raw.values)};
  for (const float v : raw.values) {  // as int: vector code
    found.pixels_at_least += v == low ? 1 : 0;
    found.pixels_at_most += v == high ? 1 : 0;
  }
  return found;
}

std::string Exposure::problem() const {
  if (!(most > least)) {
    return std::string(least > 0 ? "without contrast" : "dark") + ", every pixel is " + format_number(least) +
           "; check light and exposure";
  }
  constexpr double allowed = 0.02;
  const double part = static_cast<double>(pixels_at_most) / pixels;
  if (part <= allowed) return "";
  return "saturated, " + format_number(100 * part, 3) + " % of the pixels are at " + format_number(most) +
         "; shorten the exposure";
}

std::vector<std::string> contrast_problems(std::span<const CameraView> views) {
  std::vector<double> contrast(views.size());
  parallel_for(count_of(views), [&](int i) {
    double sum = 0;
    double squares = 0;
    for (const float v : views[i].image.values) {
      sum += v;
      squares += static_cast<double>(v) * static_cast<double>(v);
    }
    const auto n = static_cast<double>(views[i].image.size());
    contrast[i] = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
  });
  std::vector<std::string> problems(views.size());
  if (contrast.empty()) return problems;
  constexpr double least = 0.2;
  const double usual = stats::median(contrast);
  for (std::size_t i = 0; i < contrast.size(); ++i) {
    if (contrast[i] >= least * usual) continue;
    problems[i] =
        "dark, its contrast is " + format_number(contrast[i], 3) + " and the others' " + format_number(usual, 3);
  }
  return problems;
}

Image mean_view(std::span<const CameraView> views) {
  const AngleGrid turn(angles_deg(views), 0);
  Image mean(views.front().image.width, views.front().image.height);
  const float share = 1.0F / static_cast<float>(turn.summary().angles);
  parallel_for(mean.height, [&](int y) {
    float* sum = mean.row(y);
    for (int a = 0; a < turn.summary().angles; ++a) {
      for (const auto& tap : turn.taps(a)) {
        const float* row = views[tap.frame].image.row(y);
        for (int x = 0; x < mean.width; ++x) sum[x] += share * tap.weight * row[x];
      }
    }
  });
  return mean;
}

Image middle_view(std::span<const CameraView> views) {
  constexpr int most = 120;
  const std::vector<double> angles_deg = metrology::angles_deg(views);
  const AngleGrid turn(angles_deg, std::min(most, AngleGrid(angles_deg, 0).summary().angles));
  const int angles = turn.summary().angles;
  const int quarter = angles / 4;
  Image middle(views.front().image.width, views.front().image.height);
  parallel_for(middle.height, [&](int y) {
    std::vector<float> values(product(middle.width, angles));  // [x][angle]
    for (int a = 0; a < angles; ++a) {
      for (const auto& tap : turn.taps(a)) {
        const float* row = views[tap.frame].image.row(y);
        for (int x = 0; x < middle.width; ++x) values[product(x, angles) + a] += tap.weight * row[x];
      }
    }
    for (int x = 0; x < middle.width; ++x) {
      const auto first = values.begin() + std::ptrdiff_t{x} * angles;
      const auto last = first + angles;
      std::nth_element(first, first + quarter, last);
      std::nth_element(first + quarter, last - quarter - 1, last);
      middle(x, y) = std::accumulate(first + quarter, last - quarter, 0.0F) / static_cast<float>(angles - 2 * quarter);
    }
  });
  return middle;
}

}  // namespace vam::metrology
