// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/npy_head.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <vector>

#include "base/text/printable.hpp"

namespace vam::io::arrays {

namespace {

[[noreturn]] void damaged() {
  throw std::runtime_error("its NumPy header is damaged; save the array again with numpy.save()");
}

/// The literals of a Python dictionary, front to back.
class Literals {
 public:
  explicit Literals(std::string_view text) : left_(text) {}

  bool takes(std::string_view word) {
    left_.remove_prefix(std::min(left_.find_first_not_of(" \n"), left_.size()));
    if (!left_.starts_with(word)) return false;
    left_.remove_prefix(word.size());
    return true;
  }
  void expect(std::string_view word) {
    if (!takes(word)) damaged();
  }
  std::string quoted() {
    const std::string_view quote = takes("'") ? "'" : "\"";
    if (quote == "\"") expect(quote);
    const std::size_t end = left_.find(quote);
    if (end == std::string_view::npos) damaged();
    std::string text(left_.substr(0, end));
    left_.remove_prefix(end + 1);
    return text;
  }
  std::uint64_t number() {
    takes("");
    std::uint64_t value = 0;
    const auto [end, problem] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
    if (problem == std::errc::result_out_of_range) throw std::runtime_error("its sizes exceed all memory");
    if (problem != std::errc{}) damaged();
    left_.remove_prefix(end - left_.data());
    takes("L");  // of Python 2
    return value;
  }

 private:
  std::string_view left_;
};

[[noreturn]] void refuse_type(const std::string& type, char kind) {
  if (kind == 'O') {
    throw std::runtime_error(
        "holds Python objects (a pickle), which are never read, as they can run any code; save "
        "numbers: array.astype('f4')");
  }
  throw std::runtime_error("has values of type " + excerpt(type) +
                           "; whole numbers of 1, 2, 4 or 8 bytes, floats of 2, 4 or "
                           "8 and truth are read: array.astype('f4')");
}

void set_type(const std::string& type, Head& head) {
  const std::size_t at = type.find_first_not_of("<>|=");
  if (at == std::string::npos) damaged();
  head.kind = type[at];
  head.big_endian = type[0] == '>';
  const std::string size = type.substr(at + 1);
  const bool known =
      (head.kind == 'b' && size == "1") || (head.kind == 'f' && size != "1") || head.kind == 'i' || head.kind == 'u';
  if (!known || size.size() != 1 || std::string_view("1248").find(size) == std::string_view::npos) {
    refuse_type(type, head.kind);
  }
  head.bytes = size[0] - '0';
}

std::vector<std::uint64_t> taken_shape(Literals& text) {
  std::vector<std::uint64_t> shape;
  text.expect("(");
  while (!text.takes(")")) {
    if (shape.size() > 32) damaged();
    shape.push_back(text.number());
    if (text.takes(")")) break;
    text.expect(",");
  }
  return shape;
}

}  // namespace

Head take_npy_head(Bytes& bytes) {
  constexpr std::size_t start_bytes = 8;  // magic and version; the length of the header text follows
  constexpr std::uint64_t most_text = 1 << 16;
  std::array<unsigned char, start_bytes> start{};
  bytes.take(start.data(), start.size());
  std::array<unsigned char, 4> length{};
  bytes.take(length.data(), start[6] == 1 ? 2 : 4);
  if (start[6] < 1 || start[6] > 3 ||
      std::string_view(reinterpret_cast<const char*>(start.data()), npy_magic.size()) != npy_magic) {
    throw std::runtime_error("is not a NumPy array of version 1 to 3");
  }
  const std::size_t size = length[0] | length[1] << 8 | length[2] << 16 | std::size_t{length[3]} << 24;
  if (size > most_text) damaged();
  std::string text(size, '\0');
  bytes.take(text.data(), text.size());
  return parse_npy_head(text);
}

Head parse_npy_head(std::string_view text) {
  Head head;
  Literals literals(text);
  int known = 0;
  literals.expect("{");
  while (!literals.takes("}")) {
    const std::string key = literals.quoted();
    literals.expect(":");
    if (key == "descr") {
      if (literals.takes("[")) throw std::runtime_error("holds records of several fields; save one field of the array");
      set_type(literals.quoted(), head);
    } else if (key == "fortran_order") {
      head.fortran = literals.takes("True");
      if (!head.fortran) literals.expect("False");
    } else if (key == "shape") {
      set_shape(taken_shape(literals), head);
    } else {
      damaged();
    }
    ++known;
    if (!literals.takes(",")) {
      literals.expect("}");
      break;
    }
  }
  if (known != 3 || head.values() == 0) damaged();
  return head;
}

std::string head_of_floats(const std::array<int, 3>& shape) {
  std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(shape[0]) + ", " +
                     std::to_string(shape[1]) + ", " + std::to_string(shape[2]) + "), }";
  const std::size_t before = npy_magic.size() + 4;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  const auto size = static_cast<std::uint16_t>(text.size());
  return std::string(npy_magic) + '\1' + '\0' + static_cast<char>(size & 255) + static_cast<char>(size >> 8) + text;
}

}  // namespace vam::io::arrays
