// SPDX-License-Identifier: GPL-3.0-or-later
// Serialisation of the results of a parsing child process, one list of members for writing and reading:
// pass(Writer{out}, facts) there, pass(Reader{in}, facts) here.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/stream/sandboxed_reader.hpp"

namespace vam::io {

inline constexpr std::uint64_t most_lines = 1 << 20;  // of a list

/// To the parent. Throws as Sender does.
struct Writer {
  Sender& out;
  void operator()(const std::string& text) const { out.put(text); }
  void operator()(const std::vector<std::string>& lines) const {
    out.put(std::uint64_t{lines.size()});
    for (const std::string& line : lines) out.put(line);
  }
  void operator()(const std::map<std::string, std::string>& texts) const {
    out.put(std::uint64_t{texts.size()});
    for (const auto& [key, value] : texts) {
      out.put(key);
      out.put(value);
    }
  }
  template <class Value>
  void operator()(const Value& value) const {
    out.put(value);
  }
};

/// From the child. Throws Fault::data for more than most_lines and for a child that ended, as Receiver does.
struct Reader {
  Receiver& in;
  void operator()(std::string& text) const { text = in.get_text(); }
  void operator()(std::vector<std::string>& lines) const {
    for (auto left = in.get_count(most_lines); left > 0; --left) lines.push_back(in.get_text());
  }
  void operator()(std::map<std::string, std::string>& texts) const {
    for (auto left = in.get_count(most_lines); left > 0; --left) {
      std::string key = in.get_text();
      texts[std::move(key)] = in.get_text();
    }
  }
  template <class Value>
  void operator()(Value& value) const {
    value = in.get<Value>();
  }
};

}  // namespace vam::io
