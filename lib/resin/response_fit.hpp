// SPDX-License-Identifier: GPL-3.0-or-later
// A projector's response table from photodiode readings.
#pragma once

#include <span>
#include <string>

#include "model/response_table.hpp"

namespace vam::resin {

struct PhotodiodeReading {
  double grey = 0;     // level sent
  double reading = 0;  // any unit that is linear in the light
};

struct ResponseFit {
  model::ResponseTable table;  // mean reading per level, dark reading subtracted, never falling
  double contrast = 0;         // last / first; infinite when the projector is black at grey 0
  double gamma = 0;            // exponent of the power law nearest to the table, for information
  double noise = 0;            // standard deviation of one reading, from the repeats; 0 without repeats
  int pooled = 0;              // levels whose means fell within the noise and were averaged with a neighbour
};

/// Repeats are averaged and `dark`, the diode's reading without light, is subtracted. Where a mean falls below the one
/// before by less than three standard errors, the two are pooled (isotonic least squares); without repeats there is no
/// noise to excuse a fall. Throws Fault::data: fewer than three levels, none at grey 0, a fall beyond the noise, no
/// light. `source` names the data in messages.
[[nodiscard]] ResponseFit fit_response(std::span<const PhotodiodeReading> readings, double dark,
                                       const std::string& source);

}  // namespace vam::resin
