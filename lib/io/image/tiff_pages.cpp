// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/tiff_pages.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/image/private/tiff_memory.hpp"

namespace vam::io {

namespace {

/// What all pages must have in common.
struct PageLayout {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint16_t bits = 0;
  std::uint16_t format = 0;
  bool operator==(const PageLayout&) const = default;
};

PageLayout layout_of(TIFF* tiff) {
  return {tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH), tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH),
          tiff_field(tiff, TIFFTAG_BITSPERSAMPLE), tiff_field(tiff, TIFFTAG_SAMPLEFORMAT)};
}

bool is_plain(TIFF* tiff) {
  return TIFFIsTiled(tiff) == 0 && tiff_field(tiff, TIFFTAG_SAMPLESPERPIXEL) == 1 &&
         tiff_field(tiff, TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISBLACK;
}

}  // namespace

struct TiffPages::State {
  explicit State(std::string bytes) : file{std::move(bytes)} {
    if (!tiff) fail("is a truncated or damaged TIFF");
    constexpr std::uint32_t most_side = 1 << 16;
    layout = layout_of(tiff.get());
    const bool known = layout.format == SAMPLEFORMAT_UINT || layout.format == SAMPLEFORMAT_INT ||
                       (layout.format == SAMPLEFORMAT_IEEEFP && layout.bits >= 16);
    const bool whole = layout.bits == 8 || layout.bits == 16 || layout.bits == 32 || layout.bits == 64;
    if (!known || !whole) {
      fail("has values of " + std::to_string(layout.bits) + " bits and sample format " + std::to_string(layout.format) +
           "; grey whole numbers of 8 to 64 bits and floats of 16 to 64 are read");
    }
    if (layout.columns == 0 || layout.rows == 0 || layout.columns > most_side || layout.rows > most_side) {
      fail("has pages of " + std::to_string(layout.columns) + " x " + std::to_string(layout.rows) +
           " values; up to 65536 along an axis are read");
    }
    count = TIFFNumberOfDirectories(tiff.get());
    // Pages are counted as far as they are found; the last of them names none that follows.
    const bool found = count > 0 && TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(count - 1)) != 0;
    if (found && TIFFLastDirectory(tiff.get()) == 0) fail("is cut off after page " + std::to_string(count));
    if (!found || TIFFSetDirectory(tiff.get(), 0) == 0) fail("is a truncated or damaged TIFF");
    row.resize(std::size_t{layout.columns} * layout.bits / 8);
    require_page();
  }

  [[noreturn]] static void fail(const std::string& why) { throw std::runtime_error(why); }

  void require_page() {
    if (!(layout_of(tiff.get()) == layout)) {
      fail("page " + std::to_string(page) + " differs from page 0 in size or type; save pages of one kind");
    }
    if (!is_plain(tiff.get())) {
      fail("page " + std::to_string(page) + " is not grey in strips, 0 black; convert it, as by tiffcp -s");
    }
    if (!is_upright(tiff.get())) {
      fail("page " + std::to_string(page) +
           " states that it is turned or mirrored; turn it, as by convert -auto-orient");
    }
    if (static_cast<std::size_t>(TIFFScanlineSize(tiff.get())) != row.size()) {
      fail("page " + std::to_string(page) + " is damaged");
    }
  }

  bool next_row() {
    if (line == layout.rows) {
      if (++page == count) return false;
      if (TIFFReadDirectory(tiff.get()) == 0) fail("is cut off after " + std::to_string(page) + " pages");
      require_page();
      line = 0;
    }
    if (TIFFReadScanline(tiff.get(), row.data(), line) < 0) {
      fail("row " + std::to_string(line) + " of page " + std::to_string(page) + " is truncated or damaged");
    }
    ++line;
    return true;
  }

  TiffMemory file;
  Tiff tiff = open_tiff(file);
  PageLayout layout;
  std::uint32_t count = 0;
  std::uint32_t page = 0;
  std::uint32_t line = 0;
  std::vector<char> row;
  std::size_t used = 0;  // of the row; all of it, or none is read yet
  bool has_row = false;
};

TiffPages::TiffPages(std::string bytes) : state_(std::make_unique<State>(std::move(bytes))) {}

TiffPages::~TiffPages() = default;

std::uint32_t TiffPages::pages() const { return state_->count; }
std::uint32_t TiffPages::rows() const { return state_->layout.rows; }
std::uint32_t TiffPages::columns() const { return state_->layout.columns; }
int TiffPages::value_bytes() const { return state_->layout.bits / 8; }

char TiffPages::kind() const {
  if (state_->layout.format == SAMPLEFORMAT_IEEEFP) return 'f';
  return state_->layout.format == SAMPLEFORMAT_INT ? 'i' : 'u';
}

std::size_t TiffPages::read(void* to, std::size_t size) {
  State& s = *state_;
  std::size_t done = 0;
  while (done < size) {
    if (!s.has_row || s.used == s.row.size()) {
      s.has_row = s.page < s.count && s.next_row();
      if (!s.has_row) break;
      s.used = 0;
    }
    const std::size_t step = std::min(size - done, s.row.size() - s.used);
    std::memcpy(static_cast<char*>(to) + done, s.row.data() + s.used, step);
    s.used += step;
    done += step;
  }
  return done;
}

}  // namespace vam::io
