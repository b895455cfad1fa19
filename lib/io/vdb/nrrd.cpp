// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

std::string triple(double a, double b, double c, const std::string& between) {
  return format_number(a, 12) + between + format_number(b, 12) + between + format_number(c, 12);
}

/// The header up to the axes.
void begin(OutputFile& file, const std::vector<std::string>& history, int a, int b, int c, const std::string& content) {
  file.require_space(1.0 * sizeof(float) * a * b * c);
  file.write("NRRD0004\n# http://teem.sourceforge.net/nrrd/format.html\n");
  for (const auto& line : history) file.write("# " + printable(line) + "\n");
  file.write(version_name + (":=" + FormatKind("NRRD").version()) + "\ntype: float\ndimension: 3\nencoding: raw\n" +
             "endian: little\nsizes: " + triple(a, b, c, " ") + "\ncontent: " + printable(content) + "\n");
}

}  // namespace

void write_nrrd(const std::string& path, const SparseVolume& volume) {
  constexpr int slab = 16;
  const model::Grid& grid = volume.grid();
  const auto& [x, y, z] = grid.origin_mm;
  const std::string v = format_number(grid.voxel_mm, 12);
  const auto stretch = volume.metadata.find("vam:stretch_z");
  OutputFile file(path);
  begin(file, volume.history, grid.nx, grid.ny, grid.nz, volume.name() + " (" + volume.units + ")");
  file.write("space: 3D-right-handed\nspace units: \"mm\" \"mm\" \"mm\"\nspace directions: (" + v + ",0,0) (0," + v +
             ",0) (0,0," + v + ")\nspace origin: (" + triple(x, y, z, ",") + ")\nkinds: domain domain domain\n");
  if (stretch != volume.metadata.end()) file.write("vam:stretch_z:=" + printable(stretch->second) + "\n");
  file.write("\n");
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    std::vector<float> slices(grid.slice_size() * static_cast<std::size_t>(count));
    volume.read_slices(k, count, slices.data());
    file.write(slices.data(), slices.size() * sizeof(float));
  }
  file.commit();
}

void write_nrrd(const std::string& path, StackReader& stack) {
  const model::StackInfo& info = stack.info();
  const bool sinogram = info.kind == model::Kind::sinogram;
  const double turn = info.angle_step_deg == 0 ? std::nan("") : info.angle_step_deg;
  const double rise = info.row_mm == 0 ? std::nan("") : info.row_mm;
  const double left = -0.5 * (info.width - 1) * info.pixel_mm;
  OutputFile file(path);
  begin(file, info.history, info.width, info.height, info.count,
        (sinogram ? "sinogram (" : "frames (") + info.units + ")");
  file.write(sinogram ? "spacings: " + triple(info.pixel_mm, turn, rise, " ") +
                            "\naxis mins: " + triple(left, info.angle_start_deg, info.z_start_mm, " ") +
                            "\nlabels: \"column\" \"angle\" \"slice\"\nunits: \"mm\" \"deg\" \"mm\"\n"
                      : "spacings: " + triple(info.pixel_mm, rise, turn, " ") +
                            "\naxis mins: " + triple(left, info.z_start_mm, info.angle_start_deg, " ") +
                            "\nlabels: \"column\" \"row\" \"frame\"\nunits: \"mm\" \"mm\" \"deg\"\n");
  file.write("centerings: cell cell cell\n\n");
  Image image;
  for (model::ImageInfo about; stack.next(image, about);) file.write(image.values.data(), image.size() * sizeof(float));
  file.commit();
}

}  // namespace vam::io
