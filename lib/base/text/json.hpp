// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON type of reports, traces and device events: nlohmann's, with keys in the order of insertion.
#pragma once

#include <nlohmann/json.hpp>

#include "base/text/json_fwd.hpp"
