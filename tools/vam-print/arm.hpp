// SPDX-License-Identifier: GPL-3.0-or-later
// Before anything moves or is lit: records, settings and devices are in order.
#pragma once

#include <string>

#include "vam-print/run.hpp"

namespace vam::print_tool {

/// Makes the folder of the run, which no other print has. Throws Fault::no_output.
void make_folder(Run& run);

/// Freezes the settings in the folder of the run and asks every device. Throws Error and Ended; what is refused is
/// said.
void arm(Run& run);

/// --plan: the same steps in a folder of their own, each with what can be known of the print, also where one fails.
/// Returns the status of the first that failed.
[[nodiscard]] int print_plan(Run& run);

// The print that is resumed: what remains is given once, in the same light, at the same place.

/// Takes over what remains of options.resume: turns and angle, and unless others are given its settings. Throws Error:
/// data (its logs were changed, it is complete, was resumed, is of another sinogram), no_input, busy (it goes on).
void take_over(Run& run);

/// Throws Fault::data where the settings in force would change dose or place of what remains, which is said where it
/// is accepted.
void require_same_settings(const Run& run);

/// Throws Ended where the device `name` is not that of the run whose settings these are.
void require_same_device(const Run& run, const std::string& name);

/// The mark in the folder of the print that is resumed, and in its events.
class Claim {
 public:
  /// Throws Fault::data where another print has it, Fault::no_output where it cannot be written.
  void take(const Run& run);
  /// A resumption without light has given nothing: the print can be resumed as before.
  void release(const Run& run, bool lit);

 private:
  std::string mark_;  // empty: not taken
};

}  // namespace vam::print_tool
