// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "metrology/compare/datum.hpp"
#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

namespace {

// A part of a print must not be measured at a place where it only might be.
void require_unique(const Options& options, const solid::Alignment& found) {
  if (found.rival) {
    throw Error{Fault::data, options.print + ": is a part of the design and fits in two places, " +
                                 format_number(found.rival->apart_mm, 3) + " mm apart, with " +
                                 format_number(100 * found.rival->best_match, 3) + " and " +
                                 format_number(100 * found.rival->match, 3) +
                                 " % of its surface; move it near the right one and give --align icp"};
  }
  if (found.as_part) {
    note("the print covers only " + format_number(100 * found.overlap, 3) +
         " % of the design; aligned as a part of it");
  }
}

solid::Alignment aligned(const Options& options, const model::TriangleSoup& print,
                         const model::TriangleSoup& design_mesh, const solid::Surface& design) {
  solid::AlignOptions how;
  how.with_scale = options.scale;
  if (options.align == "full") {
    const solid::Alignment found = solid::align(print, design_mesh, design, how);
    require_unique(options, found);
    return found;
  }
  if (options.align == "icp") return solid::refine(print, design, how);
  solid::Alignment as_it_is;
  as_it_is.converged = true;
  return as_it_is;
}

void move(const solid::Similarity& motion, model::TriangleSoup& print) {
  for (auto& point : print.points) point = motion(point);
}

const metrology::Region& named(const std::vector<metrology::Region>& regions, const std::string& name) {
  const auto found =
      std::find_if(regions.begin(), regions.end(), [&](const auto& region) { return region.name == name; });
  if (found != regions.end() && found->kind == metrology::RegionKind::plane) return *found;
  throw Error{Fault::usage, "--datum: '" + name + "' is not a plane that --region names"};
}

// Again after each motion, as it decides which points lie on which face.
solid::Similarity datum(const Options& options, const std::vector<metrology::Region>& regions,
                        const model::TriangleSoup& design_mesh, const solid::Surface& design,
                        model::TriangleSoup& print) {
  std::vector<metrology::Region> faces;
  for (const std::string& name : options.datum) faces.push_back(named(regions, name));
  solid::Similarity all;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const metrology::Inspection seen = metrology::inspect(print, design_mesh, design, options.samples, faces);
    std::array<metrology::DatumFace, 3> pairs;
    for (std::size_t f = 0; f < pairs.size(); ++f) {
      pairs[f] = {metrology::print_plane(seen.regions[f], seen.distances), seen.regions[f].plane};
    }
    const solid::Similarity motion = metrology::datum_motion(pairs);
    move(motion, print);
    all = metrology::after(motion, all);
  }
  return all;
}

}  // namespace

solid::Alignment align_print(const Options& options, const std::vector<metrology::Region>& regions,
                             const model::TriangleSoup& design_mesh, const solid::Surface& design,
                             model::TriangleSoup& print) {
  solid::Alignment found = aligned(options, print, design_mesh, design);
  if (!found.converged) warn("alignment: not converged after " + std::to_string(found.iterations) + " iterations");
  move(found.transform, print);
  if (!options.datum.empty()) {
    found.transform = metrology::after(datum(options, regions, design_mesh, design, print), found.transform);
  }
  return found;
}

}  // namespace vam::sdf_tool
