// SPDX-License-Identifier: GPL-3.0-or-later
// New frames for a print that goes on.
#pragma once

#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "base/error.hpp"
#include "vam-project/live.hpp"

namespace vam::project {

/// Sinograms that appear in a folder or take the place of others in it, by a thread of its own; of several the last.
/// Those that are there when it begins are of an earlier print. Whatever goes wrong is logged, and the print goes on.
class Renewal {
 public:
  /// Offers what is made of a sinogram; throws Error where it is not for this print, and may throw anything once it
  /// has ended.
  using Make = std::function<void(const std::string& path, const std::atomic<bool>& ended)>;
  /// Throws Fault::no_input when the folder cannot be read.
  Renewal(std::string folder, Live& live, Make make);
  ~Renewal();
  Renewal(const Renewal&) = delete;
  Renewal& operator=(const Renewal&) = delete;

 private:
  void watch();
  void look();
  void refuse(const std::string& message);

  std::string folder_;
  Live& live_;
  Make make_;
  std::set<std::string> seen_;  // by name and what the file system knows of the file
  std::string refused_;         // last
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

/// The frames as a screen takes them.
class ScreenSink final : public io::FrameSink {
 public:
  ScreenSink(const device::DisplayMode& mode, const std::atomic<bool>& ended) : mode_(mode), ended_(ended) {}
  void write(std::span<const io::ProjectorFrame> frames) override {
    if (ended_) throw Error{Fault::busy, "the print has ended"};
    for (const auto& frame : frames) bytes.push_back(device::screen_bytes(frame.levels, mode_));
  }
  void commit() override {}

  device::ScreenFrames bytes;

 private:
  device::DisplayMode mode_;
  const std::atomic<bool>& ended_;
};

}  // namespace vam::project
