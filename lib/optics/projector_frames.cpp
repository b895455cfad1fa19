// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/projector_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optics/private/refuse_negative.hpp"
#include "optics/private/sample_taps.hpp"

namespace vam::optics {

namespace {

std::string range(double low, double high) { return format_number(low) + " to " + format_number(high); }

void require_projector_stack(const std::string& subject, const model::StackInfo& info, const FramePlace& place) {
  const double turn_deg = std::abs(info.angle_step_deg) * info.height;
  if (info.poses.empty() && std::abs(turn_deg - 360) > 1e-3) {
    throw Error{Fault::data, subject + ": its " + std::to_string(info.height) + " angles span " +
                                 format_number(turn_deg) + " degrees, not one turn of 360"};
  }
  if (info.width != place.columns) {
    throw Error{Fault::data, subject + ": has " + std::to_string(info.width) + " columns, but the projector has " +
                                 std::to_string(place.columns) + "; give vam-resample the same printer"};
  }
  if (std::abs(info.pixel_mm - place.pixel_mm) > 1e-6 * place.pixel_mm) {
    throw Error{Fault::data, subject + ": its pixels are " + format_number(info.pixel_mm) +
                                 " mm, but the projector's are " + format_number(place.pixel_mm) +
                                 " mm; give vam-resample the same printer"};
  }
  if (info.count > 1 && !(info.row_mm > 0)) {
    throw Error{Fault::data,
                subject + ": its slice pitch (vam:row_mm) is " + format_number(info.row_mm) + " mm, not above 0"};
  }
}

}  // namespace

FrameSchedule frame_schedule(double fps, double speed_deg_s, double turns) {
  const double frames_per_turn = 360 * fps / speed_deg_s;
  const double count = std::round(turns * frames_per_turn);
  if (frames_per_turn < 2 || !(count >= 1) || count > 1e7) {
    throw Error{Fault::usage, format_number(fps) + " frames per second at " + format_number(speed_deg_s) +
                                  " deg/s give " + format_number(frames_per_turn) + " frames a turn and " +
                                  format_number(count, 9) + " in all; change fps, speed or turns"};
  }
  return {static_cast<int>(count), fps, speed_deg_s / fps};
}

FramePlace frame_place(const model::Projector& projector, double column_offset, double row_offset) {
  return {projector.columns, projector.rows, projector.pixel_mm, projector.axis_row + row_offset, column_offset};
}

double beside_rows(const model::StackInfo& info, const FramePlace& place) {
  const double rows = info.row_mm / place.pixel_mm;
  if (info.count < 2 || std::round(rows) < 1 || std::abs(rows - std::round(rows)) > 1e-3) return 0;
  const double edge = place.axis_row - (info.z_start_mm - 0.5 * info.row_mm) / place.pixel_mm - 0.5;
  return std::abs(edge - std::round(edge));
}

FrameComposer::FrameComposer(std::string subject, const model::StackInfo& info, const FramePlace& place)
    : subject_(std::move(subject)),
      info_(info),
      place_(place),
      column_peak_(static_cast<std::size_t>(std::max(place.columns, 0)) * 3, 0.0F),
      repeats_(model::repeat(info.poses)) {
  require_projector_stack(subject_, info, place);
}

namespace {

// Columns of a sinogram that are not 0 at every angle.
struct Lit {
  int low = std::numeric_limits<int>::max();
  int high = -1;
  float least = 0;
  float most = 0;
};

Lit lit_columns(const Image& sinogram) {
  const auto width = static_cast<std::size_t>(sinogram.width);
  std::vector<float> least(width, 0.0F), most(width, 0.0F);
  for (int a = 0; a < sinogram.height; ++a) {
    const float* row = sinogram.row(a);
    for (std::size_t c = 0; c < width; ++c) {
      least[c] = std::min(least[c], row[c]);
      most[c] = std::max(most[c], row[c]);
    }
  }
  Lit lit;
  for (int c = 0; c < sinogram.width; ++c) {
    if (least[c] == 0 && most[c] == 0) continue;
    lit.low = std::min(lit.low, c);
    lit.high = c;
    lit.least = std::min(lit.least, least[c]);
    lit.most = std::max(lit.most, most[c]);
  }
  return lit;
}

}  // namespace

void FrameComposer::add(const Image& sinogram, double z_mm) {
  const Lit lit = lit_columns(sinogram);
  if (lit.least < 0) refuse_negative(subject_, sinogram, info_, z_mm);
  Slice& slice = slices_.emplace_back();
  slice.z_mm = z_mm;
  if (lit.high < 0) return;
  slice.peak = lit.most;
  peak_ = std::max(peak_, lit.most);
  // Device column x shows sinogram columns x - offset; x runs over all that get light, on the device or beside it.
  const Taps taps = sample_taps(-place_.column_offset, 1);
  const int count = count_of(taps.weights);
  const int low = std::max(lit.low - taps.first - count + 1, -place_.columns);
  const int high = std::min(lit.high - taps.first, 2 * place_.columns - 1);
  slice.first = std::clamp(low, 0, place_.columns);
  slice.width = std::max(std::min(high + 1, place_.columns) - slice.first, 0);
  if (high < low) return;
  slice.values.resize(product(sinogram.height, slice.width));
  std::vector<float> shown(static_cast<std::size_t>(high - low + 1));
  float* peak = column_peak_.data() + place_.columns + low;
  for (int a = 0; a < sinogram.height; ++a) {
    std::fill(shown.begin(), shown.end(), 0.0F);
    const float* row = sinogram.row(a);
    for (int t = 0; t < count; ++t) {
      const int right = taps.first + t;
      const int end = std::min(high + 1, sinogram.width - right);
      for (int x = std::max(low, -right); x < end; ++x) shown[x - low] += taps.weights[t] * row[x + right];
    }
    for (std::size_t x = 0; x < shown.size(); ++x) peak[x] = std::max(peak[x], shown[x]);
    if (slice.width == 0) continue;  // beside the device
    std::copy_n(shown.data() + (slice.first - low), slice.width, slice.values.data() + product(a, slice.width));
  }
}

void FrameComposer::check_columns(float dark) const {
  int low = 2 * place_.columns;
  int high = -place_.columns - 1;
  const float* peak = column_peak_.data() + place_.columns;
  for (int x = -place_.columns; x < 2 * place_.columns; ++x) {
    if (peak[x] <= dark) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (low >= 0 && high < place_.columns) return;
  throw Error{Fault::data, subject_ + ": light on columns " + range(low, high) + ", but the projector has columns " +
                               range(0, place_.columns - 1) + "; reduce the column offset"};
}

void FrameComposer::check_rows(float dark) const {
  double top = std::numeric_limits<double>::infinity();
  double bottom = -top;
  for (const Slice& slice : slices_) {
    if (slice.peak <= dark) continue;
    top = std::min(top, row_of(slice.z_mm));
    bottom = std::max(bottom, row_of(slice.z_mm));
  }
  const double half = 0.5 * slice_mm() / place_.pixel_mm;  // of a slice, in rows
  constexpr double forgiven = 0.01;                        // of a row
  if (top - half >= -0.5 - forgiven && bottom + half <= place_.rows - 0.5 + forgiven) return;
  throw Error{Fault::data, subject_ + ": light on rows " + range(top, bottom) + ", but the projector has rows " +
                               range(0, place_.rows - 1) + "; change the row offset, or move or shorten the part"};
}

void FrameComposer::check() const {
  if (!(peak_ > 0)) throw Error{Fault::data, subject_ + ": is all dark; there is nothing to project"};
  const float dark = peak_ / 131072;
  check_columns(dark);
  check_rows(dark);
}

void FrameComposer::add_row(const Slice& slice, int angle, float weight, const PixelRect& part, float* row) const {
  const int begin = std::max(slice.first, part.left);
  const int end = std::min(slice.first + slice.width, part.left + part.width);
  const int wrapped = (angle % info_.height + info_.height) % info_.height;
  const int a = repeats_ ? wrapped : std::clamp(angle, 0, info_.height - 1);
  const float* from = slice.values.data() + product(a, slice.width);
  for (int x = begin; x < end; ++x) row[x - part.left] += weight * from[x - slice.first];
}

PixelRect FrameComposer::lit() const {
  const double reach = slice_mm() / place_.pixel_mm + 2;  // of a slice, in rows: to the next one, and half a row
  int left = place_.columns;
  int right = 0;
  double top = place_.rows;
  double bottom = -1;
  for (const Slice& slice : slices_) {
    if (slice.width == 0) continue;
    left = std::min(left, slice.first);
    right = std::max(right, slice.first + slice.width);
    top = std::min(top, row_of(slice.z_mm) - reach);
    bottom = std::max(bottom, row_of(slice.z_mm) + reach);
  }
  if (right <= left) return {0, 0, 1, 1};
  const int first = std::clamp(floor_int(top), 0, place_.rows - 1);
  const int last = std::clamp(floor_int(bottom) + 1, first, place_.rows - 1);
  return {left, first, right - left, last + 1 - first};
}

Image FrameComposer::frame(double angle_deg, double span_deg, Image reused) const {
  return frame(angle_deg, span_deg, {0, 0, place_.columns, place_.rows}, std::move(reused));
}

Image FrameComposer::frame(double angle_deg, double span_deg, const PixelRect& part, Image reused) const {
  Image image = std::move(reused);
  image.width = part.width;
  image.height = part.height;
  image.values.assign(product(part.width, part.height), 0.0F);
  const Taps angles = sample_taps((angle_deg - info_.angle_start_deg) / info_.angle_step_deg,
                                  span_deg / std::abs(info_.angle_step_deg));
  const int count = count_of(slices_);
  for (int r = part.top; r < part.top + part.height; ++r) {
    const double z_mm = (place_.axis_row - r) * place_.pixel_mm;
    const Taps taps = mean_taps((z_mm - slices_.front().z_mm) / slice_mm(), place_.pixel_mm / slice_mm());
    for (std::size_t s = 0; s < taps.weights.size(); ++s) {
      const int number = taps.first + static_cast<int>(s);
      if (number < 0 || number >= count) continue;
      const Slice& slice = slices_[number];
      for (std::size_t a = 0; a < angles.weights.size(); ++a) {
        add_row(slice, angles.first + static_cast<int>(a), taps.weights[s] * angles.weights[a], part,
                image.row(r - part.top));
      }
    }
  }
  return image;
}

double turns_of(const model::StackInfo& info) {
  return info.poses.empty() ? 1 : info.height * std::abs(info.angle_step_deg) / 360;
}

double turns_to_show(const model::StackInfo& info, std::optional<double> requested, double usual) {
  if (info.poses.empty()) return requested.value_or(usual);
  const double own = turns_of(info);
  const double turns = requested.value_or(own);
  if (model::repeat(info.poses) || std::abs(turns / own - 1) < 1e-6) return turns;
  throw Error{Fault::usage, "turns: " + format_number(turns) + " requested, but the poses of the stack do not return " +
                                "to the first one: it is shown once, which takes " + format_number(own)};
}

void orient(Image& image, const std::string& orientation) {
  const auto width = static_cast<std::ptrdiff_t>(image.width);
  if (orientation == "rotate-180") std::reverse(image.values.begin(), image.values.end());
  if (orientation == "flip-columns") {
    for (auto row = image.values.begin(); row != image.values.end(); row += width) std::reverse(row, row + width);
  }
  if (orientation == "flip-rows") {
    for (int y = 0; y < image.height / 2; ++y) {
      std::swap_ranges(image.row(y), image.row(y) + width, image.row(image.height - 1 - y));
    }
  }
}

PixelRect oriented(const PixelRect& part, int columns, int rows, const std::string& orientation) {
  PixelRect turned = part;
  if (orientation == "flip-columns" || orientation == "rotate-180") turned.left = columns - part.left - part.width;
  if (orientation == "flip-rows" || orientation == "rotate-180") turned.top = rows - part.top - part.height;
  return turned;
}

model::StackInfo frames_info(const model::StackInfo& sinogram, const FramePlace& place, const FrameSchedule& schedule,
                             const std::string& orientation) {
  model::StackInfo info = sinogram;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = place.columns;
  info.height = place.rows;
  info.count = schedule.count;
  info.piece = {};
  info.pixel_mm = place.pixel_mm;
  const bool upside_down = orientation == "flip-rows" || orientation == "rotate-180";
  info.row_mm = upside_down ? place.pixel_mm : -place.pixel_mm;
  info.z_start_mm = (upside_down ? place.axis_row - (place.rows - 1) : place.axis_row) * place.pixel_mm;
  info.angle_start_deg = 0;
  info.angle_step_deg = schedule.step_deg;
  info.poses.clear();
  for (int n = 0; n < schedule.count && !sinogram.poses.empty(); ++n) {
    const double frame = (schedule.angle_deg(n) - sinogram.angle_start_deg) / sinogram.angle_step_deg;
    model::Pose& pose = info.poses.emplace_back(model::pose_between(sinogram.poses, frame));
    pose.angle_deg = schedule.angle_deg(n);
  }
  return info;
}

}  // namespace vam::optics
