// SPDX-License-Identifier: GPL-3.0-or-later
// The views of a turn that can be measured.
#pragma once

#include <string>
#include <vector>

#include "io/image/view_source.hpp"
#include "metrology/ost/views.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

/// All of the source but those without contrast, saturated ones and those whose light failed, each with a warning: the
/// angles of the others are known. Throws Fault::data with the first reason where that is more than a tenth of them.
[[nodiscard]] std::vector<metrology::CameraView> usable_views(Session& session, io::ViewSource& source,
                                                              const std::string& subject);

}  // namespace vam::ost_tool
