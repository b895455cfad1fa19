// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-ost/print.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/mesh/file.hpp"
#include "io/settings/sealed_text.hpp"
#include "metrology/cure/projection_sheet.hpp"
#include "plot/image_figure.hpp"
#include "plot/save.hpp"
#include "session/volumes.hpp"
#include "solid/voxel/isosurface.hpp"

namespace vam::ost_tool {

namespace {

std::optional<double> isovalue_of(const Options& o) {
  if (o.resin_record.empty()) return o.isovalue;
  return io::gelation_isovalue(o.resin_record);
}

}  // namespace

Print::Print(const cli::App& app, const Options& options, const model::PrinterCamera& camera)
    : app_(app),
      options_(options),
      absorbs_(camera.absorption_per_mm > 0),
      isovalue_(isovalue_of(options)),
      rules_{options.pieces_mm3, {}} {
  if (!options.target.empty()) target_ = session::read_target(options.target);
  constexpr double margin_mm = 1;
  if (isovalue_ && target_) rules_.inside = metrology::neighbourhood(*target_, margin_mm);
}

void Print::keep(model::Volume& volume) {
  if (!isovalue_) return;
  bodies_ = metrology::keep_bodies(volume, *isovalue_, rules_);
  constexpr double within = 0.75;  // a level on the edge is about half of what is inside
  if (bodies_.inside > 0 && *isovalue_ > within * bodies_.inside) {
    warn("isovalue " + format_number(*isovalue_, 3) + " is too high: half of the print's interior is below " +
         format_number(bodies_.inside, 3) + ", so that parts are missing; calibrate the isovalue again" +
         (absorbs_ ? "" : ", or set camera.absorption_per_mm"));
  }
  cut_ = metrology::cut_sides(volume, *isovalue_);
  if (!cut_.empty()) {
    warn("the print reaches the " + join(cut_, " and the ") +
         " of the reconstructed volume, where its surface is a cut; let the camera see all of it, or reconstruct a "
         "larger --radius");
  }
  if (bodies_.dropped > 0) {
    note("dropped " + std::to_string(bodies_.dropped) + " bodies of " + format_number(bodies_.dropped_mm3, 3) +
         " mm3, the largest " + format_number(bodies_.largest_dropped_mm3, 3) + " mm3; kept " +
         std::to_string(bodies_.kept) + " of " + format_number(bodies_.kept_mm3, 4) + " mm3");
  }
}

void Print::require_in(const model::Volume& volume) const {
  if (options_.mesh.empty()) return;
  const float most = *std::max_element(volume.values.begin(), volume.values.end());
  if (static_cast<double>(most) >= *isovalue_) return;
  throw Error{Fault::data, "no print at this threshold: scattering is below " + format_number(*isovalue_) +
                               " everywhere; check --isovalue"};
}

void Print::require_kept() const {
  if (!isovalue_ || options_.mesh.empty() || bodies_.kept > 0) return;
  throw Error{Fault::data, "no body is kept: the largest has " + format_number(bodies_.largest_dropped_mm3, 4) +
                               " mm3; check --min-body" + (target_ ? " and --target" : "")};
}

void Print::write(const model::Volume& volume, const metrology::VoxelUncertainty* sigma) const {
  if (!options_.mesh.empty()) {
    const auto mesh = solid::isosurface(volume, *isovalue_);
    if (sigma != nullptr && options_.mesh.ends_with(".ply")) {
      model::VertexData vertices;
      vertices.uncertainty = metrology::surface_uncertainty_mm(volume, *sigma, mesh.points);
      io::write_ply(options_.mesh, mesh, vertices,
                    {app_.history(), "scalar_uncertainty: standard, along the normal, in mm"});
    } else if (!mesh.triangles.empty()) {
      io::write_mesh(options_.mesh, mesh, {app_.history()});
    }
  }
  if (options_.projections.empty()) return;
  const auto sheet = metrology::projection_sheet(volume, isovalue_, target_ ? &*target_ : nullptr);
  plot::ImageFigure figure;
  figure.title = "Sum projections";
  for (const auto& [image, caption] : sheet) figure.panels.push_back({image, caption, {}});
  figure.x = {"mm", 0, sheet.front().image.width * volume.grid.voxel_mm};
  figure.y = {"mm", 0, sheet.front().image.height * volume.grid.voxel_mm};
  figure.scale.label = "relative sum";
  figure.columns = 3;
  plot::save(options_.projections, plot::draw(figure), app_.history());
}

std::optional<metrology::Cured> Print::state(const model::Volume& volume) const {
  if (!isovalue_ || !target_) return std::nullopt;
  return metrology::cured(volume, *isovalue_, *target_);
}

std::optional<metrology::BodyCount> Print::bodies() const { return isovalue_ ? std::optional(bodies_) : std::nullopt; }

Json Print::figures(const model::Volume& volume) const {
  if (!isovalue_) return Json::object();
  Json json{{"isovalue", *isovalue_}, {"bodies", metrology::to_json(bodies_)}};
  json["bodies"]["cut"] = cut_;
  if (const auto now = state(volume)) json["print"] = metrology::to_json(*now);
  return json;
}

}  // namespace vam::ost_tool
