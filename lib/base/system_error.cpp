// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/system_error.hpp"

#include <cerrno>
#include <cstring>

namespace vam {

Error system_error(Fault fault, const std::string& what, int problem, const std::string& remedy) {
  const std::string line = what + ": " + std::strerror(problem);
  if (problem == EMFILE) return {Fault::memory, line + "; raise the limit (ulimit -n)"};
  if (problem == ENFILE) return {Fault::memory, line + "; close other programs"};
  return {fault, line + (remedy.empty() ? "" : "; " + remedy)};
}

}  // namespace vam
