#include "metrology/views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::metrology {

namespace {

std::string size_text(const Image& image) { return std::to_string(image.width) + " x " + std::to_string(image.height); }

void require_same_size(const Image& image, const Image& field, const std::string& subject, const char* name) {
  if (field.values.empty() || (field.width == image.width && field.height == image.height)) return;
  throw Error{Fault::data,
              subject + ": " + size_text(image) + " pixels, but the " + name + " field has " + size_text(field)};
}

Image binned(const Image& image, int binning) {
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

// Keys' cubic convolution with a = -1/2: weights of the pixels -1, 0, 1, 2 about the fraction f.
std::array<float, 4> cubic_weights(float f) {
  const float g = 1 - f;
  return {-0.5F * f * g * g, 1 - 2.5F * f * f + 1.5F * f * f * f, 1 - 2.5F * g * g + 1.5F * g * g * g,
          -0.5F * g * f * f};
}

float cubic_at(const Image& image, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto wx = cubic_weights(static_cast<float>(x - fx));
  const auto wy = cubic_weights(static_cast<float>(y - fy));
  float sum = 0;
  for (int j = 0; j < 4; ++j) {
    const int row = std::clamp(static_cast<int>(fy) + j - 1, 0, image.height - 1);
    float line = 0;
    for (int i = 0; i < 4; ++i) {
      const int column = std::clamp(static_cast<int>(fx) + i - 1, 0, image.width - 1);
      line += wx[static_cast<std::size_t>(i)] * image(column, row);
    }
    sum += wy[static_cast<std::size_t>(j)] * line;
  }
  return sum;
}

double wrapped(double angle_deg) {
  const double turn = std::fmod(angle_deg, 360.0);
  return turn < 0 ? turn + 360 : turn;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Frames at one angle.
struct Cluster {
  double angle_deg;
  std::vector<int> frames;
};

std::vector<Cluster> clusters_of(std::span<const double> angles_deg, double closer_deg) {
  std::vector<int> order(angles_deg.size());
  std::iota(order.begin(), order.end(), 0);
  const auto angle = [&](int i) { return wrapped(angles_deg[static_cast<std::size_t>(i)]); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return angle(a) < angle(b); });
  std::vector<Cluster> clusters;
  for (const int i : order) {
    if (clusters.empty() || angle(i) - clusters.back().angle_deg > closer_deg) clusters.push_back({angle(i), {}});
    clusters.back().frames.push_back(i);
  }
  for (auto& cluster : clusters) {
    double sum = 0;
    for (const int i : cluster.frames) sum += angle(i);
    cluster.angle_deg = sum / static_cast<double>(cluster.frames.size());
  }
  return clusters;
}

std::vector<double> gaps_of(const std::vector<Cluster>& clusters) {
  std::vector<double> gaps;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const double next = i + 1 < clusters.size() ? clusters[i + 1].angle_deg : clusters[0].angle_deg + 360;
    gaps.push_back(next - clusters[i].angle_deg);
  }
  return gaps;
}

}  // namespace

Image corrected(const Image& raw, const CameraFields& fields, int binning, const std::string& subject) {
  require_same_size(raw, fields.dark, subject, "dark");
  require_same_size(raw, fields.flat, subject, "flat");
  Image image = raw;
  if (!fields.dark.values.empty()) {
    for (std::size_t i = 0; i < image.size(); ++i) image.values[i] -= fields.dark.values[i];
  }
  if (!fields.flat.values.empty()) {
    const double sum = std::accumulate(fields.flat.values.begin(), fields.flat.values.end(), 0.0);
    const auto mean = static_cast<float>(sum / static_cast<double>(fields.flat.size()));
    for (std::size_t i = 0; i < image.size(); ++i) {
      const float flat = fields.flat.values[i];
      if (!(flat > 0)) {
        throw Error{Fault::data, "flat field: pixel " + std::to_string(i % static_cast<std::size_t>(raw.width)) + ", " +
                                     std::to_string(i / static_cast<std::size_t>(raw.width)) + " is " +
                                     format_number(static_cast<double>(flat)) + "; every pixel must be above 0"};
      }
      image.values[i] *= mean / flat;
    }
  }
  return binned(image, binning);
}

std::string exposure_problem(const Image& raw) {
  const auto [low, high] = std::minmax_element(raw.values.begin(), raw.values.end());
  if (!(*high > *low)) {
    return std::string(*low > 0 ? "without contrast" : "dark") + ", every pixel is " +
           format_number(static_cast<double>(*low)) + "; check light and exposure";
  }
  const auto full = std::count(raw.values.begin(), raw.values.end(), *high);
  constexpr double allowed = 0.02;
  const double part = static_cast<double>(full) / static_cast<double>(raw.size());
  if (part <= allowed) return "";
  return "saturated, " + format_number(100 * part, 3) + " % of the pixels are at " +
         format_number(static_cast<double>(*high)) + "; shorten the exposure";
}

