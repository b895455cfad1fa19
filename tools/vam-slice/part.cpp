// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-slice/part.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/stream.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"
#include "session/surface.hpp"
#include "solid/voxel/compensation.hpp"
#include "solid/voxel/size_doubt.hpp"
#include "solid/wrap/wrap.hpp"

namespace vam::slice_tool {

namespace {

double rms_of(const io::SparseVolume& volume, const std::string& path) {
  const auto found = volume.metadata.find("vam:rms_mm");
  if (found == volume.metadata.end()) {
    throw Error{Fault::data, path + ": has no RMS deviation (vam:rms_mm); give volumes of vam-sdf --volume"};
  }
  if (const auto rms_mm = parse_number(found->second)) return *rms_mm;
  throw Error{Fault::data,
              path + ": vam:rms_mm is " + excerpt(found->second) + ", not a number; write the volume anew"};
}

/// The mesh displaced by the deviations of the rounds that help.
model::TriangleSoup corrected(model::TriangleSoup mesh, const Options& options, Correction& correction) {
  if (options.compensate.empty()) return mesh;
  std::vector<model::Volume> rounds;
  for (const std::string& path : options.compensate) {
    const io::SparseVolume sparse = io::read_volume(path, "sdf");
    require_memory(sizeof(float) * static_cast<double>(sparse.grid().size()),
                   path + ": " + model::size_text(sparse.grid()), "give vam-sdf a larger --volume-voxel");
    correction.rms_mm.push_back(rms_of(sparse, path));
    rounds.push_back(io::dense_volume(sparse));
  }
  // Surfaces of sharp steps lie within a tenth of a voxel; their RMS is known to half of that.
  const model::Grid grid = rounds.front().grid;
  constexpr double uncertainty = 0.05;  // voxels
  correction.applied = solid::rounds_to_apply(correction.rms_mm, uncertainty * grid.voxel_mm);
  if (correction.applied < rounds.size()) {
    warn("compensation has settled: the print after " + std::to_string(correction.applied) +
         " corrections was the best, RMS " + format_number(correction.rms_mm[correction.applied], 4) +
         " mm; the later ones are not applied");
    rounds.resize(correction.applied);
  }
  if (!model::same_voxels(solid::deviation_grid(mesh, grid.voxel_mm), grid)) {
    throw Error{Fault::data, options.compensate.front() + ": is the deviation from another design than " +
                                 options.input + "; give vam-sdf the same mesh"};
  }
  return solid::compensated(mesh, rounds, options.damping);
}

solid::FillMode fill_mode(const Options& options) {
  if (options.fill == "exact") return solid::FillMode::exact;
  return options.fill == "vote" ? solid::FillMode::vote : solid::FillMode::automatic;
}

solid::Part image_part(const Options& options) {
  const auto folder = std::make_shared<io::ImageFolder>(options.input);
  const GreyImage first = folder->read(0);
  solid::ImageStack stack{first.width, first.height, folder->count(),
                          [folder](int index) { return io::fractions(folder->read(index)); }};
  return solid::image_part(std::move(stack), options.input, options.voxel_mm.value(), options.placement.stretch_z);
}

/// The part of a closed surface around the mesh, which `map` places.
solid::Part wrapped_part(model::TriangleSoup mesh, const solid::Affine& map, const Options& options,
                         const std::string& subject) {
  transform(mesh, map);
  const solid::WrapSize size{options.wrap_mm[0], options.wrap_mm[1]};
  solid::Wrap wrap = solid::wrapped(mesh, size, subject);
  note(subject + ": wrapped: " + std::to_string(wrap.open_edges) + " open edges are closed, openings narrower than " +
       format_number(2 * size.alpha_mm, 3) + " mm and cavities filled, and the part is larger by up to " +
       format_number(size.offset_mm, 3) + " mm on all sides");
  solid::Part part = solid::mesh_part(std::move(wrap.mesh), subject, {}, solid::FillMode::exact);
  part.map = map;
  return part;
}

solid::Part mesh_part(const Options& options, const solid::Writable& room, Correction& correction) {
  solid::Placement placement = options.placement;
  const std::string subject = io::input_name(options.input);
  model::TriangleSoup mesh = corrected(
      session::array_in_unit(options.input, options.array, options.unit_given, placement), options, correction);
  const solid::Affine map = solid::place(mesh, placement, room, subject);
  if (options.fill == "wrap") return wrapped_part(std::move(mesh), map, options, subject);
  return solid::mesh_part(std::move(mesh), subject, map, fill_mode(options));
}

}  // namespace

solid::Part part_of(const Options& options, const model::Projector& projector, const solid::Writable& room,
                    Correction& correction) {
  if (options.shape.empty() && is_folder(options.input)) return image_part(options);
  solid::Part part = options.shape.empty() ? mesh_part(options, room, correction)
                                           : solid::shape_part(options.shape, options.placement, room);
  part.lattice = solid::row_lattice(projector, options.voxel_mm.value());
  return part;
}

namespace {

/// Its origin is where that of the part's file is, or its middle where the user says.
solid::Placement insert_placement(const Options& options, const solid::Part& part) {
  const double stretch_z = options.placement.stretch_z;
  solid::Placement placement;
  placement.scale = options.insert_scale;
  placement.stretch_z = stretch_z;
  placement.centre = options.insert.empty() || !options.insert_at_mm.empty();
  if (!options.insert.empty()) {
    placement.scale *= solid::mm_per(options.insert_unit);
    placement.axes = options.placement.axes;  // an assembly is turned and mirrored as a whole
    placement.rotate_deg = options.placement.rotate_deg;
    const solid::Point origin = part.map({});
    placement.at_mm = {origin[0], origin[1], origin[2] / stretch_z};
  }
  if (!options.insert_rotate_deg.empty()) {
    placement.axes = {};
    std::copy_n(options.insert_rotate_deg.begin(), 3, placement.rotate_deg.begin());
  }
  if (!options.insert_at_mm.empty()) std::copy_n(options.insert_at_mm.begin(), 3, placement.at_mm.begin());
  return placement;
}

}  // namespace

std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part, const solid::Writable& room) {
  if (!options.insert.empty()) {
    model::TriangleSoup mesh =
        session::mesh_in_unit(options.insert, options.insert_unit_given, "--insert-unit", "--insert-scale");
    const solid::Affine map = solid::place(mesh, insert_placement(options, part), room, options.insert);
    return solid::mesh_part(std::move(mesh), options.insert, map, solid::FillMode::automatic);
  }
  if (options.insert_shape.empty()) return std::nullopt;
  return solid::shape_part(options.insert_shape, insert_placement(options, part), room);
}

}  // namespace vam::slice_tool
