// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/foreign.hpp"

#include <cstdint>

#include "base/error.hpp"
#include "io/stream/serialisation.hpp"

namespace vam::io::exr {

namespace {

using model::ImageInfo;
using model::StackInfo;

constexpr std::uint64_t most_parts = 1 << 24;

// Both directions from one list of members.
template <class Pass>
void pass_facts(const Pass& pass, StackInfo& info) {
  pass(info.kind);
  pass(info.space);
  for (int* number : {&info.width, &info.height, &info.count}) pass(*number);
  for (double* number : {&info.pixel_mm, &info.row_mm, &info.z_start_mm, &info.angle_start_deg, &info.angle_step_deg}) {
    pass(*number);
  }
  pass(info.units);
  pass(info.history);
  pass(info.extra);
  for (int* number : {&info.piece.images.from, &info.piece.images.to, &info.piece.of}) pass(*number);
}

template <class Pass>
void pass_facts(const Pass& pass, model::Pose& pose) {
  for (double* number : {&pose.angle_deg, &pose.dx_mm, &pose.dy_mm, &pose.dz_mm}) pass(*number);
  pass(pose.moves);
}

template <class Pass>
void pass_facts(const Pass& pass, ImageInfo& about) {
  for (double* number : {&about.z_mm, &about.angle_deg, &about.time_s, &about.time_sigma_s}) pass(*number);
  for (bool* truth : {&about.has_angle, &about.has_time, &about.has_number, &about.incomplete}) pass(*truth);
  pass(about.number);
}

template <class Facts>
void send_all(std::vector<Facts> list, Sender& out) {
  out.put(std::uint64_t{list.size()});
  for (Facts& facts : list) pass_facts(Writer{out}, facts);
}

template <class Facts>
std::vector<Facts> receive_all(Receiver& in) {
  std::vector<Facts> list;
  for (auto left = in.get_count(most_parts); left > 0; --left) pass_facts(Reader{in}, list.emplace_back());
  return list;
}

enum class MessageKind : std::uint8_t { nothing, stack };

void send_stack(StackParser& parser, Sender& out) {
  parser.read_head();
  StackInfo info = parser.info();
  out.put(MessageKind::stack);
  pass_facts(Writer{out}, info);
  send_all(info.poses, out);
  send_all(parser.about(), out);
  out.put(std::uint8_t{parser.seals().sealed()});
  out.put(parser.seals().chained());
  out.flush();
  Image image;
  for (ImageInfo about; parser.next(image, about, true); out.flush()) {
    out.put(image.values.data(), image.values.size() * sizeof(float));
  }
  out.put(parser.seals().chained());
}

void send_stacks(StackParser& parser, Sender& out) {
  do {
    send_stack(parser, out);
  } while (parser.next_stack());
  out.put(MessageKind::nothing);
}

// What a child sends is not believed.
bool plausible(const StackInfo& info, std::size_t images) {
  const model::Piece& piece = info.piece;
  if (!piece.whole() && (model::parse_piece(model::piece_text(piece)) != piece || piece.images.count() != info.count)) {
    return false;
  }
  return info.width > 0 && info.width <= max_side && info.height > 0 && info.height <= max_side &&
         std::int64_t{info.width} * info.height <= max_pixels && static_cast<std::size_t>(info.count) == images &&
         (info.kind == model::Kind::sinogram || info.kind == model::Kind::frames) &&
         (info.space == model::Space::virtual_ || info.space == model::Space::projector ||
          info.space == model::Space::camera);
}

}  // namespace

ForeignStacks::ForeignStacks(StackParser& parser)
    : apart_({parser.file().name(), parser.file().size(), parser.file().descriptor(), max_pixels * 8},
             [&parser](Sender& out) { send_stacks(parser, out); }),
      name_(parser.file().name()) {
  (void)next_stack();
}

bool ForeignStacks::next_stack() {
  MessageKind follows = MessageKind::nothing;
  apart_.take([&](Receiver& in) {
    follows = in.get<MessageKind>();
    if (follows != MessageKind::stack) return;
    info_ = {};
    pass_facts(Reader{in}, info_);
    info_.poses = receive_all<model::Pose>(in);
    about_ = receive_all<ImageInfo>(in);
    sealed_ = in.get<std::uint8_t>() != 0;
    seal_ = chained_seal(in.get_text());
  });
  done_ = 0;
  if (follows != MessageKind::stack) {
    apart_.finish();
    return false;
  }
  if (!plausible(info_, about_.size())) throw Error{Fault::data, name_ + ": is damaged (its parser failed)"};
  return true;
}

bool ForeignStacks::next(Image& image, ImageInfo& about) {
  if (done_ == about_.size()) return false;
  image = Image(info_.width, info_.height);
  apart_.take([&](Receiver& in) { in.get(image.values.data(), image.values.size() * sizeof(float)); });
  about = about_[done_++];
  if (done_ == about_.size()) apart_.take([&](Receiver& in) { seal_ = chained_seal(in.get_text()); });
  return true;
}

}  // namespace vam::io::exr
