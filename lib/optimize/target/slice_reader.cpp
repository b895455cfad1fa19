// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/slice_reader.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::optimize {

namespace {

using model::Circle;

/// Findings of the checks in one slice.
struct Findings {
  SliceDigest digest{};
  double reach = -1;  // of the part from the axis, voxels
  bool has_void = false;
  long shared_with_insert = 0;
  float least = 0;  // of weight, tolerance and delivered dose
};

/// Voxels that part and insert together fill more than once, rounding left aside.
long overlap(const SliceData& slice) {
  constexpr float more_than_full = 1.05F;
  long shared = 0;
  for (std::size_t i = 0; i < slice.insert.size(); ++i) {
    shared += slice.target[i] + slice.insert[i] > more_than_full ? 1 : 0;
  }
  return shared;
}

/// Distance from the axis to the farthest voxel centre with coverage, in voxels; -1 for an empty slice.
double reach(const float* slice, int width, int height, double axis_x, double axis_y) {
  double farthest = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (*slice++ > model::coverage_rounding) farthest = std::max(farthest, std::hypot(x - axis_x, y - axis_y));
    }
  }
  return farthest;
}

bool void_inside(const float* slice, light::Shape shape, const Circle& circle) {
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x, ++slice) {
      if (*slice <= model::coverage_rounding && circle.contains(x, y)) return true;
    }
  }
  return false;
}

Findings look(const SliceData& slice, light::Shape shape, const Circle& circle) {
  Findings found;
  found.digest = digest(slice.target);
  for (const auto* values : {&slice.insert, &slice.weight, &slice.tolerance, &slice.delivered}) {
    if (!values->empty()) found.digest = digest(*values, found.digest);
  }
  found.reach = reach(slice.target.data(), shape.width, shape.height, circle.axis_x, circle.axis_y);
  found.has_void = void_inside(slice.target.data(), shape, circle);
  found.shared_with_insert = overlap(slice);
  for (const auto* values : {&slice.weight, &slice.tolerance, &slice.delivered}) {
    for (const float v : *values) found.least = std::min(found.least, v);
  }
  return found;
}

void judge(int k, const Findings& found, const Circle& circle) {
  const std::string where = "slice " + std::to_string(k) + ": ";
  if (found.shared_with_insert > 0) {
    throw Error{Fault::data, where + "part and insert share " + std::to_string(found.shared_with_insert) +
                                 " voxels; cut the insert out of the part"};
  }
  if (found.least < 0) {
    throw Error{Fault::data, where + "a weight, tolerance or delivered dose is " + format_number(found.least) +
                                 "; none may be below 0"};
  }
  if (found.reach > circle.radius) {
    throw Error{Fault::data, where + "the part reaches " + format_number(found.reach, 4) +
                                 " voxels from the axis, but light reaches only " + format_number(circle.radius, 4) +
                                 "; scale the part down or use a wider vial"};
  }
}

}  // namespace

SliceReader::SliceReader(const VolumeSource& source, light::Shape shape)
    : source_(source), pixels_(static_cast<std::size_t>(shape.width) * shape.height) {
  if (source.band_px > 0) band_.emplace(source.target, source.slices, shape.width, shape.height, source.band_px);
}

std::vector<SliceData> SliceReader::read(int k, int count) const {
  std::vector<SliceData> slices(count);
  std::vector<float> buffer;
  const auto take = [&](const VolumeSource::Read& from, std::vector<float> SliceData::*to) {
    if (!from) return;
    buffer.resize(pixels_ * slices.size());
    from(k, count, buffer.data());
    for (std::size_t i = 0; i < slices.size(); ++i) {
      const float* values = buffer.data() + i * pixels_;
      (slices[i].*to).assign(values, values + pixels_);
    }
  };
  take(source_.target, &SliceData::target);
  take(source_.insert, &SliceData::insert);
  take(source_.weight, &SliceData::weight);
  take(source_.tolerance, &SliceData::tolerance);
  take(source_.delivered, &SliceData::delivered);
  for (int i = 0; band_ && i < count; ++i) {
    std::vector<float>& weight = slices[i].weight;
    if (weight.empty()) weight.assign(pixels_, 1.0F);
    band_->clear(k + i, weight.data());
  }
  return slices;
}

VolumeSource::Read with_void(const VolumeSource::Read& target, const VolumeSource::Read& values, float usual,
                             std::size_t pixels, const std::function<void(float&)>& change) {
  return [=](int k, int count, float* out) {
    const std::size_t all = static_cast<std::size_t>(count) * pixels;
    std::vector<float> wanted(all);
    target(k, count, wanted.data());
    if (values) values(k, count, out);
    if (!values) std::fill_n(out, all, usual);
    for (std::size_t i = 0; i < all; ++i) {
      if (wanted[i] <= model::coverage_rounding) change(out[i]);
    }
  };
}

std::vector<SliceDigest> check(const VolumeSource& source, light::Shape shape, const Circle& circle, bool grey) {
  const SliceReader reader(source, shape);
  std::vector<SliceDigest> digests;
  bool any_part = false;
  bool any_void = grey;
  for (int first = 0; first < source.slices; first += lanes) {
    const int count = std::min(lanes, source.slices - first);
    const std::vector<SliceData> slices = reader.read(first, count);
    std::vector<Findings> found(slices.size());
    parallel_for(count, [&](int i) { found[i] = look(slices[i], shape, circle); });
    for (int i = 0; i < count; ++i) {
      const Findings& f = found[i];
      judge(first + i, f, circle);
      any_part = any_part || f.reach >= 0;
      any_void = any_void || f.has_void;
      digests.push_back(f.digest);
    }
  }
  if (!any_part) throw Error{Fault::data, "the target is empty (no coverage anywhere); there is nothing to print"};
  if (!any_void) {
    throw Error{Fault::data, "the target fills the whole writable circle; without void there is nothing to optimise"};
  }
  return digests;
}

}  // namespace vam::optimize
