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
  const std::string facts = text(header, facts_seal_key).value_or("");
  const std::string values = text(header, values_seal_key).value_or("");
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

void SealCheck::begin_part(const Imf::Header& header, bool multi_part, const model::StackInfo& own,
                           const model::ImageInfo& about) {
  const std::string part = "part " + std::to_string(parts_);
  const auto found = seals_of(header, part);
  if (found.has_value() != !seals_.empty() && parts_ > 0) {
    throw std::runtime_error(part + (found ? " is sealed and others are not" : " has lost its seals") +
                             "; make the file again");
  }
  ++parts_;
  if (!found) return;
  // Without these another attribute bears a damaged name, and would be taken for one of other programs.
  if (multi_part && !(header.hasName() && header.hasType())) {
    throw std::runtime_error(part + " has a damaged header; make the file again");
  }
  if (!seals_.empty() && found->values.has_value() != seals_.front().values.has_value()) {
    throw std::runtime_error(part + " has a damaged seal; make the file again");
  }
  const Digest read = facts_digest(own, static_cast<int>(parts_) - 1, about);
  if (read != found->facts) throw std::runtime_error(mismatch("the header of " + part, found->facts, read));
  seals_.push_back(*found);
  read_.emplace_back();
}

void SealCheck::note_chunk(std::uint64_t start, bool in_order) {
  in_order_ = in_order_ && in_order;
  if (in_order_) places_.add(start);
}

bool SealCheck::note_image(std::size_t index, const Image& image) {
  if (!sealed()) return false;
  read_[index] = values_digest(image);
  return seals_[index].values == read_[index];
}

void SealCheck::judge(std::size_t index) const {
  if (!sealed() || !seals_[index].values || *seals_[index].values == read_[index]) return;
  throw std::runtime_error(mismatch("image " + std::to_string(index), *seals_[index].values, read_[index]));
}

void SealCheck::finish(const std::function<void(char* to, std::size_t size)>& take) {
  if (!sealed()) return;
  if (in_order_ && places_ != table_) {
    throw std::runtime_error("its offset table is damaged, so that other programs cannot read it; make the file again");
  }
  if (seals_.front().values) return;
  std::string mark(seal_mark.size(), '\0');
  std::string bytes(trailer_bytes(seals_.size()), '\0');
  take(mark.data(), mark.size());
  if (mark != seal_mark) throw std::runtime_error("has lost the seals after its last image; make the file again");
  take(bytes.data(), bytes.size());
  const auto values = parse_trailer(bytes);
  for (std::size_t i = 0; i < values.size(); ++i) {
    seals_[i].values = values[i];
    judge(i);
  }
}

std::string SealCheck::chained() const {
  if (!sealed() || !seals_.front().values) return "";
  Sealer facts;
  Sealer values;
  for (const auto& part : seals_) {
    facts.add(part.facts);
    values.add(*part.values);
  }
  return chain_line(facts.digest(), values.digest());
}

}  // namespace vam::io::exr
