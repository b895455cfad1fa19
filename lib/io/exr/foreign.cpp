// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/foreign.hpp"

#include <cstdint>
#include <tuple>

#include "base/error.hpp"

namespace vam::io::exr {

namespace {

using model::ImageInfo;
using model::StackInfo;

auto members(StackInfo& info) {
  return std::tie(info.kind, info.space, info.width, info.height, info.count, info.pixel_mm, info.row_mm,
                  info.z_start_mm, info.angle_start_deg, info.angle_step_deg, info.units, info.history, info.extra,
                  info.piece, info.poses);
}

enum class MessageKind : std::uint8_t { nothing, stack };

void send_stack(StackParser& parser, Sender& out) {
  parser.read_head();
  StackInfo info = parser.info();
  out.put(MessageKind::stack);
  out.put(members(info));
  out.put(parser.about());
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
    in.fill(members(info_));
    about_ = in.get<std::vector<ImageInfo>>();
    sealed_ = in.get<std::uint8_t>() != 0;
    seal_ = chained_seal(in.get<std::string>());
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
  if (done_ == about_.size()) apart_.take([&](Receiver& in) { seal_ = chained_seal(in.get<std::string>()); });
  return true;
}

}  // namespace vam::io::exr
