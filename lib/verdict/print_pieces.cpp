// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/print_pieces.hpp"

#include <array>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "verdict/private/bit_slice.hpp"
#include "verdict/private/break_finder.hpp"
#include "verdict/private/field_shape.hpp"
#include "verdict/private/pieces.hpp"
#include "verdict/private/smooth_print.hpp"

namespace vam::verdict {

namespace {

constexpr std::array other_factors{1 - dose_margin, 1 - dose_margin / 2, 1 + dose_margin / 2, 1 + dose_margin};

struct BothDefects {
  DefectSlice broken, shut;
};

BothDefects defects_of(int width, int height, const std::vector<std::uint8_t>* below,
                       const std::vector<std::uint8_t>& slice, const std::vector<std::uint8_t>* above) {
  const auto bits = [](const std::vector<std::uint8_t>* of) { return of == nullptr ? nullptr : of->data(); };
  const std::array<const std::uint8_t*, 3> slices{bits(below), slice.data(), bits(above)};
  return {defect_slice(Defect::broken, width, height, slices.data()),
          defect_slice(Defect::shut, width, height, slices.data())};
}

}  // namespace

class PrintPieceCounter::State {
 public:
  State(int width, int height, double threshold, const std::optional<model::Circle>& circle);
  void add(const float* dose, const float* coverage, int count);
  [[nodiscard]] PrintPieces found() const;

 private:
  using Slice = std::vector<std::uint8_t>;  // of bits

  void add_judged(const float* dose, const float* coverage, int count);

