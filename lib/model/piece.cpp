// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/piece.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "base/error.hpp"

namespace vam::model {

namespace {

std::optional<int> parse_index(std::string_view text) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool all = problem == std::errc{} && end == text.data() + text.size();
  return all && value >= 0 ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<ImageRange> parse_range(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto from = parse_index(text.substr(0, colon));
  const auto to = parse_index(text.substr(colon + 1));
  if (!from || !to || *from >= *to) return std::nullopt;
  return ImageRange{*from, *to};
}

std::string range_text(const ImageRange& range) { return std::to_string(range.from) + ":" + std::to_string(range.to); }

std::optional<ImageChoice> parse_choice(std::string_view text) {
  if (const auto range = parse_range(text)) return ImageChoice{*range};
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto share = parse_index(text.substr(0, slash));
  const auto of = parse_index(text.substr(slash + 1));
  if (!share || !of || *share < 1 || *share > *of) return std::nullopt;
  return ImageChoice{{}, *share, *of};
}

ImageChoice slices_named(const std::string& text) {
  if (const auto choice = parse_choice(text)) return *choice;
  throw Error{Fault::usage, "--slices: '" + text +
                                "' is neither a range FROM:TO with FROM < TO, such as 0:64, nor a share I/N, such as "
                                "1/4"};
}

ImageRange slices_among(const std::string& text, int count, const std::string& name, int unit) {
  if (const auto range = slices_named(text).among(count, unit)) return *range;
  throw Error{Fault::data, name + ": has " + std::to_string(count) + " slices, too few for --slices " + text};
}

std::optional<ImageRange> ImageChoice::among(int count, int unit) const {
  if (of == 0) return range.to <= count ? std::optional(range) : std::nullopt;
  if (count < of) return std::nullopt;
  const int units = (count + unit - 1) / unit;
  if (units < of) return among(count, 1);
  const auto begin = [&](int one) {
    const auto at = static_cast<std::int64_t>(units) * one / of * unit;
    return static_cast<int>(std::min<std::int64_t>(count, at));
  };
  return ImageRange{begin(share - 1), begin(share)};
}

Piece piece_of(const ImageRange& images, int of) { return images.count() == of ? Piece{} : Piece{images, of}; }

std::optional<Piece> parse_piece(std::string_view text) {
  constexpr std::string_view between = " of ";
  const std::size_t at = text.find(between);
  if (at == std::string_view::npos) return std::nullopt;
  const auto images = parse_range(text.substr(0, at));
  const auto of = parse_index(text.substr(at + between.size()));
  if (!images || !of || images->to > *of || images->count() == *of) return std::nullopt;
  return Piece{*images, *of};
}

std::string piece_text(const Piece& piece) { return range_text(piece.images) + " of " + std::to_string(piece.of); }

}  // namespace vam::model
