// SPDX-License-Identifier: GPL-3.0-or-later
// Which images of an undivided stack a stack holds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vam::model {

/// Images from, from + 1, ... to - 1.
struct ImageRange {
  int from = 0;
  int to = 0;
  [[nodiscard]] int count() const { return to - from; }
  [[nodiscard]] bool holds(int index) const { return index >= from && index < to; }
  bool operator==(const ImageRange&) const = default;
};

/// "64:128"; nothing unless 0 <= from < to.
[[nodiscard]] std::optional<ImageRange> parse_range(std::string_view text);
[[nodiscard]] std::string range_text(const ImageRange& range);

/// "64:128", these images; "2/5", the second of five shares.
struct ImageChoice {
  ImageRange range;
  int share = 0, of = 0;  // 0: the range is given
  /// Of so many images; shares begin at multiples of `unit` where there are enough of them. Nothing where these images
  /// are not there, or there are fewer than shares.
  [[nodiscard]] std::optional<ImageRange> among(int count, int unit = 1) const;
};
/// Nothing for what is neither.
[[nodiscard]] std::optional<ImageChoice> parse_choice(std::string_view text);
/// Of --slices. Throws Fault::usage for what is neither.
ImageChoice slices_named(const std::string& text);
/// Of a stack of so many images called `name`. Throws Fault::data, too, where it has too few.
[[nodiscard]] ImageRange slices_among(const std::string& text, int count, const std::string& name, int unit = 1);

/// The images that a stack holds of one with `of` images; of = 0: the stack is whole.
struct Piece {
  ImageRange images;
  int of = 0;
  [[nodiscard]] bool whole() const { return of == 0; }
  bool operator==(const Piece&) const = default;
};

/// Of a stack with `of` images: whole where these are all.
[[nodiscard]] Piece piece_of(const ImageRange& images, int of);
/// "64:128 of 160" [formats: Stack attributes]; nothing for what is no proper part.
[[nodiscard]] std::optional<Piece> parse_piece(std::string_view text);
[[nodiscard]] std::string piece_text(const Piece& piece);

}  // namespace vam::model
