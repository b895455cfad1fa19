// SPDX-License-Identifier: GPL-3.0-or-later
// A grid's head on its way from the child that reads archives.
#include "io/vdb/private/serialisation.hpp"

#include "io/stream/serialisation.hpp"

namespace vam::io {

namespace {

template <class Pass>
void pass_head(const Pass& pass, GridHead& head) {
  VolumeFacts& facts = head.facts;
  pass(facts.name);
  pass(facts.grid);
  pass(facts.background);
  pass(facts.units);
  pass(facts.level_set);
  pass(facts.seal);
  pass(head.unique_name);
  pass(head.shares);
  for (int axis = 0; axis < 3; ++axis) pass(head.first[axis]);
  pass(head.zero_mm);
  pass(facts.history);
  pass(facts.metadata);
}

}  // namespace

void send_head(GridHead head, Sender& out) {
  out.put(Record::grid);
  pass_head(Writer{out}, head);
}

GridHead receive_head(Receiver& in) {
  GridHead head;
  pass_head(Reader{in}, head);
  return head;
}

}  // namespace vam::io
