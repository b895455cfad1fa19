// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/guardian.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "device/safety/private/guardian_child.hpp"

namespace vam::device {

Guardian::Guardian(double stall_s) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw system_error(Fault::bug, "guardian: no socket", errno);
  }
  const pid_t parent = getpid();
  child_ = fork();
  if (child_ < 0)
    throw system_error(Fault::memory, "guardian: cannot fork", errno, "raise the limit on processes (ulimit -u)");
  if (child_ == 0) {
    close(ends[0]);
    guard(ends[1], parent, stall_s);  // never returns
  }
  close(ends[1]);
  socket_ = ends[0];
}

void Guardian::send(char kind, int id, const std::string& text, int handle) {
  std::string packet = kind + std::to_string(id) + " " + text;
  iovec part{packet.data(), packet.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  if (handle >= 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &handle, sizeof(int));
  }
  if (sendmsg(socket_, &message, MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
    throw Error{Fault::bug, "guardian: process " + std::to_string(child_) + " does not respond (" +
                                std::strerror(errno) + "); motion and projection are disabled without it"};
  }
}

int Guardian::add(const Json& action, int handle) {
  send('a', next_id_, action.dump(), handle);
  return next_id_++;
}

void Guardian::forget(int id) { send('f', id, "", -1); }

void Guardian::keep(int handle) { send('k', 0, "", handle); }

void Guardian::beat() { send('b', 0, "", -1); }

Guardian::~Guardian() {
  const std::string quietly = "q0 ";
  ::send(socket_, quietly.data(), quietly.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  // The child closes its end when it is done; it bounds its own time, and this wait bounds it again.
  pollfd ended{socket_, 0, 0};
  poll(&ended, 1, 1000);
  close(socket_);
  waitpid(child_, nullptr, (ended.revents & POLLHUP) != 0 ? 0 : WNOHANG);
}

}  // namespace vam::device
