// SPDX-License-Identifier: GPL-3.0-or-later
// The manual of vam-curethrough beside its options.
#pragma once

#include "cli/app.hpp"

namespace vam::curethrough {

[[nodiscard]] cli::Manual manual();

}  // namespace vam::curethrough
