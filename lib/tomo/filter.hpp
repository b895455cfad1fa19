// SPDX-License-Identifier: GPL-3.0-or-later
// Ramp filters along detector columns, for whole slabs: the spectrum of a row is a line of the object's [CAL17 eq 2].
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/compute/slab.hpp"

namespace vam::tomo {

/// `none` leaves the sinogram as it is. `ram_lak` is the plain ramp; the others multiply it, with x = f / (cutoff *
/// Nyquist), by sin(pi x/2)/(pi x/2), cos(pi x/2), 0.54 + 0.46 cos(pi x), 0.5 + 0.5 cos(pi x), each 0 beyond x = 1, or
/// by e^{-x^2} and e^{-|x|} [CAL17 eq 3], which have no edge.
enum class FilterWindow { none, ram_lak, shepp_logan, cosine, hamming, hann, gaussian, exponential };

/// The names of the windows as the user writes them, in the order of the enumeration: "none", "ram-lak", ...
[[nodiscard]] const std::vector<std::string>& window_names();

/// The window of that name. Throws Error{Fault::usage} listing the names.
[[nodiscard]] FilterWindow window_from_name(const std::string& name);

struct FilterSpec {
  FilterWindow window = FilterWindow::ram_lak;
  double cutoff = 1;        // of the window, as a fraction of the Nyquist frequency, > 0
  double floor = 0;         // least gain, as a fraction of the ramp's at the Nyquist frequency, 0..1 (preconditioner)
  double alpha_per_px = 0;  // |k| < |alpha| is blocked: the inverse of the exponential Radon transform [CAL19 eq 2]
  double ceiling = 1;       // largest gain, as a fraction of the ramp's at the Nyquist frequency, above the floor
};

/// Multiplies the spectrum of every row by |f| (f in cycles per column, 1/2 at Nyquist) times the window. The ramp is
/// the transform of its band-limited kernel h(0) = 1/4, h(odd n) = -1/(pi n)^2 [KS88 chapter 3] and rows
/// are padded by zeros to at least twice their length, so that nothing wraps around and the mean is right. With this
/// gain and the projections of radon.hpp, (pi / angles) * adjoint(filter(forward(x))) is x again for angles over a half
/// or a full turn. Rows are columns of the detector; a Filter may be used from several threads.
class Filter {
 public:
  /// Throws Error{Fault::usage} for a cutoff that is not positive or a floor outside 0..1.
  Filter(int columns, const FilterSpec& spec);
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  /// Filters all rows of a sinogram slab (width = columns) in place. Throws Error{Fault::bug} for another width.
  void apply(Slab& sinogram) const;

  /// Gain at frequency m / (2 * (gains - 1)) cycles per column, m = 0 .. gains - 1.
  [[nodiscard]] const std::vector<double>& gains() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::tomo
