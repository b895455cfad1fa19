// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/starting_point.hpp"

#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/text.hpp"
#include "device/os/interrupt.hpp"
#include "io/settings/printer_file.hpp"

namespace vam::optimize_tool {

namespace {

/// Which job a state is of: the printer, the options, what the files hold that the options name beside the volumes (the
/// slices have digests of their own), and how the limit is raised.
std::string job_of(const cli::App& app, const model::Printer& printer, const Options& options) {
  std::string job = io::printer_toml(printer) + app.job();
  job += "raising=" + format_number(options.raising.factor) + "," + format_number(options.raising.enough) + "\n";
  if (options.recorded_tolerances) job += model::tolerances_text(*options.printer_tolerances) + "\n";
  for (const std::string& path : {options.response, printer.projector.response}) {
    if (path != "-" && std::filesystem::is_regular_file(path)) job += io::sha256_of(path) + "\n";
  }
  return job;
}

// Before it is opened for writing, which would wait for a pipe.
const std::string& regular(const std::string& path) {
  (void)has_regular_file(path);
  return path;
}

}  // namespace

Initial::Initial(const std::string& path, const model::StackInfo& want) : path_(path), reader_(path) {
  const auto& is = reader_.info();
  io::require(path, is, model::Kind::sinogram, want.space);
  if (is.width == want.width && is.height == want.height && is.count == want.count) return;
  const auto size = [](const model::StackInfo& s) {
    return std::to_string(s.width) + " columns x " + std::to_string(s.height) + " angles x " + std::to_string(s.count) +
           " slices";
  };
  throw Error{Fault::data, path + ": " + size(is) + ", but the target needs " + size(want) +
                               "; use the same target, --angles and --detector-bins"};
}

Image Initial::operator()(int k) {
  constexpr int kept = 64;
  const model::StackInfo& is = reader_.info();
  if (k >= is.count) return {is.width, is.height};
  model::ImageInfo about;
  for (; next_ <= k; ++next_) {
    Image image;
    if (!reader_.next(image, about)) throw Error{Fault::data, path_ + ": ends at slice " + std::to_string(next_)};
    recent_.emplace(next_, std::move(image));
    recent_.erase(next_ - kept);
  }
  return recent_.at(k);
}

Checkpoint::Checkpoint(const cli::App& app, const model::Printer& printer, const Options& options)
    : path_(regular(options.checkpoint)),
      job_(job_of(app, printer, options)),
      out_(path_),
      to_(optimize::Archive::Direction::out, path_,
          [this](void* bytes, std::size_t size) { out_.write(bytes, size); }) {
  if (!std::filesystem::exists(path_)) return;
  in_.emplace(path_);
  from_.emplace(
      optimize::Archive::Direction::in, path_, [this](void* bytes, std::size_t size) { take(bytes, size); },
      [this] { return in_->at_end(); });
}

void Checkpoint::take(void* bytes, std::size_t size) {
  const std::size_t got = in_->read(bytes, size);
  if (got == size) return;
  throw Error{Fault::data, path_ + ": ends after " + std::to_string(in_->position()) +
                               " bytes, which is incomplete; remove it and start again"};
}

optimize::CheckpointState Checkpoint::state() { return {device::interrupted, &to_, from_ ? &*from_ : nullptr, job_}; }

void Checkpoint::remove() const {
  if (in_) std::filesystem::remove(path_);
}

}  // namespace vam::optimize_tool
