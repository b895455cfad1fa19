// SPDX-License-Identifier: GPL-3.0-or-later
// A serial line whose other end says what it was told to say.
#pragma once

#include <string>
#include <utility>

#include "device/os/clock.hpp"
#include "device/port/port.hpp"
#include "fuzz/fuzz.hpp"

namespace fuzz {

/// A line or a few bytes at a time, whatever is asked. When there is nothing left, the time-out passes.
class Answers final : public vam::device::Port {
 public:
  Answers(std::string bytes, vam::device::VirtualClock& clock) : bytes_(std::move(bytes)), clock_(clock) {}
  void write(std::string_view) override {}
  std::string read(double timeout_s) override {
    if (at_ >= bytes_.size()) {
      clock_.sleep_until(clock_.now_s() + timeout_s);
      return "";
    }
    clock_.sleep_until(clock_.now_s() + 0.001);
    const std::size_t end = bytes_.find('\n', at_);
    const std::size_t size = end == std::string::npos ? 1 : end + 1 - at_;
    const std::string part = bytes_.substr(at_, size);
    at_ += size;
    return part;
  }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
  vam::device::VirtualClock& clock_;
  std::string name_ = "port";
};

}  // namespace fuzz
