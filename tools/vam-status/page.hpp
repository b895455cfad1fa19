// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a print: one file without scripts of others, images within, that a browser renews by itself.
#pragma once

#include <optional>
#include <string>

#include "vam-status/light_view.hpp"
#include "vam-status/progress.hpp"

namespace vam::status_tool {

/// The newest image of the camera.
struct CameraImage {
  std::string path;
  std::optional<double> angle_deg;
};

/// The newest image of the run's views/, else its camera.png; nothing where there is neither.
[[nodiscard]] std::optional<CameraImage> newest_image(const RunFolder& run);

/// HTML in UTF-8. Every text that is not of this program is escaped. light: null without sinogram; renewed every
/// `period_s` until the print has ended.
[[nodiscard]] std::string page(const std::string& name, const RunFolder& run, const LightView* light, double period_s);

}  // namespace vam::status_tool
