// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/seal_check.hpp"

#include <stdexcept>

namespace vam::io::exr {

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
