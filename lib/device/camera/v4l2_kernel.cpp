// SPDX-License-Identifier: GPL-3.0-or-later
// The system calls on a video node.
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "base/index.hpp"
#include "device/camera/v4l2_driver.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

class KernelV4l2 final : public V4l2Driver {
 public:
  ~KernelV4l2() override { KernelV4l2::close(); }
  int open(const char* path) override { return fd_ = ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC); }
  int control(unsigned long request, void* argument) override {
    int result = 0;
    do {
      result = ioctl(fd_, request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
  }
  void* map(std::size_t size, std::size_t offset) override {
    return mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(offset));
  }
  void unmap(void* start, std::size_t size) override { munmap(start, size); }
  int wait(double seconds) override {
    std::array<pollfd, 2> ready{pollfd{fd_, POLLIN, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
    if (poll(ready.data(), ready.size(), ceil_int(1e3 * seconds)) <= 0) return 0;
    if ((ready[0].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return -1;
    return (ready[0].revents & POLLIN) != 0 ? 1 : 0;
  }
  void close() override {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_ = -1;
};

}  // namespace

std::unique_ptr<V4l2Driver> kernel_v4l2() { return std::make_unique<KernelV4l2>(); }

}  // namespace vam::device
