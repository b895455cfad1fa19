// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/v4l2_node.hpp"

#include <cerrno>

namespace vam::device {

Error V4l2Node::gone() const {
  return {Fault::absent, path + ": the camera is disconnected (" + std::strerror(errno) + "); check cable and power"};
}

Error V4l2Node::refusal(const std::string& what) const {
  if (errno == ENODEV) return gone();
  return {errno == EBUSY ? Fault::busy : Fault::protocol, path + ": " + what + " (" + std::strerror(errno) + ")"};
}

void V4l2Node::ask(unsigned long request, void* argument, const std::string& what) const {
  if (driver->control(request, argument) != 0) throw refusal(what);
}

}  // namespace vam::device
