// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/single_image.hpp"

#include <cstdint>
#include <exception>
#include <tuple>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "io/exr/private/format.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

Image decoded(const std::string& bytes, const std::string& name) {
  try {
    return exr::decode_single(bytes);
  } catch (const std::exception& problem) {
    throw Error{Fault::data, name + ": " + printable(problem.what())};
  }
}

}  // namespace

Image read_exr_image(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary, std::uint64_t{1} << 30);
  if (bytes.size() < 4 || exr::number_at<std::int32_t>(bytes, 0) != exr::magic) {
    throw Error{Fault::data, path + ": is no EXR image"};
  }
  Image image;
  read_apart(
      {path, bytes.size(), -1, std::uint64_t{exr::max_pixels} * 8},
      [&](Sender& out) {
        const Image read = decoded(bytes, path);
        out.put(std::tie(read.width, read.height, read.values));
      },
      [&](Receiver& in) { in.fill(std::tie(image.width, image.height, image.values)); });
  if (image.width < 1 || image.height < 1 || product(image.width, image.height) != image.values.size())
    throw Error{Fault::data, path + ": is damaged (its parser failed)"};
  if (!all_finite(image.values.data(), image.size())) {
    throw Error{Fault::data, path + ": has a pixel that is not a finite number"};
  }
  return image;
}

}  // namespace vam::io
