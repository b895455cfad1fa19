// SPDX-License-Identifier: GPL-3.0-or-later
// A stack with seals is read in this process; any other, which some other program has made, in a child, and so is all
// that follows it.
#include <optional>

#include "base/error.hpp"
#include "io/exr/private/attributes.hpp"
#include "io/exr/private/foreign.hpp"
#include "io/exr/private/stack_parser.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/input_name.hpp"

namespace vam::io {

using model::ImageInfo;
using model::StackInfo;

struct StackReader::State {
  State(const std::string& path, bool several, bool to_end) : parser(path, several, to_end) { read_head(); }

  void read_head() {
    if (parser.has_seals()) {
      parser.read_head();
    } else {
      foreign.emplace(parser);
    }
  }

  exr::StackParser parser;
  std::optional<exr::ForeignStacks> foreign;  // from this stack on
};

StackReader::StackReader(const std::string& path, bool several, bool to_end)
    : state_(std::make_unique<State>(path, several, to_end)) {}
StackReader::~StackReader() = default;

std::string StackReader::seal() const {
  return state_->foreign ? state_->foreign->seal() : chained_seal(state_->parser.seals().chained());
}
bool StackReader::is_sealed() const {
  return state_->foreign ? state_->foreign->is_sealed() : state_->parser.seals().sealed();
}

const StackInfo& StackReader::info() const { return state_->foreign ? state_->foreign->info() : state_->parser.info(); }
const std::vector<ImageInfo>& StackReader::about() const {
  return state_->foreign ? state_->foreign->about() : state_->parser.about();
}

bool StackReader::next(Image& image, ImageInfo& about) {
  return state_->foreign ? state_->foreign->next(image, about) : state_->parser.next(image, about, false);
}

bool StackReader::next_stack() {
  if (state_->foreign) return state_->foreign->next_stack();
  if (!state_->parser.next_stack()) return false;
  state_->read_head();
  return true;
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

}  // namespace vam::io
