// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "solid/voxel/isosurface.hpp"
#include "solid/wrap/wrap.hpp"

namespace vam::session {

io::ColouredMesh read_solid(const std::string& path, const std::string& others) {
  io::ColouredMesh read = io::read_coloured_mesh(path, others);
  if (read.taken_away == 0) return read;
  auto& triangles = read.mesh.triangles;
  const auto from = triangles.end() - static_cast<std::ptrdiff_t>(read.taken_away);
  model::TriangleSoup taken_away{read.mesh.points, {from, triangles.end()}};
  triangles.erase(from, triangles.end());
  read.mesh = solid::difference(std::move(read.mesh), std::move(taken_away), io::input_name(path));
  return read;
}

model::TriangleSoup mesh_in_unit(const std::string& path, bool given, const std::string& flag,
                                 const std::string& scale) {
  io::ColouredMesh read = read_solid(path);
  if (given && read.in_mm) {
    throw Error{Fault::usage, flag + ": " + io::input_name(path) + " states its unit, as 3MF files do; omit " + flag +
                                  ", or give " + scale + " to change the size"};
  }
  return std::move(read.mesh);
}

void add_array(cli::App& app, ArrayOptions& options, const std::vector<std::string>& not_for,
               const std::vector<std::string>& excludes) {
  app.option("--copies", "NXxNY[xNZ]", options.copies,
             "Print the part so many times, in rows along x, y and z about the axis.");
  app.excludes(excludes).not_for(not_for);
  app.option(
      "--beside", "MESH", options.beside,
      "Print this mesh, too, in its own size and turned as PART, in rows about the axis; with --copies the meshes "
      "take the places in turn.");
  app.reads().excludes(excludes).not_for(not_for);
  app.option("--gap", "LENGTH", options.gap, cli::non_negative,
             "Distance of the bounding boxes of --copies and --beside, in the unit of PART and scaled with it.");
  app.only_with({"--copies", "--beside"});
}

namespace {

std::optional<std::array<int, 3>> counts_of(const ArrayOptions& array) {
  if (array.copies.empty()) return std::nullopt;
  constexpr int most = 100;
  std::array<int, 3> counts{1, 1, 1};
  const std::vector<std::string> words = split(array.copies, 'x');
  if (words.size() < 2 || words.size() > 3)
    throw Error{Fault::usage, "--copies: '" + array.copies + "' is not NXxNY or NXxNYxNZ, e.g. 2x2"};
  for (std::size_t d = 0; d < words.size(); ++d) {
    const auto count = parse_number(words[d]);
    if (!count || *count != std::floor(*count) || *count < 1 || *count > most)
      throw Error{Fault::usage, "--copies: '" + words[d] + "' is no number of copies; give 1 to 100"};
    counts[d] = static_cast<int>(*count);
  }
  if (const auto places = counts[0] * counts[1] * counts[2]; places <= std::ssize(array.beside))
    throw Error{Fault::usage, "--copies: " + array.copies + " has no place for " +
                                  std::to_string(array.beside.size() + 1) + " meshes; give more"};
  return counts;
}

}  // namespace

model::TriangleSoup array_in_unit(const std::string& path, const ArrayOptions& array, bool given,
                                  solid::Placement& placement) {
  const auto counts = counts_of(array);
  std::vector<model::TriangleSoup> bodies{mesh_in_unit(path, given, "--unit", "--scale")};
  if (!counts && array.beside.empty()) return std::move(bodies.front());
  for (const std::string& name : array.beside) bodies.push_back(mesh_in_unit(name, given, "--unit", "--scale"));
  double largest = 0;
  for (const auto& body : bodies)
    largest = std::max(largest, static_cast<double>(body.points.size() + body.triangles.size()));
  require_memory(
      (counts ? (*counts)[0] * (*counts)[1] * (*counts)[2] : count_of(bodies)) * largest * sizeof(solid::Point),
      path + ": " + array.copies + " copies", "print fewer");
  const solid::Affine turn =
      solid::rotation(std::exchange(placement.rotate_deg, {})) * std::exchange(placement.axes, {});
  for (model::TriangleSoup& body : bodies) solid::transform(body, turn);
  return solid::in_rows(bodies, counts, array.gap);
}

model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue,
                                 const std::function<void(model::Volume&)>& prepare, const MeasureSurface& measure) {
  if (!io::is_volume(path)) return read_solid(path).mesh;
  const std::string name = io::input_name(path);
  if (!isovalue) {
    throw Error{Fault::usage, name + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  }
  const io::SparseVolume sparse = io::read_volume(path, "");
  io::check_values(path, sparse, *isovalue > 1 ? io::TargetKind::grey : io::TargetKind::coverage);
  model::Volume volume = io::dense_volume(sparse);
  if (prepare) prepare(volume);
  model::TriangleSoup mesh = solid::isosurface(volume, *isovalue);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, name + ": no surface, the volume does not cross " + format_number(*isovalue)};
  }
  if (measure) measure(volume, mesh);
  model::unstretch(mesh, sparse.metadata);
  return mesh;
}

model::TriangleSoup fine_surface(const io::SparseVolume& volume, double level, const model::Metadata& stretched) {
  model::TriangleSoup mesh = solid::fine_isosurface(
      volume.grid(), [&](int k, int count, float* out) { volume.read_slices(k, count, out); }, level);
  model::unstretch(mesh, stretched);
  return mesh;
}

}  // namespace vam::session
