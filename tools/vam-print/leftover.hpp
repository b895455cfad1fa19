// SPDX-License-Identifier: GPL-3.0-or-later
// What a tool that was killed may have left on. Its guardian makes that safe and says so; where neither has a word
// left, vam-devices does it [devices §7].
#pragma once

#include <string>

#include "vam-print/child.hpp"
#include "vam-print/run.hpp"

namespace vam::print_tool {

/// It is stopped by a signal, and still a child of that process: its number may have gone to another one.
[[nodiscard]] bool is_stopped(const Child& tool, pid_t parent);
/// Kills it, and says why in its name.
void end_stopped(const Run& run, const Child& tool);

/// A tool that has ended drove a device, and neither it nor its guardian has said that all is safe, which is waited for
/// 0.4 s.
[[nodiscard]] bool is_left_on(const Run& run, const Child& tool);

/// vam-devices off, and a line that says of what: "project was", and what is not off.
void switch_off(const Run& run, const std::string& who);

/// A process that outlives this one, however that ends: it ends a tool that is stopped by a signal, twice in a second,
/// as the others would wait for it, the light on; and switches off what this process can no longer see to.
class Steward {
 public:
  /// To be made before this process has threads. It does not keep `lock` open.
  Steward(const Run& run, const std::vector<Child>& tools, int lock);
  ~Steward();
  Steward(const Steward&) = delete;
  Steward& operator=(const Steward&) = delete;

 private:
  pid_t pid_ = -1;
};

}  // namespace vam::print_tool
