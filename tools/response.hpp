// SPDX-License-Identifier: GPL-3.0-or-later
// The response of the projector that a tool works for.
#pragma once

#include "io/settings/response_file.hpp"
#include "model/printer.hpp"
#include "resin/response.hpp"

namespace vam::tool {

/// As measured (projector.response), or else linear from min_intensity to max_intensity. Throws as io::read_response
/// does.
inline resin::Response response_of(const model::Projector& projector) {
  if (projector.response.empty()) return resin::projector_response(projector);
  return resin::Response(io::read_response(projector.response, projector.bits));
}

}  // namespace vam::tool
