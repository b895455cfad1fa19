// Private to the array files: an array as images, in the process that parses it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/array/private/npy_head.hpp"

namespace vam::io::npy {

/// Reads the bytes of a .npy front to back through `read(to, size)`, which returns fewer only at the end.
class Parser {
 public:
  using Read = std::function<std::size_t(void*, std::size_t)>;
  /// Which axis of the array counts images, rows and columns. Throws Fault::data that begins with `name`.
  Parser(Read read, std::string name, std::array<int, 3> axes);
  /// Images, rows, columns.
  [[nodiscard]] const std::array<std::size_t, 3>& size() const { return size_; }
  /// Image `k`, in ascending order. Throws Fault::data: cut off, more bytes than values, a value that is not finite.
  void next(Image& image);

 private:
  void take(void* to, std::size_t bytes);
  void take_floats(float* to, std::size_t count);
  void hold_all();
  void gather();
  void check(const Image& image) const;
  void require_end();
  [[noreturn]] void fail(const std::string& why) const;

  Read read_;
  std::string name_;
  Head head_;
  std::array<std::size_t, 3> size_{};
  std::array<std::size_t, 3> stride_{};  // in values, from image to image, row to row, column to column
  bool streams_ = false;                 // the images are as they come
  std::vector<char> raw_;
  std::vector<float> all_;  // where they are not
  std::vector<Image> some_;
  std::size_t taken_ = 0;  // bytes
  std::size_t done_ = 0;   // images
};

}  // namespace vam::io::npy
