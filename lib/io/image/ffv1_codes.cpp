// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "base/index.hpp"
#include "io/image/private/ffv1.hpp"

namespace vam::io {

namespace {

// Bits, the highest first; up to 32 at once, into bytes for which make_room() was asked before.
class BitWriter {
 public:
  explicit BitWriter(Bytes& bytes) : bytes_(bytes), end_(bytes.size()) {}

  void make_room(std::size_t bits) {
    const std::size_t least = end_ + bits / 8 + 2 * sizeof(held_);
    if (bytes_.size() < least) bytes_.resize(2 * least);
  }
  // Writes whole bytes and those that wait behind them, without a branch on how many there are.
  void put(int count, std::uint32_t value) {
    held_ = held_ << count | value;
    waiting_ += static_cast<unsigned>(count);
    const std::uint64_t aligned = held_ << 1 << (63 - waiting_);
    std::array<std::uint8_t, sizeof aligned> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(aligned >> (56 - 8 * i));
    std::memcpy(bytes_.data() + end_, bytes.data(), bytes.size());
    end_ += waiting_ / 8;
    waiting_ %= 8;
  }
  // The bytes end here.
  void flush() { bytes_.resize(end_ + (waiting_ > 0 ? 1 : 0)); }

 private:
  Bytes& bytes_;
  std::size_t end_;
  std::uint64_t held_ = 0;
  unsigned waiting_ = 0;  // bits behind the last whole byte
};

// What a context has learned of its differences (section 3.8.2.3).
struct ContextState {
  int drift = 0;
  int error_sum = 4;
  int bias = 0;
  int count = 1;

  void learn(int difference) {
    drift += difference;
    error_sum += std::abs(difference);
    if (count == 128) {
      count >>= 1;
      drift >>= 1;
      error_sum >>= 1;
    }
    ++count;
    // Without branches, which would be guessed wrongly; a drift that does not move the bias is within its bounds.
    const int move = static_cast<int>(drift > 0) - static_cast<int>(drift <= -count);
    bias = std::clamp(bias + move, -128, 127);
    drift = std::clamp(drift - move * count, 1 - count, 0);
  }

  // The least k with count * 2^k >= error_sum.
  [[nodiscard]] int low_bits() const {
    const auto width = [](int value) { return static_cast<int>(std::bit_width(static_cast<unsigned>(value))); };
    const int k = std::max(width(error_sum) - width(count), 0);
    return k + static_cast<int>(count << k < error_sum);
  }
};

// Differences of neighbours, in eleven classes of rising size.
constexpr std::array<std::int16_t, 256> classes = [] {
  std::array<std::int16_t, 256> table{};
  for (int d = -128; d < 128; ++d) {
    std::int16_t size = 0;
    for (const int least : {1, 2, 5, 12, 35}) size = static_cast<std::int16_t>(size + ((d < 0 ? -d : d) >= least));
    table[static_cast<std::uint8_t>(d)] = static_cast<std::int16_t>(d < 0 ? -size : size);
  }
  return table;
}();
constexpr int contexts = (11 * 11 * 11 + 1) / 2;

// Lengths of runs, as powers of 2 (section 3.8.2.2.1).
constexpr std::array<std::uint8_t, 41> run_bits{0,  0,  0,  0,  1,  1,  1,  1,  2,  2,  2,  2,  3,  3,
                                                3,  3,  4,  4,  5,  5,  6,  6,  7,  7,  8,  9,  10, 11,
                                                12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24};

constexpr int longest_prefix = 12;
constexpr int pixel_bits = 8;
constexpr int longest_code = 2 * (longest_prefix + pixel_bits);  // of a pixel, and of the run that it ends

int folded(int difference) { return static_cast<std::int8_t>(difference); }

class RowCoder {
 public:
  explicit RowCoder(Bytes& codes) : bits_(codes) {}

