// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-resample/options.hpp"

namespace vam::resample_tool {

namespace {

std::vector<std::string> description() {
  return {
      "Projections are computed for a parallel beam. The rays of a real projector diverge, and the vial refracts them "
      "like a strong lens: the ray of column x_p passes through the resin along another line, at offset x_v and "
      "rotated by delta. vam-resample converts a virtual (parallel-beam) sinogram S_v to a projector sinogram, "
      "S_p(x_p, theta) = S_v(x_v, theta + delta) J/T, where J = dx_v/dx_p conserves energy per width and T is the "
      "Fresnel transmittance. The map is exact for horizontal rays through any number of concentric shells "
      "(vial.wall_mm), from a telecentric or diverging lens, and through a bath behind a flat window.",
      "Rays that also diverge from row to row climb and leave their slice. No map from slices to rows is exact for "
      "them; vam-resample treats them as horizontal. The map is exact for projector.telecentric and "
      "projector.telecentric_rows. It is sufficient for parts whose cross-section changes little over the deviation of "
      "the rays, and if the rays of the outermost row deviate by less than half a voxel within the writable radius, z "
      "R_w / (D n M_vp), that is for parts up to 0.5 D n M_vp / R_w voxels above and below the axis of the lens (10 "
      "voxels for the default printer). Otherwise a warning states the deviation, and vam-optimize --geometry vial "
      "(the default) computes projections that include the climb.",
      "With --geometry parallel the inverse map is applied for a camera that views the vial: camera sinograms become "
      "parallel-beam sinograms, ready for filtered back-projection. The azimuth of the camera is counter-clockwise "
      "from the projector, seen from above.",
      "Columns whose ray misses the resin, or falls outside the input, are 0. The sinogram must cover one full turn. "
      "The output of --geometry vial has the projector's columns, with the axis at projector.axis_column."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {{"Correct the projections of a part for the default printer:",
           "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample -o "
           "projector.exr"},
          {"Show the map of a telecentric projector as CSV:",
           "vam-resample --explain --set projector.telecentric=true -o map.csv"},
          {"Show the exact rays of the projector's top row:", "vam-resample --explain --row 0 -o top.csv"},
          {"For a vial with a glass wall:",
           "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample "
           "--set vial.wall_mm=1 --set vial.index_glass=1.52 -o wall.exr"}};
}

std::vector<std::string> notes() {
  return {
      "Memory: five batches of 16 slices, and 1.5 kB for each slice of the stack. Time: below 1 ms per slice of 1024 x "
      "360 and core.",
      "Accuracy: the ray map agrees with a vector ray tracer to 1e-9. Cubic (Catmull-Rom) interpolation is of third "
      "order and the default because it is more accurate than linear interpolation, which the paper uses. Negative "
      "values, including those of its overshoot, are set to 0 for a projector, which cannot show them, unless "
      "--negative keep is given. An output with coarser columns than the input is averaged over the width of its "
      "columns.",
      "Weights: J/T for a projector by default, none for a camera; with --geometry parallel, --fresnel divides by T, "
      "the loss "
      "on the way out, and --jacobian divides by J.",
      "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq "
      "3-7 and fig 4; Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, eq 5-9, with "
      "the exact angles."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-resample", "map sinograms between the parallel beam and a real projector or camera",
          description(),  examples(),
          notes(),        {"vam-dose", "vam-optimize", "vam-ost", "vam-project", "vam-sinogram"}};
}

}  // namespace vam::resample_tool
