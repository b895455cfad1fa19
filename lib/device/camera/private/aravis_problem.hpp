// SPDX-License-Identifier: GPL-3.0-or-later
// What went wrong in a call of Aravis.
#pragma once

#include <string>

struct _GError;  // NOLINT: glib's own name, whose header stays in the sources

namespace vam::device {

/// Collects Aravis' messages; one problem at a time.
class AravisProblem {
 public:
  AravisProblem() = default;
  ~AravisProblem();
  AravisProblem(const AravisProblem&) = delete;
  AravisProblem& operator=(const AravisProblem&) = delete;
  operator _GError**();  // NOLINT: the calls of Aravis take it as their last argument
  [[nodiscard]] bool there() const { return error_ != nullptr; }
  /// The camera does not answer any more.
  [[nodiscard]] bool timed_out() const;
  [[nodiscard]] std::string text() const;

 private:
  _GError* error_ = nullptr;
};

}  // namespace vam::device
