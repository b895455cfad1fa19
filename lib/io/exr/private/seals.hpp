// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: the seals of a stack. Every part bears that of its facts and that of its pixels as they are
// decoded. On a pipe the pixels' come after the last image, where other programs do not look: seal_mark, a Digest a
// part, the Digest of these.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.hpp"
#include "io/exr/private/format.hpp"
#include "io/stream/seal.hpp"
#include "model/stack.hpp"

namespace vam::io::exr {

inline constexpr std::string_view seal_mark = "vam:seal";

/// Of the facts of part `index`, of its size and of every vam: attribute.
[[nodiscard]] Digest facts_digest(const model::StackInfo& info, int index, const model::ImageInfo& about);
/// Of the values, row by row, as floats.
[[nodiscard]] Digest values_digest(const Image& image);
/// Of what a reader of `chunks`, which encode() has made of the image, will see.
[[nodiscard]] Digest stored_digest(const Image& image, Imf::PixelType type, Imf::Compression compression,
                                   const Chunks& chunks);

/// No values: they follow on the pipe.
void set_seals(Imf::Header& header, const Digest& facts, const std::optional<Digest>& values);

struct PartSeals {
  Digest facts;
  std::optional<Digest> values;  // none: they follow
};
/// Nothing where the part has none. Throws std::runtime_error where one of the two is missing or damaged.
[[nodiscard]] std::optional<PartSeals> seals_of(const Imf::Header& header, const std::string& part);

/// What follows the last image of a pipe, seal_mark included.
[[nodiscard]] std::string trailer(const std::vector<Digest>& values);
/// Of the bytes after seal_mark. Throws std::runtime_error where they are damaged.
[[nodiscard]] std::vector<Digest> parse_trailer(const std::string& bytes);
[[nodiscard]] inline std::size_t trailer_bytes(std::size_t parts) { return (parts + 1) * sizeof(Digest); }

}  // namespace vam::io::exr
