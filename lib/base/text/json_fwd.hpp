// SPDX-License-Identifier: GPL-3.0-or-later
// The name of the JSON type, for headers: the type itself, a second of compiling, is in base/text/json.hpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace vam {
using Json = nlohmann::ordered_json;
}
