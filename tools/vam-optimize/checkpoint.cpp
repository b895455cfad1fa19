// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/checkpoint.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/text.hpp"
#include "device/os/interrupt.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/log_lines.hpp"

namespace vam::optimize_tool {

std::string job_of(const cli::App& app, const model::Printer& printer, const Options& options) {
  std::string job = io::printer_toml(printer) + app.job();
  job += "raising=" + format_number(options.raising.factor) + "\n";
  if (options.recorded_tolerances) job += model::tolerances_text(*options.printer_tolerances) + "\n";
  for (const std::string& path : {options.response, printer.projector.response}) {
    if (path != "-" && std::filesystem::is_regular_file(path)) job += io::sha256_of(path) + "\n";
  }
  return job;
}

namespace {

// Before it is opened for writing, which would wait for a pipe.
const std::string& regular(const std::string& path) {
  (void)io::has_regular_file(path);
  return path;
}

}  // namespace

Checkpoint::Checkpoint(const std::string& path)
    : path_(regular(path)),
      out_(path),
      to_(optimize::Archive::Way::out, path, [this](void* bytes, std::size_t size) { out_.write(bytes, size); }) {
  if (!std::filesystem::exists(path)) return;
  in_.emplace(path);
  from_.emplace(
      optimize::Archive::Way::in, path, [this](void* bytes, std::size_t size) { take(bytes, size); },
      [this] { return in_->at_end(); });
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
