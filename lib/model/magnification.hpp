// SPDX-License-Identifier: GPL-3.0-or-later
// How high images stand at the rotation axis: window, bath, glass and resin shorten the way of light to it.
#pragma once

#include "model/printer.hpp"

namespace vam::model {

/// Sum over the interfaces from the outside in of distance to the axis * (1 / n_before - 1 / n_after): by how much
/// window, bath, glass and resin shorten the way to the axis for rays near it [physics §2]. R (1 - 1/n) for a vial in
/// air [OST22 eq S1, OST22 eq S2, OST22 eq S3, OST22 eq S4]. The resin's index is that at the wavelength in question.
[[nodiscard]] double shortening_mm(const Printer& printer, double index_resin);

/// Vertical magnification of the projected image, M_vp = 1 - shortening / D_p [OST22 eq S5]; 1 when rays stay level.
[[nodiscard]] double vertical_magnification(const Printer& printer);

/// M_vi = 1 / (1 - shortening / D_cam) [OST22 eq S6]: how much taller the camera sees what is at the axis;
/// 1 when it is telecentric.
[[nodiscard]] double camera_magnification(const Printer& printer);

}  // namespace vam::model
