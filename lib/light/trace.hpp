// The dose that a projected sinogram leaves in the vial, by tracing chief rays: what judges the resampler, with which
// it shares nothing but the ray map. Source: [RAY21] Orth et al., Opt. Express 2021, eq 8; absorption as [CAL19] Kelly
// et al., Science 2019, eq 1.
#pragma once

#include <memory>
#include <span>

#include "base/image.hpp"
#include "light/lit_table.hpp"
#include "model/grid.hpp"
#include "optics/resample.hpp"

namespace vam::light {

/// Who lights what. Rows of the sinogram are stage angles; the part stands at direction * stage angle + offset.
struct TraceSetup {
  optics::View view;
  optics::Detector projector;
  optics::Turn turn;
  int direction = 1;
  double angle_offset_rad = 0;
  double absorption_per_mm = 0;
  model::Grid grid;  // of the dose; only x and y matter here
};

/// D(x, y) = |step| sum over theta of the mean over the voxel of I(x_p, theta) T / |dx_v/dx_p - u d delta/dx_p| e^{-mu
/// s} with the column x_p whose ray passes through the voxel at stage angle theta. Between columns light is linear,
/// outside the projector 0; the mean over the voxel is taken to second order, by the variance of its shadow. Dose of
/// one turn, in units of the sinogram times radian. Zero outside the resin.
///
/// The factor differs from the T/J of the paper by the convergence of neighbouring rays along their path; without it
/// (u = 0) light would not be conserved off the axis.
class Tracer {
 public:
  /// Throws Fault::data unless the rows cover one turn.
  explicit Tracer(const TraceSetup& setup);
  ~Tracer();
  Tracer(Tracer&&) noexcept;

  /// Doses (nx x ny, resized) of slices whose sinograms are columns x rows, negative light as it is. Throws Fault::data
  /// where a sinogram has another shape. 64 slices a call are fastest. With inserts (coverage nx x ny, one a slice)
  /// light ends where its column's ray meets the insert of the slice, and voxels at least half inside it get none.
  void dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::light
