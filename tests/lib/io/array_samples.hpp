// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays put together in a test, read back whole.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/array/array_file.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

namespace samples {

inline std::string big(const std::string& bytes) { return {bytes.rbegin(), bytes.rend()}; }

/// All values, image by image, and their size.
struct ReadArray {
  std::vector<float> values;
  vam::io::ArraySize size;
  [[nodiscard]] std::array<int, 3> shape() const { return {size.images, size.rows, size.columns}; }
};

inline ReadArray read_array_file(const std::string& path, const vam::io::ArrayOptions& options = {}) {
  vam::io::ArrayReader reader(path, options);
  ReadArray all{{}, reader.size()};
  for (vam::Image image; reader.next(image);) {
    all.values.insert(all.values.end(), image.values.begin(), image.values.end());
  }
  return all;
}

inline ReadArray read_array(const std::string& bytes, const vam::io::ArrayOptions& options = {}) {
  const scratch::Folder folder;
  return read_array_file(folder.write("array", bytes), options);
}

inline std::string array_refusal(const std::string& bytes, const vam::io::ArrayOptions& options = {}) {
  return error_of([&] { (void)read_array(bytes, options); }, vam::Fault::data);
}

}  // namespace samples
