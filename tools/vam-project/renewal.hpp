// SPDX-License-Identifier: GPL-3.0-or-later
// New frames for a print that goes on.
#pragma once

#include <atomic>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "base/json_fwd.hpp"
#include "vam-project/live.hpp"

namespace vam::project {

/// Sinograms that appear in a folder, by a thread of its own. Those that are there when it begins are of an earlier
/// print.
class Renewal {
 public:
  /// Offers what is made of a sinogram; throws Error where it is not for this print.
  using Make = std::function<void(const std::string& path)>;
  /// Throws Fault::no_input when the folder cannot be read.
  Renewal(std::string folder, Live& live, Make make);
  ~Renewal();
  Renewal(const Renewal&) = delete;
  Renewal& operator=(const Renewal&) = delete;

 private:
  void watch();
  void look();

  std::string folder_;
  Live& live_;
  Make make_;
  std::set<std::string> seen_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

/// The frames as a screen takes them.
class ScreenSink final : public io::FrameSink {
 public:
  explicit ScreenSink(const device::DisplayMode& mode) : mode_(mode) {}
  void write(std::span<const io::ProjectorFrame> frames) override {
    for (const auto& frame : frames) bytes.push_back(device::screen_bytes(frame.levels, mode_));
  }
  void commit() override {}

  device::ScreenFrames bytes;

 private:
  device::DisplayMode mode_;
};

}  // namespace vam::project
