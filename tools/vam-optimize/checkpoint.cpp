#include "vam-optimize/checkpoint.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "device/os/interrupt.hpp"

namespace vam::optimize_tool {

Checkpoint::Checkpoint(const std::string& path)
    : path_(path),
      out_(path),
      to_(optimize::Archive::Way::out, path, [this](void* bytes, std::size_t size) { out_.write(bytes, size); }) {
  if (!std::filesystem::exists(path)) return;
  in_.emplace(path);
  from_.emplace(optimize::Archive::Way::in, path, [this](void* bytes, std::size_t size) { take(bytes, size); });
}

void Checkpoint::take(void* bytes, std::size_t size) {
  const std::size_t got = in_->read(bytes, size);
  if (got == size) return;
  throw Error{Fault::data, path_ + ": ends after " + std::to_string(in_->position()) +
                               " bytes, which is incomplete; remove it and start again"};
}

optimize::Interruption Checkpoint::interruption(const std::string& job) {
  return {device::interrupted, &to_, from_ ? &*from_ : nullptr, job};
}

void Checkpoint::remove() const {
  if (in_) std::filesystem::remove(path_);
}

}  // namespace vam::optimize_tool
