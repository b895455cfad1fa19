// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: the facts of a stack as header attributes.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <optional>
#include <string>

#include "model/stack.hpp"

namespace vam::io::exr {

/// The stack's facts about image `index`, which has none of its own.
[[nodiscard]] model::ImageInfo implied(const model::StackInfo& info, int index);

/// "z0007" in a sinogram stack, "a0007" among frames; wide enough for `count` parts to sort.
[[nodiscard]] std::string part_name(const model::StackInfo& info, int index);

/// Sets the facts that all parts share. `layout` has the size and the channel.
void set_common(Imf::Header& layout, const model::StackInfo& info);
/// Sets the facts of part `index`.
void set_own(Imf::Header& header, const model::StackInfo& info, int index, const model::ImageInfo& about);

/// What is no place or pitch of a stack beside a vial ("vam:row_mm is 1e+30, ..."); empty where all is.
[[nodiscard]] std::string implausible(const model::StackInfo& info);

/// Throws std::runtime_error for a version that is not read: before anything else that a header states.
void require_version(const Imf::Header& header);

/// The facts of a stack from its first header; width and height are left to the caller, count is 0 where it is absent.
/// Throws std::runtime_error: no vam:kind, an unknown space, no positive pixel pitch, what is implausible.
[[nodiscard]] model::StackInfo stack_info(const Imf::Header& header);
/// The facts of part `index`. Throws std::runtime_error when the part is marked as another, or of another stack.
[[nodiscard]] model::ImageInfo image_info(const Imf::Header& header, const model::StackInfo& info, int index);

/// Throws std::runtime_error where part `index` states another geometry or unit than part 0, and a slice another height
/// than its place in the stack has.
void require_alike(const Imf::Header& header, const model::StackInfo& first, const model::StackInfo& own, int index);
/// Throws std::runtime_error for a sinogram of several slices that do not lie one above the other.
void require_pitch(const model::StackInfo& info);

/// Nothing where there is no attribute of that name and type.
[[nodiscard]] std::optional<std::string> text(const Imf::Header& header, const char* name);
[[nodiscard]] std::string kind_name(model::Kind kind);
[[nodiscard]] std::string space_name(model::Space space);

}  // namespace vam::io::exr
