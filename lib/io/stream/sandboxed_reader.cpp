// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/sandboxed_reader.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/stream/private/sandbox.hpp"

namespace vam::io {

namespace {

constexpr std::size_t line_limit = 4096;
constexpr double least_bytes = 1 << 24;  // for the smallest file
constexpr const char* remedy = "close other programs";

// The limit of addresses of this process, in bytes; 0 where there is none.
std::uint64_t most_addresses() {
  rlimit most{};
  return getrlimit(RLIMIT_AS, &most) == 0 && most.rlim_cur != RLIM_INFINITY ? most.rlim_cur : 0;
}

// What the child was refused. `limit` of the system where it is lower than the bound, else 0.
Error out_of_memory(const Foreign& source, const ResourceBounds& bounds, std::uint64_t limit) {
  if (limit > 0) {
    return {Fault::memory, source.name + ": requires more memory than the limit of " + std::to_string(limit >> 20U) +
                               " MiB of addresses leaves; raise it (ulimit -v)"};
  }
  const std::string all =
      source.name + ": requires more than " + in_gib(static_cast<double>(bounds.memory_bytes)) + " of memory, ";
  if (source.bytes == 0) return {Fault::data, all + "all that is left; it is damaged"};
  if (!bounds.scarce) return {Fault::data, all + "the most for a file of its size; it is damaged"};
  return {Fault::memory, all + "all that is left; " + remedy + ", or allow more with " + memory_bound_name()};
}

// The memory and the socket of one reading, and the child until it has been waited for.
class Child {
 public:
  Child() {
    std::array<int, 2> ends{};
    void* memory = mmap(nullptr, 2 * slot_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    slots.memory = static_cast<char*>(memory);
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
    slots.socket = ends[0];
    childs_end = ends[1];
  }
  ~Child() {
    if (process > 0) {
      kill(process, SIGKILL);
      (void)wait();
    }
    for (const int end : {slots.socket, childs_end}) {
      if (end >= 0) close(end);
    }
    munmap(slots.memory, 2 * slot_bytes);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void start() {
    process = slots.socket < 0 ? -1 : fork();
    if (process > 0) {
      close(childs_end);
      childs_end = -1;
    }
  }
  // How it ended, as waitpid() says; 0 also where somebody else has waited for it.
  int wait() {
    int ended = 0;
    while (waitpid(process, &ended, 0) < 0 && errno == EINTR) continue;
    process = -1;
    return ended;
  }

  SharedBuffers slots;
  int childs_end = -1;
  pid_t process = -1;
};

void send_verdict(int socket, int fault, const std::string& line) {
  const auto size = static_cast<std::uint32_t>(std::min(line.size(), line_limit));
  const std::array<std::uint32_t, 3> head{last_word, static_cast<std::uint32_t>(fault), size};
  if (write_fully(socket, head.data(), sizeof head)) (void)write_fully(socket, line.data(), size);
}

[[noreturn]] void run_child(SharedBuffers slots, const ResourceBounds& bounds, const Foreign& source,
                            const std::function<void(Sender&)>& parse, int parent) {
  int fault = 0;
  std::string line;
  std::uint64_t limit = most_addresses();  // which can no longer be asked for when the child is confined
  try {
    if (confine(bounds, parent, {slots.socket, source.descriptor})) limit = 0;
    Sender sender(slots);
    parse(sender);
    sender.flush();
  } catch (const Error& error) {
    fault = static_cast<int>(error.fault);
    line = error.what();
  } catch (const std::bad_alloc&) {
    const Error refused = out_of_memory(source, bounds, limit);
    fault = static_cast<int>(refused.fault);
    line = refused.what();
  } catch (const std::exception& error) {
    const bool sentence = dynamic_cast<const std::runtime_error*>(&error) != nullptr;
    fault = static_cast<int>(Fault::data);
    line = source.name + (sentence ? ": " : ": is damaged: ") + error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
  }
  send_verdict(slots.socket, fault, line);
  _exit(0);  // nothing is destroyed, nobody else's buffers are flushed
}

std::string cause_of(int ended, const ResourceBounds& bounds) {
  if (!WIFSIGNALED(ended)) return "its reader ended early";
  const int number = WTERMSIG(ended);
  if (number == SIGXCPU) return "its reader took more than " + std::to_string(bounds.cpu_s) + " s of processor time";
  const char* name = sigdescr_np(number);
  return "its reader was ended by signal " + std::to_string(number) + " (" + (name != nullptr ? name : "unknown") + ")";
}

// After the word that announces it.
void take_verdict(Child& child) {
  std::array<std::uint32_t, 2> head{};
  std::string line;
  bool whole = read_fully(child.slots.socket, head.data(), sizeof head) && head[1] <= line_limit;
  if (whole) {
    line.resize(head[1]);
    whole = read_fully(child.slots.socket, line.data(), line.size());
  }
  if (whole && head[0] == 0) return;
  if (!whole) throw ChildEnded{};
  throw Error{static_cast<Fault>(head[0]), line};
}

}  // namespace

struct SandboxedReader::State {
  State(Foreign what, const std::function<void(Sender&)>& parse)
      : source(std::move(what)), bounds(bounds_of(source.bytes, source.unpacked)) {
    require_memory(least_bytes, source.name, remedy);
    const int parent = getpid();
    child.start();
    if (child.process == 0) {
      SharedBuffers slots = child.slots;
      slots.socket = child.childs_end;
      run_child(slots, bounds, source, parse, parent);
    }
    if (child.process < 0) {
      throw system_error(Fault::memory, source.name + ": cannot start the process that parses it", errno,
                         "raise the limit on processes (ulimit -u)");
    }
  }

  // Why the child has not sent what was requested.
  [[noreturn]] void explain() {
    try {
      if (receiver.drain()) take_verdict(child);
    } catch (const ChildEnded&) {
      (void)receiver;  // it ended within its verdict
    }
    const std::string cause = cause_of(child.wait(), bounds);
    throw Error{Fault::data, source.name + ": is damaged: " + cause + "; make the file again"};
  }

  Foreign source;
  ResourceBounds bounds;
  Child child;
  Receiver receiver{child.slots};
};

SandboxedReader::SandboxedReader(Foreign source, const std::function<void(Sender&)>& parse)
    : state_(std::make_unique<State>(std::move(source), parse)) {}

SandboxedReader::~SandboxedReader() = default;

void SandboxedReader::take(const std::function<void(Receiver&)>& take) {
  try {
    take(state_->receiver);
  } catch (const ChildEnded&) {
    state_->explain();
  }
}

void SandboxedReader::finish() {
  try {
    if (!state_->receiver.drain()) throw ChildEnded{};
    take_verdict(state_->child);
  } catch (const ChildEnded&) {
    state_->explain();
  }
  (void)state_->child.wait();
}

void read_apart(const Foreign& source, const std::function<void(Sender&)>& parse,
                const std::function<void(Receiver&)>& take) {
  SandboxedReader apart(source, parse);
  apart.take(take);
  apart.finish();
}

}  // namespace vam::io
