// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/nrrd.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

static_assert(std::endian::native == std::endian::little, "the header states little-endian");

namespace {

std::string number(double value) { return format_number(value, 12); }

std::string head(const std::vector<std::string>& history) {
  std::string text = "NRRD0004\n# http://teem.sourceforge.net/nrrd/format.html\n";
  for (const auto& line : history) text += "# " + printable(line) + "\n";
  text += version_name + (":=" + FormatKind("NRRD").version()) + "\n";
  return text + "type: float\ndimension: 3\nencoding: raw\nendian: little\n";
}

std::string sizes(int a, int b, int c) {
  return "sizes: " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
}

void write_floats(OutputFile& file, const std::vector<float>& values) {
  file.write(values.data(), values.size() * sizeof(float));
}

std::string stack_axes(const model::StackInfo& info) {
  const bool sinogram = info.kind == model::Kind::sinogram;
  const auto spacing = [](double step) { return step == 0 ? std::string("nan") : number(step); };
  const double second = sinogram ? info.angle_step_deg : info.row_mm;
  const double third = sinogram ? info.row_mm : info.angle_step_deg;
  const double second_start = sinogram ? info.angle_start_deg : info.z_start_mm;
  const double third_start = sinogram ? info.z_start_mm : info.angle_start_deg;
  return "spacings: " + spacing(info.pixel_mm) + " " + spacing(second) + " " + spacing(third) +
         "\naxis mins: " + number(-0.5 * (info.width - 1) * info.pixel_mm) + " " + number(second_start) + " " +
         number(third_start) + "\ncenterings: cell cell cell\n" +
         (sinogram ? "labels: \"column\" \"angle\" \"slice\"\nunits: \"mm\" \"deg\" \"mm\"\n"
                   : "labels: \"column\" \"row\" \"frame\"\nunits: \"mm\" \"mm\" \"deg\"\n");
}

/// What z is to be divided by for mm in the print, as NRRD keeps the keys of others.
std::string stretch_line(const SparseVolume& volume) {
  const auto found = volume.metadata.find("vam:stretch_z");
  return found == volume.metadata.end() ? "" : "vam:stretch_z:=" + printable(found->second) + "\n";
}

}  // namespace

void write_nrrd(const std::string& path, const SparseVolume& volume) {
  const model::Grid& grid = volume.grid();
  const std::string v = number(grid.voxel_mm);
  OutputFile file(path);
  file.require_space(1.0 * sizeof(float) * grid.nx * grid.ny * grid.nz);
  file.write(head(volume.history));
  file.write(sizes(grid.nx, grid.ny, grid.nz) + "content: " + printable(volume.name()) + " (" +
             printable(volume.units) + ")\n");
  file.write("space: 3D-right-handed\nspace units: \"mm\" \"mm\" \"mm\"\nspace directions: (" + v + ",0,0) (0," + v +
             ",0) (0,0," + v + ")\nspace origin: (" + number(grid.origin_mm[0]) + "," + number(grid.origin_mm[1]) +
             "," + number(grid.origin_mm[2]) + ")\nkinds: domain domain domain\n" + stretch_line(volume) + "\n");
  constexpr int slab = 16;
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    std::vector<float> slices(grid.slice_size() * static_cast<std::size_t>(count));
    volume.read_slices(k, count, slices.data());
    write_floats(file, slices);
  }
  file.commit();
}

void write_nrrd(const std::string& path, StackReader& stack) {
  const model::StackInfo& info = stack.info();
  OutputFile file(path);
  file.require_space(1.0 * sizeof(float) * info.width * info.height * info.count);
  file.write(head(info.history));
  file.write(sizes(info.width, info.height, info.count) +
             "content: " + (info.kind == model::Kind::sinogram ? "sinogram (" : "frames (") + printable(info.units) +
             ")\n" + stack_axes(info) + "\n");
  Image image;
  for (model::ImageInfo about; stack.next(image, about);) write_floats(file, image.values);
  file.commit();
}

}  // namespace vam::io
