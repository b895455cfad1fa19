// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-sinogram/options.hpp"

namespace vam::sinogram_tool {

cli::Manual manual() {
  return {
      "vam-sinogram",
      "project a part along parallel rays, with or without ramp filter",
      {"vam-sinogram reads the target of a part and writes its sinograms: for every z slice an image with one row per "
       "stage angle and one column per detector bin. Of N bins, bin c lies at (c - (N - 1)/2) voxels from the axis; "
       "row a is that of stage angle a * 360/angles degrees. The ray of offset t at angle theta is the line t (cos "
       "theta, sin theta) + u (-sin theta, cos theta) of the part, u along the beam.",
       "Without a filter the values are integrals of coverage along the rays, in mm: the Radon transform. With "
       "--filter they are filtered projections: the sum of intensity * (angle step in radian) over all angles along "
       "the rays reconstructs the part. Some intensities are then negative, which no projector can show; --negative "
       "determines their treatment. Clipping them to 0 is the simplest way to printable projections; those of "
       "vam-optimize print better.",
       "For absorbing resin with coefficient MU, --absorption weights every point of a ray by e^(MU u): the "
       "exponential Radon transform. With a filter the result is its exact inverse, so that beams attenuated by e^(-MU "
       "u) sum to the part. The values are those at the plane through the axis; --at-wall gives those at the entry "
       "into the resin, larger by e^(MU sqrt(R^2 - t^2))."},
      {{"The Radon transform of a disc grid:", "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram -o radon.exr"},
       {"Projections to print, through a pipe:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip | vam-resample -o "
        "projector.exr"},
       {"A smoother filter, 500 angles:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter hann --cutoff 0.5 --angles 500 -o soft.exr"},
       {"For a resin with an absorption coefficient of 0.1 per mm:",
        "vam-slice --shape disc-grid --voxel 0.2 | vam-sinogram --filter ram-lak --negative clip --absorption 0.1 "
        "--at-wall -o absorbing.exr"}},
      {"Accuracy: every voxel is a square of uniform density, and a bin is the exact area of its intersection with a "
       "strip one voxel wide, so that every row has the total mass of the slice. Back-projection in all tools is the "
       "exact transpose.",
       "Filters: ram-lak is the ramp |f| built from its band-limited kernel; the others multiply it by a window of x = "
       "f / (cutoff * Nyquist): shepp-logan sin(pi x/2)/(pi x/2), cosine cos(pi x/2), hamming 0.54 + 0.46 cos(pi x), "
       "hann 0.5 + 0.5 cos(pi x), all 0 beyond x = 1; gaussian e^(-x^2), exponential e^(-|x|).",
       "Memory: the target as in the file, and at most 1 GiB for the slices being processed (at least 16). --negative "
       "offset computes everything twice, first for the minimum of the stack.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, eq 1-3; Kak and Slaney, Principles of Computerized "
       "Tomographic Imaging, 1988, chapter 3; Tretiak and Metz, The exponential Radon transform, 1980; Long and "
       "Fessler, 3D forward and back-projection using separable footprints, 2010."},
      {"vam-dose", "vam-optimize", "vam-resample", "vam-slice", "vam-view"}};
}

}  // namespace vam::sinogram_tool
