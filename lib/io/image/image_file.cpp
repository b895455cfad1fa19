// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/image_file.hpp"

#include "io/image/private/image_batch.hpp"

namespace vam::io {

Image fractions(const GreyImage& grey) {
  Image image(grey.width, grey.height);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.values[i] = static_cast<float>(grey.values[i]) / static_cast<float>(grey.full());
  }
  return image;
}

GreyImage read_image(const std::string& path) { return ImageBatch(std::span(&path, 1)).next(); }

}  // namespace vam::io
