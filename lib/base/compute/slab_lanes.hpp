// SPDX-License-Identifier: GPL-3.0-or-later
// The number of slices in a slab; apart, because kernel files include no standard header.
#pragma once

namespace vam {
inline constexpr int lanes = 16;
}
