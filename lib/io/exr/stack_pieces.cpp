// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/stack_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/log/progress.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/stream/seal.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

using model::ImageRange;
using model::Piece;
using model::StackInfo;

ImageRange range_of(const StackInfo& info) {
  return info.piece.whole() ? ImageRange{0, info.count} : info.piece.images;
}
int total_of(const StackInfo& info) { return info.piece.whole() ? info.count : info.piece.of; }

/// Reading adds the seal of the file, which is that of the piece.
StackInfo without_own_seal(StackInfo info) {
  if (!info.history.empty() && !chained_seal(info.history.back()).empty()) info.history.pop_back();
  return info;
}

StackInfo undivided(StackInfo info) {
  const int before = range_of(info).from;
  info.count = total_of(info);
  info.piece = {};
  const model::ImageInfo first = exr::implied(info, -before);
  info.z_start_mm = first.z_mm;
  info.angle_start_deg = first.angle_deg;
  return info;
}

bool near(double a, double b, double pitch) { return std::abs(a - b) <= 1e-6 * std::abs(pitch); }

/// The first fact in which pieces of different stacks differ; empty for those of one.
std::string difference(const StackInfo& a, const StackInfo& b) {
  if (a.kind != b.kind || a.space != b.space) return "kind";
  if (a.width != b.width || a.height != b.height) return "image size";
  if (total_of(a) != total_of(b)) return "number of images";
  if (a.pixel_mm != b.pixel_mm || a.row_mm != b.row_mm) return "pitch";
  const StackInfo whole_a = undivided(a);
  const StackInfo whole_b = undivided(b);
  if (!near(whole_a.z_start_mm, whole_b.z_start_mm, a.row_mm)) return "height";
  if (a.angle_step_deg != b.angle_step_deg) return "angle step";
  if (!near(whole_a.angle_start_deg, whole_b.angle_start_deg, a.angle_step_deg)) return "stage angles";
  if (a.units != b.units) return "units";
  if (a.history != b.history) return "history";
  if (a.extra != b.extra) return "attributes";
  return model::poses_text(a.poses) == model::poses_text(b.poses) ? "" : "poses";
}

}  // namespace

StackPieces::StackPieces(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    auto reader = std::make_unique<StackReader>(path, path == "-");
    StackInfo info = without_own_seal(reader->info());
    if (paths.size() > 1 && info.piece.whole()) {
      throw Error{Fault::data, input_name(path) + ": is no piece of a stack (no vam:piece); only pieces can be joined"};
    }
    parts_.push_back({input_name(path), std::move(reader), std::move(info)});
  }
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return range_of(a.info).from < range_of(b.info).from; });
  info_ = undivided(parts_.front().info);
  done_ = range_of(parts_.front().info).from;
  images_ = {done_, done_};
  for (const Part& part : parts_) {
    require_same(parts_.front(), part);
    require_next(part);
    images_.to = range_of(part.info).to;
  }
  if (piped()) images_.to = info_.count;  // more may follow
}

void StackPieces::require_same(const Part& first, const Part& other) const {
  const std::string what = difference(first.info, other.info);
  if (what.empty()) return;
  throw Error{Fault::data, other.name + ": differs from " + first.name + " in its " + what +
                               "; join pieces of one stack, made by the same command"};
}

/// The pieces before end where this one begins.
void StackPieces::require_next(const Part& part) const {
  const ImageRange range = range_of(part.info);
  if (range.from == images_.to) return;
  const std::string where = part.name + ": holds images " + model::range_text(range) +
                            ", but the pieces before it end at " + std::to_string(images_.to);
  throw Error{Fault::data, where + (range.from < images_.to ? "; omit one of those that overlap"
                                                            : "; the piece in between is missing")};
}

/// To the part whose images follow; false where none does.
bool StackPieces::advance() {
  if (at_ + 1 < parts_.size()) {
    parts_[at_++].reader.reset();
    return true;
  }
  Part& part = parts_[at_];
  if (part.name != input_name("-") || !part.reader->next_stack()) return false;
  Part next{part.name, std::move(part.reader), {}};
  next.info = without_own_seal(next.reader->info());
  if (next.info.piece.whole()) {
    throw Error{Fault::data,
                next.name + ": another stack follows, which is no piece (no vam:piece); only pieces can be joined"};
  }
  require_same(part, next);
  images_.to = done_;
  require_next(next);
  images_.to = info_.count;
  part = std::move(next);
  return true;
}

bool StackPieces::piped() const { return parts_.back().name == input_name("-"); }

/// Of what comes through a pipe all is read, lest its writer fails.
bool StackPieces::next(const ImageRange& wanted, Image& image, model::ImageInfo& about) {
  if (done_ >= wanted.to && !piped()) return false;
  while (!parts_[at_].reader->next(image, about)) {
    if (!advance()) return false;
  }
  ++done_;
  return true;
}

void StackPieces::copy(const ImageRange& wanted, StackWriter& out) {
  Progress progress("copying", wanted.to - done_);
  Image image;
  model::ImageInfo about;
  for (; next(wanted, image, about); progress.tick(1)) {
    if (!wanted.holds(done_ - 1)) continue;
    if (about.has_angle || about.has_time || about.has_number) {
      out.write(image, about);
    } else {
      out.write(image);
    }
  }
  if (done_ >= wanted.to) return;
  throw Error{Fault::data, parts_[at_].name + ": ends after image " + std::to_string(done_) + " of " +
                               std::to_string(info_.count) + "; the other pieces are missing"};
}

StackInfo cut(const StackInfo& info, const ImageRange& images, const std::string& name) {
  StackInfo part = info;
  part.count = images.count();
  part.piece = model::piece_of(images, info.count);
  const model::ImageInfo first = exr::implied(info, images.from);
  part.z_start_mm = first.z_mm;
  part.angle_start_deg = first.angle_deg;
  if (info.kind == model::Kind::sinogram || info.poses.empty() || part.piece.whole()) return part;
  throw Error{Fault::data, name + ": its frames have poses, which belong to all of them; cut the sinogram instead"};
}

}  // namespace vam::io
