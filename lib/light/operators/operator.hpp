// SPDX-License-Identifier: GPL-3.0-or-later
// The forward model as a pair of linear maps, A* from projections to dose and its transpose A. Optimisers see only
// this; a vial, an absorber or an opaque insert is another implementation or a decorator around one.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/compute/slab.hpp"

namespace vam::light {

struct Shape {
  int width = 0;
  int height = 0;
  bool operator==(const Shape&) const = default;
};

/// Slabs [first, end) of a grid, or of its rows of light.
struct SlabRange {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// The slabs of a grid, or of its rows of light, from number `first` on.
template <class SlabType>
struct Window {
  std::size_t first = 0;
  std::span<SlabType> slabs;
  [[nodiscard]] std::size_t end() const { return first + slabs.size(); }
  /// By its number in the grid.
  [[nodiscard]] SlabType& operator[](std::size_t slab) const { return slabs[slab - first]; }
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

  /// Whether row k mainly lights slice k; otherwise any row may light any slice in some frame.
  [[nodiscard]] virtual bool rows_are_slices() const { return true; }

  /// The rows of light that give dose in these slabs of objects; their own where slices are not coupled.
  [[nodiscard]] virtual SlabRange lit_by(const SlabRange& objects) const { return objects; }

  /// sinograms = A objects.
  virtual void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const = 0;
  /// objects = A* sinograms: the relative dose.
  virtual void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const = 0;
  /// A* for a part of a grid whose slices are coupled: `sinograms` has the rows lit_by() the objects, or more. The same
  /// bytes as of the whole grid where the objects begin with a multiple of 4 slabs and end with one or with the grid.
  virtual void adjoint_within(const Window<const Slab>& sinograms, const Window<Slab>& objects) const;
  /// A of objects that are dark beyond these slabs. `sinograms` has the rows lit_by() the objects, or more.
  virtual void forward_within(const Window<const Slab>& objects, const Window<Slab>& sinograms) const;
  /// Multiplies by the approximate inverse of A A* (ramp), in place: adjoint(filter(forward(f))) is about f.
  virtual void filter(std::span<Slab> sinograms) const = 0;
  /// Multiplies by an approximate inverse of A A* that is symmetric and positive definite, in place: the ramp, kept
  /// from vanishing at low frequencies and from growing where the angles are too few.
  virtual void precondition(std::span<Slab> sinograms) const = 0;

  /// sinograms = light, negative in places, whose dose is about the objects: the start of most methods.
  virtual void invert(std::span<const Slab> objects, std::span<Slab> sinograms) const;

  /// The same light for passes of a single slice, lane 0 of the first slab, where there is a quicker way; else none.
  [[nodiscard]] virtual std::unique_ptr<Operator> for_one_slice() const { return nullptr; }

  /// Unknowns to fluence: dose(r) = angle step * sum over stage angles of the image along the rays. As is where the
  /// image has the shape of the sinogram.
  virtual void expand(const Slab& sinogram, Slab& image) const;
  /// The way back; collapse(expand(g)) = g.
  virtual void collapse(const Slab& image, Slab& sinogram) const;
};

/// The dose of so many slabs where every pixel is lit at every angle, by fluence 1.
[[nodiscard]] std::vector<Slab> dose_of_even_light(const Operator& light, std::size_t count);

}  // namespace vam::light
