// SPDX-License-Identifier: GPL-3.0-or-later
// Stacks are parsed in a child, one after the other; what it sends is not believed.
#include <cstdint>
#include <exception>
#include <optional>
#include <tuple>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/exr/private/format.hpp"
#include "io/exr/private/stack_parser.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

using model::ImageInfo;
using model::StackInfo;

namespace {

auto members(StackInfo& info) {
  return std::tie(info.kind, info.space, info.width, info.height, info.count, info.pixel_mm, info.row_mm,
                  info.z_start_mm, info.angle_start_deg, info.angle_step_deg, info.units, info.history, info.extra,
                  info.piece, info.poses);
}

enum class MessageKind : std::uint8_t { nothing, stack };

void send_stack(exr::StackParser& parser, Sender& out) {
  parser.read_head();
  StackInfo info = parser.info();
  out.put(MessageKind::stack);
  out.put(members(info));
  out.put(parser.about());
  out.put(std::uint8_t{parser.seals().sealed()});
  out.put(parser.seals().chained());
  out.flush();
  Image image;
  for (ImageInfo about; parser.next(image, about); out.flush()) {
    out.put(image.values.data(), image.values.size() * sizeof(float));
  }
  out.put(parser.seals().chained());
}

void send_stacks(exr::StackParser& parser, Sender& out) {
  do {
    send_stack(parser, out);
  } while (parser.next_stack());
  out.put(MessageKind::nothing);
}

bool plausible(const StackInfo& info, std::size_t images) {
  const model::Piece& piece = info.piece;
  if (!piece.whole() && (model::parse_piece(model::piece_text(piece)) != piece || piece.images.count() != info.count)) {
    return false;
  }
  return exr::is_size(info.width, info.height) && static_cast<std::size_t>(info.count) == images &&
         (info.kind == model::Kind::sinogram || info.kind == model::Kind::frames) &&
         (info.space == model::Space::virtual_ || info.space == model::Space::projector ||
          info.space == model::Space::camera);
}

}  // namespace

struct StackReader::State {
  State(const std::string& path, bool several, bool to_end) : name(input_name(path)) {
    {
      exr::StackParser parser(path, several, to_end);  // the child's
      const InputFile& file = parser.file();
      apart.emplace(Foreign{name, file.size(), file.descriptor(), exr::max_pixels * 8},
                    [&](Sender& out) { send_stacks(parser, out); });
    }
    (void)next_stack();
  }

  bool next_stack() {
    MessageKind follows = MessageKind::nothing;
    apart->take([&](Receiver& in) {
      follows = in.get<MessageKind>();
      if (follows != MessageKind::stack) return;
      info = {};
      in.fill(members(info));
      about = in.get<std::vector<ImageInfo>>();
      sealed = in.get<std::uint8_t>() != 0;
      seal = chained_seal(in.get<std::string>());
    });
    done = 0;
    if (follows != MessageKind::stack) {
      apart->finish();
      return false;
    }
    if (plausible(info, about.size())) return true;
    throw Error{Fault::data, name + ": is damaged (its parser failed)"};
  }

  bool next(Image& image, ImageInfo& own) {
    if (done == about.size()) return false;
    image.width = info.width;
    image.height = info.height;
    image.values.resize(product(info.width, info.height));
    apart->take([&](Receiver& in) { in.get(image.values.data(), image.values.size() * sizeof(float)); });
    own = about[done++];
    if (done == about.size()) apart->take([&](Receiver& in) { seal = chained_seal(in.get<std::string>()); });
    return true;
  }

  std::string name;
  std::optional<SandboxedReader> apart;
  StackInfo info;
  std::vector<ImageInfo> about;
  std::size_t done = 0;
  bool sealed = false;
  std::string seal;
};

StackReader::StackReader(const std::string& path, bool several, bool to_end)
    : state_(std::make_unique<State>(path, several, to_end)) {}
StackReader::~StackReader() = default;

std::string StackReader::seal() const { return state_->seal; }
bool StackReader::is_sealed() const { return state_->sealed; }
const StackInfo& StackReader::info() const { return state_->info; }
const std::vector<ImageInfo>& StackReader::about() const { return state_->about; }
bool StackReader::next(Image& image, ImageInfo& about) { return state_->next(image, about); }

bool StackReader::next_stack() {
  if (state_->done != state_->about.size()) throw Error{Fault::bug, state_->name + ": images are left unread"};
  return state_->next_stack();
}

void require(const std::string& path, const StackInfo& info, model::Kind kind) {
  if (info.kind == kind) return;
  throw Error{Fault::data, input_name(path) + ": holds " + exr::kind_name(info.kind) + " (" +
                               exr::space_name(info.space) + "), but " + exr::kind_name(kind) + " is needed"};
}

void require(const std::string& path, const StackInfo& info, model::Kind kind, model::Space space) {
  if (info.kind == kind && info.space == space) return;
  const bool resampled = info.kind == kind && info.space == model::Space::virtual_ && space == model::Space::projector;
  throw Error{Fault::data, input_name(path) + ": holds " + exr::kind_name(info.kind) + " (" +
                               exr::space_name(info.space) + "), but " + exr::kind_name(kind) + " (" +
                               exr::space_name(space) + ") is needed" +
                               (resampled ? "; convert it by vam-resample" : "")};
}

namespace {

Image decoded(const std::string& bytes, const std::string& name) {
  try {
    return exr::decode_single(bytes);
  } catch (const std::exception& problem) {
    throw Error{Fault::data, name + ": " + printable(problem.what())};
  }
}

}  // namespace

Image read_exr_image(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary, std::uint64_t{1} << 30);
  if (bytes.size() < 4 || exr::number_at<std::int32_t>(bytes, 0) != exr::magic) {
    throw Error{Fault::data, path + ": is no EXR image"};
  }
  Image image;
  read_apart(
      {path, bytes.size(), -1, std::uint64_t{exr::max_pixels} * 8},
      [&](Sender& out) {
        const Image read = decoded(bytes, path);
        out.put(std::tie(read.width, read.height, read.values));
      },
      [&](Receiver& in) { in.fill(std::tie(image.width, image.height, image.values)); });
  if (image.width < 1 || image.height < 1 || product(image.width, image.height) != image.values.size())
    throw Error{Fault::data, path + ": is damaged (its parser failed)"};
  if (!all_finite(image.values.data(), image.size())) {
    throw Error{Fault::data, path + ": has a pixel that is not a finite number"};
  }
  return image;
}

}  // namespace vam::io
