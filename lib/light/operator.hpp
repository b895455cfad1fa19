// What light does, as a pair of linear maps. Optimisers see only this; a vial, an absorber or an opaque insert is
// another implementation or a decorator around one.
#pragma once

#include <span>

#include "base/slab.hpp"

namespace vam::light {

struct Shape {
  int width = 0;
  int height = 0;
  bool operator==(const Shape&) const = default;
};

/// A* takes projections to dose, A is its transpose. Both work on a pass at once: up to four slabs (64
/// slices), or the whole grid where light couples slices. Dose: fluence summed over a turn; absorbed energy is mu times
/// it [physics §4].
/// Inside an optimiser a sinogram value is the dose that its row adds (fluence times the angle the row stands for), so
/// A and A* are plain sums and need no weights; expand() turns it into what is projected.
class Operator {
 public:
  Operator() = default;
  virtual ~Operator() = default;
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  [[nodiscard]] virtual Shape object() const = 0;    // pixels of a slice
  [[nodiscard]] virtual Shape sinogram() const = 0;  // unknowns of a slice: columns x rows
  [[nodiscard]] virtual Shape image() const = 0;     // of the image that is projected: columns x stage angles

  /// The angle in radians that a row stands for: fluence = value / row_angle_rad().
  [[nodiscard]] virtual double row_angle_rad() const = 0;

  /// Whether light of one slice gives dose in others: then methods decide for all slices of a pass together.
  [[nodiscard]] virtual bool couples_slices() const { return false; }

  /// Whether slice k is lit by row k in the first place. Else any row may light it in some frame.
  [[nodiscard]] virtual bool rows_are_slices() const { return true; }

  /// sinograms = A objects.
  virtual void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const = 0;
  /// objects = A* sinograms: the relative dose.
  virtual void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const = 0;
  /// Multiplies by the approximate inverse of A A* (ramp), in place: adjoint(filter(forward(f))) is about f.
  virtual void filter(std::span<Slab> sinograms) const = 0;
  /// Multiplies by an approximate inverse of A A* that is symmetric and positive definite, in place: the ramp, kept
  /// from vanishing at low frequencies and from growing where the angles are too few.
  virtual void precondition(std::span<Slab> sinograms) const = 0;

  /// sinograms = light, negative in places, whose dose is about the objects: the start of most methods.
  virtual void invert(std::span<const Slab> objects, std::span<Slab> sinograms) const;

  /// Unknowns to fluence: dose(r) = angle step * sum over stage angles of the image along the rays. As is where the
  /// image has the shape of the sinogram.
  virtual void expand(const Slab& sinogram, Slab& image) const;
  /// The way back; collapse(expand(g)) = g.
  virtual void collapse(const Slab& image, Slab& sinogram) const;
};

}  // namespace vam::light
