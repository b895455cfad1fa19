#include "vam-score/options.hpp"

namespace vam::score_tool {

cli::Manual manual() {
  return {
      "vam-score",
      "score a dose against its target",
      {"Compares the dose in every voxel (VDB, as vam-dose writes it) with the target and prints the figures "
       "of merit of volumetric printing, one per line: name, value, meaning. G is the part, V the void inside the "
       "writable circle, f the dose: VER = #{V: f >= min_G f} / (#G + #V). PW, the process window, = min_G f - max_V "
       "f; where it is positive some threshold dose prints the part exactly. IPDR = max_G f - min_G f. CV = sigma_G / "
       "mean_G. IoU = |print and part| / |print or part| at the threshold where it is best.",
       "The last line is the verdict in words: whether the part will print (PW >= 0), by what margin, from how many "
       "voxels, the figures with the voxels that the surface cuts included, and the duration of the print if the resin "
       "is known. Only --require decides on the exit status.",
       "PW and IPDR are fractions of the largest dose, or in the dose's unit with --absolute. The trimmed figures take "
       "the ALPHA/2 and 1 - ALPHA/2 percentiles for the extremes, to limit the influence of single voxels.",
       "A dose in mJ/cm3, of a turn at full intensity or of vam-dose --exposure-plan, and resin.critical_dose_mj_cm3 "
       "also determine the exposure: the minimum number of whole turns in which the critical dose lies in the middle "
       "half of the process window, their duration, and the fraction of full intensity.",
       "V ends at the writable radius, or at the resin's edge for a part that reaches beyond (vam-slice --extent "
       "resin). "
       "There light comes from some stage angles only; --reach writes the fraction for every voxel.",
       "Voxels that the part's surface cuts (0 < coverage < 1) are scored only with --surface.",
       "With --require the exit status is 1 if a condition does not hold, so that a Makefile can reject a part that "
       "will not print, and 64 if it is on a figure that is not known: cured_ without a critical dose, turns, "
       "duration_s, "
       "multiplier and peak_intensity_mw_cm2 without one in mJ/cm3, efficiency without --sinogram."},
      {{"Score a simulated print:",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-optimize part.vdb | vam-dose --like part.vdb -o "
        "dose.vdb && vam-score dose.vdb --target part.vdb"},
       {"Reject a dose that will not print:", "vam-score dose.vdb --target part.vdb --require 'ver<=0.01,iou>=0.95'"},
       {"Write the print as a mesh and as points coloured by dose:",
        "vam-score dose.vdb --target part.vdb --mesh print.ply && vam-score dose.vdb --target part.vdb --mesh "
        "points.ply --ply-as points"}},
      {"Accuracy: extremes, means and the figures at the critical dose are exact; VER, IoU and percentiles resolve the "
       "dose to 2^-12 of its value, and VER counts undecided voxels as errors.",
       "Memory: 32 slices, 0.3 bytes a voxel, and 0.15 GiB. Of both volumes the voxels beyond 32 MiB lie in a scratch "
       "file in $TMPDIR, else /var/tmp. --mesh adds the dose.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, fig 8 (print as points); Rackson et al., Object-space "
       "optimization of tomographic reconstructions, 2021 (VER, PW, IPDR)."},
      {"vam-dose", "vam-optimize", "vam-sdf", "vam-view"}};
}

}  // namespace vam::score_tool
