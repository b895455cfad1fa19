// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/seals.hpp"

#include <Imath/half.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "base/text/text.hpp"
#include "io/exr/private/attributes.hpp"

namespace vam::io::exr {

namespace {

constexpr const char* follows = "follows";

std::string stated(const Imf::Header& header, const char* name) {
  const auto* found = header.findTypedAttribute<Imf::StringAttribute>(name);
  return found != nullptr ? found->value() : "";
}

}  // namespace

Digest facts_digest(const model::StackInfo& info, int index, const model::ImageInfo& about) {
  Sealer sealer;
  for (const int number : {info.width, info.height, info.count, index}) sealer.add(number);
  for (const double number : {info.pixel_mm, info.row_mm, info.angle_start_deg, info.angle_step_deg, about.z_mm}) {
    sealer.add(number);
  }
  for (const std::string& word : {kind_name(info.kind), space_name(info.space), info.units, join(info.history, "\n")}) {
    sealer.add(word);
  }
  for (const auto& [name, value] : info.extra) {
    if (!is_sealed_name(name)) continue;
    sealer.add(name);
    sealer.add(value);
  }
  if (!info.piece.whole()) sealer.add(model::piece_text(info.piece));
  sealer.add(about.has_angle ? about.angle_deg : -1e300);
  sealer.add(about.has_time ? about.time_s : -1e300);
  sealer.add(about.has_number ? about.number : -1);
  sealer.add(about.has_number && about.incomplete);
  if (about.time_sigma_s != 0) sealer.add(about.time_sigma_s);
  return sealer.digest();
}

Digest values_digest(const Image& image) { return digest_of(image.values.data(), image.size() * sizeof(float)); }

Digest stored_digest(const Image& image, Imf::PixelType type, Imf::Compression compression, const Chunks& chunks) {
  if (compression == Imf::PXR24_COMPRESSION && type == Imf::FLOAT) {  // the one with loss
    Image decoded(image.width, image.height);
    decode(layout_header(image.width, image.height, type, compression), chunks, decoded);
    return values_digest(decoded);
  }
  if (type != Imf::HALF) return values_digest(image);
  Image rounded = image;
  std::transform(image.values.begin(), image.values.end(), rounded.values.begin(),
                 [](float value) { return float{half(value)}; });
  return values_digest(rounded);
}

void set_seals(Imf::Header& header, const Digest& facts, const std::optional<Digest>& values) {
  header.insert(facts_seal_key, Imf::StringAttribute(seal_text(facts)));
  header.insert(values_seal_key, Imf::StringAttribute(values ? seal_text(*values) : follows));
}

std::optional<PartSeals> seals_of(const Imf::Header& header, const std::string& part) {
  const std::string facts = stated(header, facts_seal_key);
  const std::string values = stated(header, values_seal_key);
  if (facts.empty() && values.empty()) return std::nullopt;
  PartSeals seals;
  Digest of_values;
  if (!parse_seal(facts, seals.facts) || (values != follows && !parse_seal(values, of_values))) {
    throw std::runtime_error(part + " has a damaged seal; make the file again");
  }
  if (values != follows) seals.values = of_values;
  return seals;
}

std::string trailer(const std::vector<Digest>& values) {
  const std::size_t size = values.size() * sizeof(Digest);
  std::string bytes(seal_mark);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
  append(bytes, digest_of(values.data(), size));
  return bytes;
}

std::vector<Digest> parse_trailer(const std::string& bytes) {
  std::vector<Digest> all(bytes.size() / sizeof(Digest));
  std::memcpy(all.data(), bytes.data(), all.size() * sizeof(Digest));
  const Digest own = all.back();
  all.pop_back();
  if (digest_of(all.data(), all.size() * sizeof(Digest)) != own) {
    throw std::runtime_error("the seals after its last image are damaged; make the file again");
  }
  return all;
}

}  // namespace vam::io::exr