void require_exposed(const Image& raw, const std::string& subject) {
  const std::string problem = exposure_problem(raw);
  if (!problem.empty()) throw Error{Fault::data, subject + ": " + problem};
}

void require_alike(std::span<const View> views) {
  std::vector<double> contrast;
  for (const View& view : views) {
    double sum = 0;
    double squares = 0;
    for (const float v : view.image.values) {
      sum += static_cast<double>(v);
      squares += static_cast<double>(v) * static_cast<double>(v);
    }
    const auto n = static_cast<double>(view.image.size());
    contrast.push_back(std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n))));
  }
  if (contrast.empty()) return;
  constexpr double least = 0.2;
  const double usual = median(contrast);
  for (std::size_t i = 0; i < contrast.size(); ++i) {
    if (contrast[i] >= least * usual) continue;
    throw Error{Fault::data, "views: the frame at " + format_number(views[i].angle_deg, 5) +
                                 " deg is dark, its contrast is " + format_number(contrast[i], 3) +
                                 " and the others' " + format_number(usual, 3) + "; leave it out or take it again"};
  }
}

Image straightened(const Image& image, const AxisPose& axis, double row_stretch) {
  if (axis.tilt_rad == 0 && row_stretch == 1) return image;
  Image out(image.width, std::max(1, static_cast<int>(std::floor(image.height * row_stretch))));
  const double middle_in = 0.5 * (image.height - 1);
  const double middle_out = 0.5 * (out.height - 1);
  const double c = std::cos(axis.tilt_rad);
  const double s = std::sin(axis.tilt_rad);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const double across = x - axis.column;
      const double along = (y - middle_out) / row_stretch;
      out(x, y) = cubic_at(image, axis.column + c * across + s * along, middle_in - s * across + c * along);
    }
  }
  return out;
}

AngleGrid::AngleGrid(std::span<const double> angles_deg, int angles, double max_gap_deg) {
  constexpr int fewest = 8;
  std::vector<Cluster> clusters = clusters_of(angles_deg, 1e-6);
  if (static_cast<int>(clusters.size()) < fewest) {
    throw Error{Fault::data, "views: " + std::to_string(clusters.size()) + " different angles; a turn needs at least " +
                                 std::to_string(fewest)};
  }
  if (angles == 0) angles = std::max(fewest, 2 * static_cast<int>(std::lround(180 / median(gaps_of(clusters)))));
  clusters = clusters_of(angles_deg, 36.0 / angles);
  const std::vector<double> gaps = gaps_of(clusters);
  const auto widest = static_cast<std::size_t>(std::max_element(gaps.begin(), gaps.end()) - gaps.begin());
  if (gaps[widest] > max_gap_deg) {
    throw Error{Fault::data, "views: the turn is incomplete, no frame for " + format_number(gaps[widest], 4) +
                                 " deg after " + format_number(clusters[widest].angle_deg, 4) + " deg (" +
                                 format_number(max_gap_deg, 4) + " deg are bridged at most)"};
  }
  summary_ = {angles, static_cast<int>(angles_deg.size()),
              static_cast<int>(angles_deg.size()) - static_cast<int>(clusters.size()), gaps[widest]};
  taps_.resize(static_cast<std::size_t>(angles));
  for (int a = 0; a < angles; ++a) {
    const double angle = 360.0 * a / angles;
    // The last cluster at or below the angle; before the first one that is the last of all, over the circle.
    const auto above = std::upper_bound(clusters.begin(), clusters.end(), angle,
                                        [](double value, const Cluster& cluster) { return value < cluster.angle_deg; });
    const std::size_t before =
        (static_cast<std::size_t>(above - clusters.begin()) + clusters.size() - 1) % clusters.size();
    const Cluster& low = clusters[before];
    const Cluster& high = clusters[(before + 1) % clusters.size()];
    const double part = wrapped(angle - low.angle_deg) / gaps[before];
    auto& taps = taps_[static_cast<std::size_t>(a)];
    for (const int i : low.frames)
      taps.push_back({i, static_cast<float>((1 - part) / static_cast<double>(low.frames.size()))});
    for (const int i : high.frames)
      taps.push_back({i, static_cast<float>(part / static_cast<double>(high.frames.size()))});
  }
}

}  // namespace vam::metrology
