// SPDX-License-Identifier: GPL-3.0-or-later
// Archives out of FUZZ_SOURCE, File or Pipe, as the child reads them; what it sends is received as by its parent.
#include <sys/socket.h>

#include <array>
#include <thread>
#include <vector>

#include "fuzz/fuzz.hpp"
#include "io/stream/private/sandbox.hpp"
#include "io/vdb/private/serialisation.hpp"

namespace {

struct Taker {
  void start(const vam::io::GridHead&) {}
  void other(const std::string&) {}
  void tile(const vam::io::TileRecord&) {}
  void leaf() { in.get(&record, sizeof record); }
  vam::io::Receiver& in;
  vam::io::LeafRecord record{};
};

void receive(vam::io::SharedBuffers slots) {
  try {
    vam::io::Receiver in(slots);
    Taker taker{in};
    receive_records(in, taker);
    (void)in.drain();
  } catch (const vam::io::ChildEnded&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size > fuzz::Pipe::room) return -1;
  const fuzz::FUZZ_SOURCE source(fuzz::text_of(bytes, size));
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) abort();
  std::vector<char> memory(2 * vam::io::slot_bytes);
  std::thread parent(receive, vam::io::SharedBuffers{memory.data(), ends[0]});
  vam::io::SharedBuffers slots{memory.data(), ends[1]};
  fuzz::attempt_in_child([&] {
    vam::io::InputFile file(source.path);
    vam::io::Sender out(slots);
    std::vector<std::shared_ptr<void>> kept;
    pass_archives(file, false, out, kept);
    out.flush();
  });
  shutdown(ends[1], SHUT_RDWR);
  parent.join();
  for (const int end : ends) close(end);
  return 0;
}