  // Both rows have one more pixel on either side.
  void row(const std::uint8_t* above, const std::uint8_t* here, int width) {
    bits_.make_room(product(width, longest_code));
    run_ = 0;
    bool running = false;
    for (int x = 0; x < width; ++x) {
      if (running) {
        const int even = evens(above + x, here + x, width - x);
        run_ += even;
        x += even;
        if (x == width) break;
      }
      const int left = here[x - 1];
      const int corner = above[x - 1];
      const int top = above[x];
      int context = classes[static_cast<std::uint8_t>(left - corner)] +
                    11 * classes[static_cast<std::uint8_t>(corner - top)] +
                    121 * classes[static_cast<std::uint8_t>(top - above[x + 1])];
      const int median = std::clamp(left + top - corner, std::min(left, top), std::max(left, top));
      int difference = here[x] - median;
      const int sign = context >> 31;  // a branch would be guessed wrongly
      context = (context ^ sign) - sign;
      difference = folded((difference ^ sign) - sign);
      running = running || context == 0;
      if (running && difference == 0) {
        ++run_;
        continue;
      }
      if (running) {
        end_run();
        running = false;
        if (difference > 0) --difference;
      }
      symbol(learned_[static_cast<std::size_t>(context)], difference);
    }
    if (running) {
      full_runs();
      if (run_ > 0) bits_.put(1, 1);
    }
  }

  void flush() { bits_.flush(); }

 private:
  // Pixels from here on, by eights, that continue an even plane, which every look ahead would find, too.
  static int evens(const std::uint8_t* above, const std::uint8_t* here, int most) {
    const std::uint64_t plane = here[-1] * std::uint64_t{0x0101010101010101};
    if (above[-1] != here[-1]) return 0;
    int x = 0;
    for (std::uint64_t pixels = 0; x + 8 <= most; x += 8) {
      std::memcpy(&pixels, here + x, sizeof pixels);
      if (pixels != plane) break;
      std::memcpy(&pixels, above + x, sizeof pixels);
      if (pixels != plane) break;
    }
    return x;
  }

  void full_runs() {
    while (run_ >= 1 << run_bits[run_index_]) {
      run_ -= 1 << run_bits[run_index_];
      ++run_index_;
      bits_.put(1, 1);
    }
  }

  void end_run() {
    full_runs();
    bits_.put(1 + run_bits[run_index_], static_cast<std::uint32_t>(run_));
    if (run_index_ > 0) --run_index_;
    run_ = 0;
  }

  void symbol(ContextState& context, int difference) {
    const int value = folded(difference - context.bias);
    const int low_bits = context.low_bits();
    const int turned = value ^ ((2 * context.drift + context.count) >> 31);
    const auto code = static_cast<std::uint32_t>(2 * turned ^ (turned >> 31));
    const auto prefix = static_cast<int>(code >> low_bits);
    if (prefix < longest_prefix) {
      bits_.put(prefix + low_bits + 1, (1U << low_bits) + (code & ((1U << low_bits) - 1)));
    } else {
      bits_.put(longest_prefix + pixel_bits, code - longest_prefix + 1);
    }
    context.learn(value);
  }

  BitWriter bits_;
  std::vector<ContextState> learned_{contexts};
  std::size_t run_index_ = 0;
  int run_ = 0;
};

}  // namespace

void append_ffv1_codes(const GreyImage& image, const PixelRect& slice, Bytes& codes) {
  RowCoder coder(codes);
  const int gain = 255 / image.full();
  const std::size_t padded = static_cast<std::size_t>(slice.width) + 2;
  Bytes rows(2 * padded, 0);
  std::uint8_t* above = rows.data() + 1;
  std::uint8_t* here = above + padded;
  for (int y = 0; y < slice.height; ++y) {
    here[-1] = above[0];
    above[slice.width] = above[slice.width - 1];
    const std::uint16_t* levels = image.values.data() + image.index(slice.left, slice.top + y);
    std::transform(levels, levels + slice.width, here,
                   [gain](std::uint16_t level) { return static_cast<std::uint8_t>(level * gain); });
    coder.row(above, here, slice.width);
    std::swap(above, here);
  }
  coder.flush();
}

}  // namespace vam::io
