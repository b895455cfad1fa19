// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/checkpoint_state.hpp"

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/format_version.hpp"

namespace vam::optimize {

namespace {

enum class RecordTag { finished = 1, open = 2 };

void begin(Archive& to, RecordTag record) {
  auto tag = static_cast<int>(record);
  to(tag);
}

[[noreturn]] void damaged(const Archive& from) {
  throw Error{Fault::data, from.name() + ": damaged; remove it and start again"};
}

}  // namespace

void exchange(Archive& archive, const RunMark& mark) {
  constexpr FormatKind format = "checkpoint";
  const int magic = 0x564D4F30 + std::stoi(format.version());  // "VMO5"
  int given = magic;
  archive(given);
  if (given != magic) {
    const std::string newer = given >> 8 == magic >> 8 ? format.objection(std::to_string(given - 0x564D4F30)) : "";
    constexpr const char* other =
        "is not a checkpoint of this version of vam-optimize; name another file, or remove it to start anew";
    throw Error{Fault::data, archive.name() + ": " + (newer.empty() ? other : newer)};
  }
  std::string job = mark.job;
  SliceDigest target = mark.target;
  int watched = mark.watched ? 1 : 0;
  archive(job);
  archive(target);
  archive(watched);
  if (job == mark.job && target == mark.target && (watched != 0) == mark.watched) return;
  throw Error{Fault::data,
              archive.name() + ": is a checkpoint of another job; remove it, or give the same target and options"};
}

void keep_finished(Archive& to, std::vector<Image>& images) {
  begin(to, RecordTag::finished);
  auto count = count_of(images);
  to(count);
  for (Image& image : images) to(image.values);
}

void begin_open(Archive& to) { begin(to, RecordTag::open); }

std::optional<std::vector<Image>> next_finished(Archive& from, light::Shape image, int most) {
  int tag = 0;
  from(tag);
  if (tag == static_cast<int>(RecordTag::open)) return std::nullopt;
  int count = 0;
  from(count);
  if (tag != static_cast<int>(RecordTag::finished) || count < 1 || count > most) damaged(from);
  std::vector<Image> images(count, Image(image.width, image.height));
  for (Image& each : images) {
    const std::size_t pixels = each.size();
    from(each.values);
    if (each.values.size() != pixels) damaged(from);
  }
  return images;
}

}  // namespace vam::optimize
