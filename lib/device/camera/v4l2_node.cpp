#include "device/camera/private/v4l2_node.hpp"

#include <cerrno>

namespace vam::device {

Error V4l2Node::gone() const {
  return {Fault::absent, path + ": the camera is disconnected (" + std::strerror(errno) + ")"};
}

void V4l2Node::ask(unsigned long request, void* argument, const std::string& what) const {
  if (driver->control(request, argument) == 0) return;
  if (errno == ENODEV) throw gone();
  const Fault fault = errno == EBUSY ? Fault::busy : Fault::protocol;
  throw Error{fault, path + ": " + what + " (" + std::strerror(errno) + ")"};
}

}  // namespace vam::device
