// SPDX-License-Identifier: GPL-3.0-or-later
// Which moment of an exposure a camera's time stamp names.
#pragma once

#include <string>

namespace vam::device {

enum class StampMoment { start, middle, end };

/// "start", "middle" or "end".
[[nodiscard]] const char* word_of(StampMoment moment);

/// The moment that camera.stamp requests; for "auto" that of the maker's documents, and the end where they are not
/// known. Makers are told by their names as cameras give them, whatever their case.
[[nodiscard]] StampMoment stamp_moment(const std::string& requested, const std::string& maker);

/// From the stamp to the middle of the exposure.
[[nodiscard]] double to_middle_s(StampMoment moment, double exposure_s);

}  // namespace vam::device
