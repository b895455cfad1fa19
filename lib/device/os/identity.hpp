// SPDX-License-Identifier: GPL-3.0-or-later
// Identity reported by a device, and the mark of simulated devices.
#pragma once

#include "base/text/json_fwd.hpp"

namespace vam::device {

/// In the maker, model or name of every simulated device, so that no log or record can pass it off as a real one.
inline constexpr const char* simulated_mark = "(simulated)";

/// Adds {"simulated": true} to an identity whose maker, model or serial bears the mark, and to Aravis' fake camera.
[[nodiscard]] Json with_mark(Json about);

}  // namespace vam::device
