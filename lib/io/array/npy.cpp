// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy's arrays, bare (.npy) and in zip archives (.npz).
#include <algorithm>
#include <bit>
#include <charconv>
#include <stdexcept>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/array/array_file.hpp"
#include "io/array/private/array.hpp"

namespace vam::io {

namespace arrays {

namespace {

[[noreturn]] void damaged() { throw std::runtime_error("its NumPy header is damaged; save the array again"); }

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
  if (kind == 'O') throw std::runtime_error("holds Python objects (a pickle), which can run any code; save numbers");
  throw std::runtime_error("has values of type " + excerpt(type) +
                           "; save whole numbers of 1, 2, 4 or 8 bytes, floats of 2, 4 or 8, or truth");
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

constexpr std::string_view ending = ".npy";

std::string chosen(const ZipArchive& archive, const std::string& name, const std::string& file) {
  std::vector<std::string> names;
  for (const std::string& all : archive.names()) {
    if (all.ends_with(ending)) names.push_back(all.substr(0, all.size() - ending.size()));
  }
  if (names.empty()) throw Error{Fault::data, file + ": is a zip archive without an array (.npy)"};
  if (name.empty() && names.size() == 1) return names.front();
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  constexpr std::size_t most = 8;
  std::vector<std::string> some;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) some.push_back(briefly(names[i]));
  const std::string has = "holds " + std::to_string(names.size()) + " arrays (" + join(some, ", ") + ")";
  throw Error{Fault::usage,
              file + ": " + has + (name.empty() ? "; name one by --array" : ", but none is called " + printable(name))};
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

Bytes open_array(ZipArchive& archive, const std::string& name, const std::string& file, std::uint64_t& stated) {
  stated = archive.open(chosen(archive, name, file) + std::string(ending));
  return Bytes([&archive](void* to, std::size_t size) { return archive.read(to, size); });
}

void require_values(const Head& head, std::uint64_t stated) {
  const std::uint64_t promised = head.values() * static_cast<std::uint64_t>(head.bytes);
  if (promised <= stated) return;
  throw std::runtime_error("is cut off: its header promises " + std::to_string(promised) +
                           " bytes, but the archive has " + std::to_string(stated) +
                           "; the program that wrote it did not finish");
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

}  // namespace arrays

static_assert(std::endian::native == std::endian::little, "the header states little-endian");

ArrayWriter::ArrayWriter(const std::string& path, const ArraySize& size) : file_(path) {
  file_.require_space(1.0 * sizeof(float) * size.images * size.rows * size.columns);
  file_.write(arrays::head_of_floats({size.images, size.rows, size.columns}));
}

void ArrayWriter::write(const float* values, std::size_t count) { file_.write(values, count * sizeof *values); }

void ArrayWriter::commit() { file_.commit(); }

}  // namespace vam::io
