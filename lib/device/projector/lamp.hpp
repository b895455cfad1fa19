// SPDX-License-Identifier: GPL-3.0-or-later
// What lights a print: a light engine, a relay in its supply, or both.
#pragma once

namespace vam::device {

class Lamp {
 public:
  virtual ~Lamp() = default;
  virtual void on() = 0;
  /// Off and verified, at the end of a print. Throws what its devices throw.
  virtual void dark() = 0;
  /// Off by the fastest means first, when a print fails. Throws as dark().
  virtual void cut() { dark(); }
};

}  // namespace vam::device
