// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/guardian.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <vector>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/os/process.hpp"
#include "device/safety/guardian_actions.hpp"

namespace vam::device {

namespace {

// The child's side of the guardian.

struct Action {
  Json what;
  int handle = -1;
};

struct Request {
  char kind = 0;  // 0: the parent's end is closed
  int id = 0;
  std::string text;
  int handle = -1;
};

Request receive(int socket) {
  std::array<char, 65536> bytes{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  iovec part{bytes.data(), bytes.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  if (size <= 0) return {};
  Request request;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_type == SCM_RIGHTS) {
    std::memcpy(&request.handle, CMSG_DATA(header), sizeof(int));
  }
  const std::string all(bytes.data(), size);
  const std::size_t blank = all.find(' ');
  request.kind = all[0];
  request.id = std::atoi(all.substr(1, blank - 1).c_str());
  request.text = all.substr(blank + 1);
  return request;
}

// Terminal signals reach the whole group, and a closing terminal the whole session: leave both, and ignore the rest.
// Standard input and output belong to the tool's pipes, whose other ends must see them closed when the tool dies. Their
// numbers stay taken: as 0 or 1 a device's handle would get whatever a library prints.
void detach(int socket) {
  setsid();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP, SIGUSR1, SIGUSR2}) {
    std::signal(signal, SIG_IGN);
  }
  const auto low = static_cast<unsigned>(socket);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int number : {STDIN_FILENO, STDOUT_FILENO}) {
    if (number != socket) dup2(nowhere, number);
  }
  if (low > 3) close_range(3, low - 1, 0);
  close_range(low + 1, ~0U, 0);
}

volatile std::sig_atomic_t bereft = 0;  // NOLINT: set by a signal, of which there is one in the process

// The thread that the guardian was forked from has ended. Its socket is closed only when the last thread has: on a busy
// machine those of libraries, which have no priority, take a tenth of a second to end. The signal is heard only while
// the guardian waits (the mask that is returned): it must not interrupt a device's write.
sigset_t hear_of_the_end() {
  struct sigaction action {};
  action.sa_handler = [](int) { bereft = 1; };
  sigaction(SIGUSR1, &action, nullptr);
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGUSR1);
  sigset_t waiting;
  sigprocmask(SIG_BLOCK, &end, &waiting);
  sigdelset(&waiting, SIGUSR1);
  prctl(PR_SET_PDEATHSIG, SIGUSR1);
  return waiting;
}

int wait_for(pollfd& readable, double seconds, const sigset_t& waiting) {  // < 0: for ever
  const auto whole = static_cast<time_t>(std::max(0.0, seconds));
  const timespec limit{whole, static_cast<long>((std::max(0.0, seconds) - static_cast<double>(whole)) * 1e9)};
  return ppoll(&readable, 1, seconds < 0 ? nullptr : &limit, &waiting);
}

std::string carry_all_out(const std::map<int, Action>& actions) {
  std::vector<const Action*> sorted;
  for (const auto& [id, action] : actions) sorted.push_back(&action);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Action* a, const Action* b) {
    return a->what.value("order", 1) < b->what.value("order", 1);
  });
  std::string report;
  for (const Action* action : sorted) {
    const bool done = carry_out(action->what, action->handle);
    report +=
        (report.empty() ? "" : ", ") + action->what.value("name", std::string("device")) + (done ? " safe" : " FAILED");
  }
  return report;
}

/// Serves the socket until the parent is gone or has requested the end, acts, and leaves the process.
/// Packets: kind, number, blank, text, and a descriptor where one belongs: 'a' add an action, 'f' forget it, 'k' keep
/// the descriptor, 'b' beat, 'q' act now without a word on stderr.
void guard(int socket, int parent, double stall_s) {
  detach(socket);
  name_process(guardian_name);
  const sigset_t waiting = hear_of_the_end();
  hurry(Urgency::guardian);
  std::map<int, Action> actions;
  double last_beat_s = real_clock().now_s();
  const char* reason = "ended unexpectedly";
  bool quietly = false;
  for (;;) {
    double wait_s = bereft != 0 ? 0 : -1;  // then what it still asked for
    if (bereft == 0 && !actions.empty()) {
      wait_s = std::max(0.0, last_beat_s + stall_s - real_clock().now_s()) + 0.001;
    }
    pollfd readable{socket, POLLIN, 0};
    const int ready = wait_for(readable, wait_s, waiting);
    if (bereft != 0 && ready <= 0) break;
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      kill(parent, SIGKILL);  // a tool that hangs must not wake up and undo what follows
      reason = "stopped responding and was killed";
      break;
    }
    Request request = receive(socket);
    if (request.kind == 0) break;
    last_beat_s = real_clock().now_s();
    if (request.kind == 'a') actions[request.id] = {Json::parse(request.text, nullptr, false), request.handle};
    if (request.kind == 'f' && actions.contains(request.id)) {
      close(actions[request.id].handle);
      actions.erase(request.id);
    }
    if (request.kind == 'q') {
      quietly = true;
      break;
    }
  }
  const std::string report = carry_all_out(actions);
  if (!actions.empty() && !quietly)
    std::fprintf(stderr, "guardian: process %d %s; %s\n", parent, reason, report.c_str());
  _exit(0);
}

}  // namespace

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
