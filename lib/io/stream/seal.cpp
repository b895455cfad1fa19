// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/seal.hpp"

#include <charconv>
#include <cstdio>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace vam::io {

namespace {

constexpr std::string_view seal_head = "xxh3:";
constexpr std::string_view chain_head = "# sealed ";
constexpr std::size_t digits = 16;  // of one half

Digest digest_from(const XXH128_hash_t& hash) { return {hash.high64, hash.low64}; }

std::string hexadecimal(std::uint64_t half) {
  char text[digits + 1];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(half));
  return text;
}

bool parse_half(std::string_view text, std::uint64_t& half) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), half, 16);
  return problem == std::errc() && end == text.data() + text.size();
}

}  // namespace

struct Sealer::State {
  XXH3_state_t hash;
};

Sealer::Sealer() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->hash); }
Sealer::~Sealer() = default;

void Sealer::add(const void* bytes, std::size_t size) {
  if (size > 0) XXH3_128bits_update(&state_->hash, bytes, size);
}

void Sealer::add(const std::string& text) {
  add(std::uint64_t{text.size()});
  add(text.data(), text.size());
}

Digest Sealer::digest() const { return digest_from(XXH3_128bits_digest(&state_->hash)); }

Digest digest_of(const void* bytes, std::size_t size) { return digest_from(XXH3_128bits(bytes, size)); }

std::string seal_text(const Digest& digest) {
  return std::string(seal_head) + hexadecimal(digest.high) + hexadecimal(digest.low);
}

bool parse_seal(std::string_view text, Digest& digest) {
  if (!text.starts_with(seal_head) || text.size() != seal_head.size() + 2 * digits) return false;
  text.remove_prefix(seal_head.size());
  return parse_half(text.substr(0, digits), digest.high) && parse_half(text.substr(digits), digest.low);
}

std::string shortened(const Digest& digest) { return hexadecimal(digest.high).substr(0, 8); }

bool is_seal_key(std::string_view name) { return name == values_seal_key || name == facts_seal_key; }

std::string chain_line(const Digest& facts, const Digest& values) {
  Sealer both;
  both.add(facts);
  both.add(values);
  return std::string(chain_head) + hexadecimal(both.digest().high);
}

std::string chained_seal(std::string_view line) {
  std::uint64_t half = 0;
  const bool is_one = line.starts_with(chain_head) && line.size() == chain_head.size() + digits &&
                      parse_half(line.substr(chain_head.size()), half);
  return is_one ? std::string(line.substr(chain_head.size())) : std::string();
}

std::string mismatch(const std::string& what, const Digest& sealed, const Digest& read) {
  return what + " changed after it was written (sealed " + shortened(sealed) + ", read " + shortened(read) +
         "); create it again, or remove its attributes vam:seal and vam:facts_seal if the change was intentional";
}

}  // namespace vam::io
