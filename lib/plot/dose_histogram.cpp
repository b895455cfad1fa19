// SPDX-License-Identifier: GPL-3.0-or-later
// The doses inside and outside the part.
#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

using model::Label;

/// What is looked at, on one grid; insert may be null.
struct Volumes {
  const io::SparseVolume& dose;
  const io::SparseVolume& target;
  const io::SparseVolume* insert;
};

/// One pass over the volumes, slab by slab; visit(dose, label) for part and void inside the circle that are no insert.
template <class Visit>
void for_each_voxel(const Volumes& volumes, const model::Circle& circle, const Visit& visit) {
  const auto& [dose, target, insert] = volumes;
  const model::Grid& grid = dose.grid();
  constexpr int slab = 8;
  std::vector<float> doses(grid.slice_size() * slab);
  std::vector<float> covered(grid.slice_size() * slab);
  std::vector<float> opaque(insert == nullptr ? 0 : grid.slice_size() * slab);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    dose.read_slices(k, count, doses.data());
    target.read_slices(k, count, covered.data());
    if (insert != nullptr) insert->read_slices(k, count, opaque.data());
    for (std::size_t i = 0; i < grid.slice_size() * static_cast<std::size_t>(count); ++i) {
      if (insert != nullptr && model::half_covered(opaque[i])) continue;
      const Label label = model::label_of(covered[i]);
      const auto in_slice = static_cast<int>(i % grid.slice_size());
      const bool counts =
          label == Label::part || (label == Label::void_ && circle.contains(in_slice % grid.nx, in_slice / grid.nx));
      if (counts) visit(doses[i], label);
    }
  }
}

struct Sides {
  views::Extremes inside, outside;
};

Sides extremes_of(const Volumes& volumes, const model::Circle& circle, const std::string& name) {
  Sides sides;
  for_each_voxel(volumes, circle,
                 [&](float value, Label label) { (label == Label::part ? sides.inside : sides.outside).add(value); });
  if (!(sides.inside.high >= sides.inside.low)) {
    throw Error{Fault::data, name + ": the target has no voxel wholly inside the part; slice it with smaller voxels"};
  }
  if (!(sides.outside.high >= sides.outside.low)) {
    throw Error{Fault::data, name + ": the target has no voxel outside the part"};
  }
  return sides;
}

}  // namespace

Plot dose_histogram(const io::SparseVolume& dose, const io::SparseVolume& target, const model::Circle& circle,
                    const ViewOptions& options, const io::SparseVolume* insert) {
  require_same_voxels(dose.grid(), target.grid(), options.name, "compute the dose on this target");
  if (insert != nullptr) require_same_voxels(dose.grid(), insert->grid(), options.name, "slice both together");
  const Volumes volumes{dose, target, insert};
  const auto [inner, outer] = extremes_of(volumes, circle, options.name);
  const double low = options.low.value_or(std::min({0.0, inner.low, outer.low}));
  const double high = options.high.value_or(std::max(inner.high, outer.high));
  constexpr int bins = 120;
  HistogramBuilder inside(low, high, bins);
  HistogramBuilder outside(low, high, bins);
  for_each_voxel(volumes, circle, [&](float value, Label label) {
    (label == Label::part ? inside : outside).add(static_cast<double>(value));
  });
  Plot plot;
  plot.title = options.title.value_or(options.name + ": dose inside and outside the part");
  plot.x = {views::with_unit("dose", dose.units), low, high, false};
  plot.y = {"voxels inside, and outside (%)", 0, 0, true};
  const auto bars_out = outside.done();
  const auto bars_in = inside.done();
  plot.series = {{insert == nullptr ? "outside the part" : "outside part and insert", bars_out.edges, bars_out.percent,
                  paint::blue, SeriesStyle::bars},
                 {"inside the part", bars_in.edges, bars_in.percent, paint::vermilion, SeriesStyle::bars}};
  plot.markers = {{inner.low, "minimum inside " + format_number(inner.low, 4), paint::vermilion},
                  {outer.high, "maximum outside " + format_number(outer.high, 4), paint::blue}};
  if (options.critical) {
    plot.markers.push_back({*options.critical, "critical dose " + format_number(*options.critical, 4), paint::black});
  }
  return plot;
}

}  // namespace vam::plot