  JudgedRegion region_;
  int width_, height_;
  double threshold_;
  PieceCounter part_;
  FieldCounter of_part_, of_print_, of_smooth_, of_firm_;
  std::vector<FieldCounter> of_others_;  // of other doses
  SmoothPrint smooth_;
  std::vector<Slice> last_;                                  // up to two
  BreakFinder broken_{Defect::broken}, shut_{Defect::shut};  // in all but the last slice
};

PrintPieceCounter::State::State(int width, int height, double threshold, const std::optional<model::Circle>& circle)
    : region_(width, height, circle),
      width_(width),
      height_(height),
      threshold_(threshold),
      part_(PrintPieces::least_voxels),
      of_part_(width, height, model::half_surface),
      of_print_(width, height, threshold),
      of_smooth_(width, height, threshold),
      of_firm_(width, height, threshold),
      of_others_(other_factors.size(), of_print_),
      smooth_(width, height, threshold) {}

void PrintPieceCounter::State::add(const float* dose, const float* coverage, int count) {
  std::vector<float> doses(product(count, region_.pixels()), 0.0F);
  parallel_for(count, [&](int k) {
    const std::size_t first = product(k, region_.pixels());
    for (std::size_t i = 0; i < region_.pixels(); ++i) {
      if (region_.has(i, coverage[first + i])) doses[first + i] = dose[first + i];
    }
  });
  add_judged(doses.data(), coverage, count);
}

void PrintPieceCounter::State::add_judged(const float* dose, const float* coverage, int count) {
  const std::size_t size = product(width_, height_);
  std::vector<Slice> slices(count, Slice(size));
  std::vector<float> firm(product(count, size));
  parallel_for(count, [&](int k) {
    const std::size_t first = product(k, size);
    for (std::size_t i = 0; i < size; ++i) {
      slices[k][i] = printed_bits(coverage[first + i], static_cast<double>(dose[first + i]) >= threshold_);
      firm[first + i] = firm_dose(coverage[first + i], dose[first + i], threshold_);
    }
  });
  std::vector<const Slice*> all;
  for (const Slice& slice : last_) all.push_back(&slice);
  for (const Slice& slice : slices) all.push_back(&slice);
  // The last slice is kept until its upper neighbour arrives; the one below it has been counted.
  const int first = last_.empty() ? 0 : count_of(last_) - 1;
  std::vector<BothDefects> found(std::max(count_of(all) - 1 - first, 0));
  parallel_for(count_of(found), [&](int n) {
    const int k = first + n;
    found[n] = defects_of(width_, height_, k > 0 ? all[k - 1] : nullptr, *all[k], all[k + 1]);
  });
  for (const BothDefects& slice : found) {
    broken_.add(slice.broken);
    shut_.add(slice.shut);
  }
  of_part_.add(count, coverage);
  const std::vector<float> smoothed = smooth_.add(count, coverage, dose);
  of_print_.add(count, dose);
  of_smooth_.add(static_cast<int>(smoothed.size() / size), smoothed.data());
  of_firm_.add(count, firm.data());
  std::vector<float> other(product(count, size));
  for (std::size_t n = 0; n < other_factors.size(); ++n) {
    parallel_for(count, [&](int k) {
      for (std::size_t i = product(k, size); i < product(k + 1, size); ++i)
        other[i] = other_dose(other_factors[n], coverage[i], dose[i], threshold_);
    });
    of_others_[n].add(count, other.data());
  }
  std::vector<FieldCounter*> fields{&of_part_, &of_print_, &of_smooth_, &of_firm_};
  for (FieldCounter& field : of_others_) fields.push_back(&field);
  parallel_for(count_of(fields) + 1, [&](int n) {
    if (n > 0) return fields[n - 1]->connect();
    for (const Slice& slice : slices) {
      const auto has_trace = [&](std::size_t i) { return (slice[i] & printed::trace) != 0; };
      part_.add(BitSlice(width_, height_, false, has_trace).runs(), Touching::corners);
    }
  });
  std::vector<Slice> last;
  for (std::size_t k = all.size() - std::min<std::size_t>(all.size(), 2); k < all.size(); ++k) last.push_back(*all[k]);
  last_ = std::move(last);
}

PrintPieces PrintPieceCounter::State::found() const {
  BreakFinder broken = broken_;
  BreakFinder shut = shut_;
  if (!last_.empty()) {
    const auto top = defects_of(width_, height_, last_.size() > 1 ? &last_.front() : nullptr, last_.back(), nullptr);
    broken.add(top.broken);
    shut.add(top.shut);
  }
  FieldCounter of_smooth = of_smooth_;
  const std::vector<float> rest = smooth_.rest();
  of_smooth.add(static_cast<int>(rest.size() / product(width_, height_)), rest.data());
  of_smooth.connect();
  // A dose that is moved to void may open a hole that the print has not.
  const FieldShape part = of_part_.found();
  const FieldShape print = of_print_.found();
  const auto beyond_part = [&](std::int64_t tunnels) { return std::max(tunnels - part.tunnels, std::int64_t{0}); };
  const std::int64_t holes = beyond_part(std::min(print.tunnels, of_smooth.found().tunnels));
  std::int64_t least = print.pieces;
  std::int64_t most = print.pieces;
  for (const FieldCounter& other : of_others_) {
    const std::int64_t pieces = other.found().pieces;
    least = std::min(least, pieces);
    most = std::max(most, pieces);
  }
  const auto number = [](std::int64_t pieces) { return static_cast<int>(pieces); };
  return {.part = number(part_.large()),
          .part_at_half = number(part.pieces),
          .print = number(print.pieces),
          .print_fewer = number(print.pieces - least),
          .print_more = number(most - print.pieces),
          .broken = broken.found(),
          .shut = shut.found(),
          .holes = holes,
          .firm_holes = std::min(holes, beyond_part(of_firm_.found().tunnels))};
}

PrintPieceCounter::PrintPieceCounter(int width, int height, double threshold,
                                     const std::optional<model::Circle>& circle)
    : state_(std::make_unique<State>(width, height, threshold, circle)) {}
PrintPieceCounter::~PrintPieceCounter() = default;
PrintPieceCounter::PrintPieceCounter(PrintPieceCounter&&) noexcept = default;
PrintPieceCounter& PrintPieceCounter::operator=(PrintPieceCounter&&) noexcept = default;

void PrintPieceCounter::add(const float* dose, const float* coverage, int count) { state_->add(dose, coverage, count); }
PrintPieces PrintPieceCounter::found() const { return state_->found(); }

}  // namespace vam::verdict
