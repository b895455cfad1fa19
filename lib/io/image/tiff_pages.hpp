// SPDX-License-Identifier: GPL-3.0-or-later
// A TIFF of several pages as numbers: slices of a volume or projections, of whole numbers or floats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace vam::io {

class TiffPages {
 public:
  /// Pages of one size and type; grey, one sample a pixel, in strips. Throws std::runtime_error, to stand behind
  /// the file's name.
  explicit TiffPages(std::string bytes);
  ~TiffPages();

  [[nodiscard]] std::uint32_t pages() const;
  [[nodiscard]] std::uint32_t rows() const;
  [[nodiscard]] std::uint32_t columns() const;
  [[nodiscard]] char kind() const;        // u, i or f
  [[nodiscard]] int value_bytes() const;  // 1, 2, 4 or 8
  /// The values of all pages, row by row, in this machine's byte order; fewer than `size` bytes only at the end. Throws
  /// std::runtime_error for a page that is damaged.
  std::size_t read(void* to, std::size_t size);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::io
