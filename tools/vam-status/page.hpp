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

/// "from turn 11 on, for 2 turns: sensitivity 0.95", what a print that corrects itself does (vam-correct renew), or why
/// not yet; empty of another.
[[nodiscard]] std::string correction_text(const RunFolder& run);

// Figures of the page in HTML.

/// The sensitivity of the resin along x and z through the middle; empty while there is none.
[[nodiscard]] std::string sensitivity_figure(const RunFolder& run);
/// The vial from above: the dose so far, turned as the stage has turned it, and the light that comes now, from below; x
/// is to the right [physics §1].
[[nodiscard]] std::string overhead_figure(const RunFolder& run, const LightView& light, bool lit);

/// HTML in UTF-8. Every text that is not of this program is escaped. light: null without sinogram; renewed every
/// `period_s` until the print has ended.
[[nodiscard]] std::string page(const std::string& name, const RunFolder& run, const LightView* light, double period_s);

}  // namespace vam::status_tool
