// SPDX-License-Identifier: GPL-3.0-or-later
// GLib's sockets, which find GigE cameras, make a process ignore SIGPIPE for good: a tool whose reader has gone (head)
// would fail with "Broken pipe" instead of ending quietly.
#pragma once

#include <csignal>

namespace vam::device {

/// What SIGPIPE does is afterwards as it was before.
class KeptSigpipe {
 public:
  KeptSigpipe() { sigaction(SIGPIPE, nullptr, &before_); }
  ~KeptSigpipe() { sigaction(SIGPIPE, &before_, nullptr); }
  KeptSigpipe(const KeptSigpipe&) = delete;
  KeptSigpipe& operator=(const KeptSigpipe&) = delete;

 private:
  struct sigaction before_ {};
};

}  // namespace vam::device
