// SPDX-License-Identifier: GPL-3.0-or-later
// Foreign bytes are parsed in a sandboxed child: a process that can compute and send what it has read, and nothing
// else.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <ranges>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace vam::io {

/// Memory that parent and child share: two slots, of which one is filled while the other is read. Words on a socket
/// say whose turn it is.
struct SharedBuffers;

/// Bytes, texts, lists and maps of these cross as they are; a struct as std::tie() of its members, its members().
template <class Value>
inline constexpr bool is_tie = false;
template <class... Parts>
inline constexpr bool is_tie<std::tuple<Parts...>> = true;
template <class First, class Second>
inline constexpr bool is_tie<std::pair<First, Second>> = true;
template <class Value>
concept PlainList = std::ranges::contiguous_range<Value> && requires {
  typename Value::allocator_type;
} && std::is_trivially_copyable_v<typename Value::value_type>;

/// The child's end. What is put in comes out of Receiver::get() in the same order.
class Sender {
 public:
  explicit Sender(SharedBuffers& slots) : slots_(slots) {}
  void put(const void* bytes, std::size_t size);
  template <class Value>
  void put(const Value& value) {
    if constexpr (is_tie<Value>) {
      std::apply([this](const auto&... parts) { (this->put(parts), ...); }, value);
    } else if constexpr (std::is_trivially_copyable_v<Value>) {
      put(&value, sizeof value);
    } else {
      put(std::uint64_t{value.size()});
      if constexpr (PlainList<Value>) {
        put(value.data(), value.size() * sizeof *value.data());
      } else {
        for (const auto& item : value) put(item);
      }
    }
  }
  /// Hands over what is still in the slot: at the end, or to a reader that waits for it.
  void flush();

 private:
  void acquire();
  void submit();
  SharedBuffers& slots_;
  std::size_t filled_ = 0;
};

/// The parent's end. The child may send anything, so what is received is examined like a file.
class Receiver {
 public:
  explicit Receiver(SharedBuffers& slots) : slots_(slots) {}
  /// Throws what read_apart() makes an Error of when the child has ended before.
  void get(void* to, std::size_t size);
  template <class Value>
  [[nodiscard]] Value get() {
    Value value{};
    fill(value);
    return value;
  }
  /// Up to 2^31 numbers and characters, 2^20 of other things. Throws as get().
  template <class Value>
  void fill(Value&& value) {
    using Plain = std::remove_cvref_t<Value>;
    if constexpr (is_tie<Plain>) {
      std::apply([this](auto&... parts) { (this->fill(parts), ...); }, value);
    } else if constexpr (std::is_trivially_copyable_v<Plain>) {
      get(&value, sizeof value);
    } else if constexpr (PlainList<Plain>) {
      value.clear();
      constexpr std::uint64_t together = (std::uint64_t{1} << 26) / sizeof(typename Plain::value_type);
      for (auto left = get_count(std::numeric_limits<int>::max()); left > 0;) {  // no more memory than what has come
        const auto step = std::min(left, together);
        value.resize(value.size() + step);
        get(value.data() + value.size() - step, step * sizeof *value.data());
        left -= step;
      }
    } else {
      value.clear();
      for (auto left = get_count(1 << 20); left > 0; --left) {
        if constexpr (requires { typename Plain::mapped_type; }) {
          auto key = get<typename Plain::key_type>();
          fill(value[std::move(key)]);
        } else {
          fill(value.emplace_back());
        }
      }
    }
  }
  /// A number of things that follow; more than `limit` are taken for a child that failed.
  [[nodiscard]] std::uint64_t get_count(std::uint64_t limit);
  /// Passes over what is left; false when the child has ended without its verdict.
  bool drain();

 private:
  void next_slot();
  SharedBuffers& slots_;
  const char* slot_ = nullptr;
  std::size_t left_ = 0;
  bool holds_ = false;   // a slot that the child waits for
  bool judged_ = false;  // the child's verdict is next on the socket
};

/// What is parsed apart.
struct Foreign {
  std::string name;            // begins every message
  std::uint64_t bytes = 0;     // its size, which bounds memory and time of the child; 0: not known, a pipe
  int descriptor = -1;         // a file that the child may read
  std::uint64_t unpacked = 0;  // what it may unpack to beyond 64 times its size
};

/// A reading in a child, taken piece by piece. The child has no file but that descriptor, no network, no other process,
/// at most 256 MiB, 64 times the file and `unpacked` more memory than this process, at most 10 s and 1 s for 64 MiB of
/// that of processor time (a pipe: the memory that is left, 10 min), and dies with this thread.
class SandboxedReader {
 public:
  /// Starts parse() there, which must be single-threaded, destructors included; the std::runtime_error that it throws
  /// stands behind the name. Throws Fault::memory when no process can be made, or less than 16 MiB are left.
  SandboxedReader(Foreign source, const std::function<void(Sender&)>& parse);
  ~SandboxedReader();
  SandboxedReader(const SandboxedReader&) = delete;
  SandboxedReader& operator=(const SandboxedReader&) = delete;
  /// Runs take() here. Throws the child's Error; with one line when the child crashed or met a bound Fault::data, or
  /// Fault::memory where this process has less left than the file may take; what take() throws.
  void take(const std::function<void(Receiver&)>& take);
  /// Passes over what is left. Throws as take() does.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// All of it at once: runs parse() in a child and, at the same time, take() here.
void read_apart(const Foreign& source, const std::function<void(Sender&)>& parse,
                const std::function<void(Receiver&)>& take);

}  // namespace vam::io
