// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/image_file.hpp"

#include "io/image/private/image_batch.hpp"

namespace vam::io {

GreyImage read_image(const std::string& path) { return ImageBatch(std::span(&path, 1)).next(); }

}  // namespace vam::io
