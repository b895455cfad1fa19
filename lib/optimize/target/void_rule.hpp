// SPDX-License-Identifier: GPL-3.0-or-later
// Weights and tolerances that are made from the target: those of the void.
#pragma once

#include <cstddef>
#include <functional>

#include "optimize/target/slice_reader.hpp"

namespace vam::optimize {

/// `values`, or `usual` everywhere where there are none, changed wherever the target is 0.
[[nodiscard]] VolumeSource::Read with_void(const VolumeSource::Read& target, const VolumeSource::Read& values,
                                           float usual, std::size_t pixels, const std::function<void(float&)>& change);

}  // namespace vam::optimize
