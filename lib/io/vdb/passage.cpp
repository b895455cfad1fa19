// A grid's head on its way from the child that reads archives.
#include "io/vdb/private/passage.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t most_lines = 1 << 20;  // of history and metadata

// Both directions from one list of members.
struct Put {
  Sender& out;
  void operator()(std::string& text) const { out.put(text); }
  template <class Value>
  void operator()(Value& value) const {
    out.put(value);
  }
};

struct Get {
  Receiver& in;
  void operator()(std::string& text) const { text = in.get_text(); }
  template <class Value>
  void operator()(Value& value) const {
    value = in.get<Value>();
  }
};

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
}

}  // namespace

void send_head(GridHead head, Sender& out) {
  out.put(Record::grid);
  pass_head(Put{out}, head);
  out.put(std::uint64_t{head.facts.history.size()});
  for (const std::string& line : head.facts.history) out.put(line);
  out.put(std::uint64_t{head.facts.metadata.size()});
  for (const auto& [key, value] : head.facts.metadata) {
    out.put(key);
    out.put(value);
  }
}

GridHead receive_head(Receiver& in) {
  GridHead head;
  pass_head(Get{in}, head);
  for (auto left = in.get_count(most_lines); left > 0; --left) head.facts.history.push_back(in.get_text());
  for (auto left = in.get_count(most_lines); left > 0; --left) {
    std::string key = in.get_text();
    head.facts.metadata[std::move(key)] = in.get_text();
  }
  return head;
}

}  // namespace vam::io
