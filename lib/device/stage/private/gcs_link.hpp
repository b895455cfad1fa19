// SPDX-License-Identifier: GPL-3.0-or-later
// Questions and orders in PI's General Command Set 2.0 (C-863, C-663 and relatives).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "device/os/clock.hpp"
#include "device/port/port.hpp"

namespace vam::device {

struct GcsSettings {
  std::optional<int> address;  // of a controller in a daisy chain; absent: the one that answers bare commands, number 1
  double timeout_s = 0.2;      // without a byte; less than the guardian's patience
};

/// An answer and when it came: the controller read its axis at some time between t0_s and t1_s.
struct GcsAnswer {
  std::vector<std::string> lines;
  double t0_s = 0;
  double t1_s = 0;
};

/// Speaks the protocol: mnemonic, blanks, LF. Orders do not answer, so each is followed by "ERR?", which also clears.
/// A line of an answer ends at LF; one with a blank before its LF is followed by another. Answers of a chain begin with
/// "0 <address> "; they are checked against the address. Throws Error: busy (no complete answer in time), protocol (not
/// printable, wrong sender, longer than 64 KiB, error code), absent (unplugged).
class GcsLink {
 public:
  GcsLink(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings);

  /// Sends an order and asks whether it was accepted. Errors listed in `harmless` are not thrown.
  void order(const std::string& text, int harmless = 0);
  [[nodiscard]] GcsAnswer ask(const std::string& text);
  /// "POS? 1" answers "1=12.5": the value behind the sign, a finite number.
  [[nodiscard]] double ask_number(const std::string& text, double* t0_s = nullptr, double* t1_s = nullptr);
  /// Single-byte commands without LF: #5 motion bits (hexadecimal), #7 ready (one byte, 0xB1 or 0xB0).
  [[nodiscard]] unsigned motion_bits();
  [[nodiscard]] bool ready();
  /// #24: stops everything at once; sets error 10.
  void halt_now();
  /// The pending error, 0 for none; asking clears it.
  [[nodiscard]] int take_error();

  [[nodiscard]] Port& port() { return *port_; }
  /// Gives the port away; the link is of no use afterwards.
  [[nodiscard]] std::unique_ptr<Port> take_port() { return std::move(port_); }
  [[nodiscard]] const GcsSettings& settings() const { return settings_; }
  [[nodiscard]] Error malformed(const std::string& question, const std::string& answer, const std::string& what) const;

 private:
  double send(const std::string& text);  // when, no later than the first byte left
  std::string read_more(const std::string& question, const std::string& so_far);
  std::string without_sender(const std::string& question, const std::string& line) const;

  std::unique_ptr<Port> port_;
  Clock& clock_;
  GcsSettings settings_;
};

/// The command as the controller of that address takes it: in a daisy chain the address precedes single bytes, too
/// (PI MS249E, 8.3 "Target and sender address").
[[nodiscard]] std::string addressed(const std::string& bytes, const GcsSettings& settings);

/// "7 (beyond the limits of travel)"
[[nodiscard]] std::string gcs_error_text(int code);

}  // namespace vam::device
