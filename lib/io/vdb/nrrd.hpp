// SPDX-License-Identifier: GPL-3.0-or-later
// NRRD: raw floats behind a text header, which ParaView, 3D Slicer, ImageJ and numpy read.
#pragma once

#include <string>

#include "io/exr/stack.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

/// Writes the dense box of a volume: x fastest, right-handed, mm. "-" is stdout. Constant memory beside the volume.
/// Throws Error: no_output, io.
void write_nrrd(const std::string& path, const SparseVolume& volume);

/// Writes a whole stack front to back, columns fastest: (column, angle, slice) of sinograms, (column, row, frame) of
/// frames, each axis with its spacing and unit. Throws what reading throws, and no_output, io.
void write_nrrd(const std::string& path, StackReader& stack);

}  // namespace vam::io
