// SPDX-License-Identifier: GPL-3.0-or-later
// Seals: hashes by which a file shows that it is what was written. They find bit rot and edits, and are no signature:
// whoever means to deceive can compute them, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace vam::io {

/// 128 bits of XXH3 (xxhash.com).
struct Digest {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const Digest&, const Digest&) = default;
};

/// "xxh3:" and 32 hexadecimal digits: as it stands in files.
[[nodiscard]] std::string seal_text(const Digest& digest);
/// Nothing where the text is none.
[[nodiscard]] bool parse_seal(std::string_view text, Digest& digest);
/// The first 8 digits, for messages and chains.
[[nodiscard]] std::string shortened(const Digest& digest);

/// The hash of one piece of memory; that of a Sealer that was given it at once.
[[nodiscard]] Digest digest_of(const void* bytes, std::size_t size);

/// Takes bytes piece by piece.
class Sealer {
 public:
  Sealer();
  ~Sealer();
  Sealer(const Sealer&) = delete;
  Sealer& operator=(const Sealer&) = delete;
  void add(const void* bytes, std::size_t size);
  /// Its length first, so that "ab" "c" is not "a" "bc".
  void add(const std::string& text);
  template <class Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_same_v<Number, Digest>);
    add(&number, sizeof number);
  }
  [[nodiscard]] Digest digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Attributes and metadata of these names are kept by the seal itself, and not copied from input to output.
inline constexpr const char* values_seal_key = "vam:seal";       // of the values; "follows" on a pipe of images
inline constexpr const char* facts_seal_key = "vam:facts_seal";  // of the facts: all other vam: attributes
[[nodiscard]] bool is_seal_key(std::string_view name);
/// Facts that a seal covers: those of these tools. Other programs may add their own.
[[nodiscard]] inline bool is_sealed_name(std::string_view name) {
  return name.starts_with("vam:") && !is_seal_key(name);
}

/// The line that a reader adds to a history: what the command on the line above has written had this seal, the first 16
/// digits of the hash of both seals.
[[nodiscard]] std::string chain_line(const Digest& facts, const Digest& values);
/// The 16 digits of such a line; empty for any other.
[[nodiscard]] std::string chained_seal(std::string_view line);

/// What a reader says of a mismatch: "image 7 changed after it was written (sealed 12345678, read 9abcdef0); make it
/// again, or ...".
[[nodiscard]] std::string mismatch(const std::string& what, const Digest& sealed, const Digest& read);

}  // namespace vam::io
