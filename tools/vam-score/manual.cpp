// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-score/options.hpp"

namespace vam::score_tool {

namespace {

std::vector<std::string> description() {
  return {
      "vam-score compares the dose in every voxel (VDB, as vam-dose writes it) with the target and prints the figures "
      "of merit of volumetric printing, one per line: name, value, meaning. G is the part, V the void inside the "
      "writable circle, x the dose: VER = #{V: x >= min_G x} / (#G + #V). PW, the process window, = min_G x - max_V x; "
      "if it is positive, a threshold dose exists that prints the part exactly. IPDR = max_G x - min_G x. CV = sigma_G "
      "/ mean_G. IoU = |print and part| / |print or part| at the threshold that maximises it.",
      "The last line is the verdict in words, by what margin, from how many voxels, with the figures that include the "
      "voxels cut by the surface, and with the duration of the print if the resin is known. The part will print if PW "
      "> "
      "0 and, where the critical dose is given or the dose is that of a print, if that dose lies in the process "
      "window. "
      "It will not print as designed if walls or rods are too thin for the voxels (more than 0.1 % of the part, or 2 "
      "voxels and a millionth of it farther than 3 voxels from any half covered voxel), if gaps are too narrow for "
      "them, or if the "
      "print "
      "has broken walls, firm holes that the part has not, shut gaps, or more or fewer pieces than the part can have. "
      "It "
      "may print if "
      "2 % of the dose decide in how many pieces the print is; if vam-slice found "
      "walls or gaps thinner than 1.5 voxels, ridges and grooves as fine, or bores without a voxel that is wholly "
      "outside "
      "the part, by the part's surface; where the target "
      "does not state its surface, if more than 2 % of the part has no voxel nearby that is wholly inside, or wholly "
      "outside; or if the voxels are too coarse to tell "
      "in how many pieces the part is. The exit status depends on --require only: prints>=1 asks for a part that will "
      "print.",
      "Pieces of 8 voxels or more are counted: of the print (print_pieces: the dose at the threshold, interpolated "
      "linearly), and of the part, once where a voxel holds 1/32 of it and voxels that share a corner are of one piece "
      "(part_pieces: thin rods hold together, narrow gaps are bridged), and once of its coverage at a half "
      "(part_pieces_at_half: the other way round). Where the target states the separate "
      "solids of its mesh (vam:solids), the print must be in as many pieces; else in a number between the two. "
      "The least and the most pieces of the print with 1 and 2 % less and more dose, where that decides on voxels "
      "that the surface cuts, are print_pieces_least and print_pieces_most. With --critical-dose the verdict states "
      "how far that is below the least dose of voxels wholly inside the part, and above the largest of those wholly "
      "outside (threshold_margin). "
      "Sets of voxels at least half part that do not cure are counted "
      "(broken_voxels) where the part that cures around them is in more than one piece, as at a rod that is cut, where "
      "that is so for three or more of these voxels that touch, or where around 27 that touch nothing cures, as at the "
      "end of a fin; less is the tip of a sharp edge. Sets of voxels less than a quarter part that cure are counted in "
      "the same way (shut_voxels), by the void that stays liquid, from three on. "
      "Holes of the print beyond those of the part (holes) are tunnels, through walls and between bridges over "
      "gaps, counted by Euler characteristics of the dose and of the coverage at a half; a dose "
      "within 2 % of the threshold counts as the part has it, but in walls and gaps of up to two voxels. If it does "
      "there, too, those holes are left on which no 2 % of the dose decide (firm_holes); of others the print may "
      "print. The threshold of all these is that of --print "
      "(print_threshold in the report, in the dose's unit), not the best threshold of the table.",
      "PW and IPDR are fractions of the largest dose, or in the dose's unit with --absolute. The trimmed figures use "
      "the ALPHA/2 and 1 - ALPHA/2 percentiles as extremes, which limits the influence of single voxels.",
      "A dose in mJ/cm3, of a turn at full intensity or of vam-dose --exposure-plan, and resin.critical_dose_mj_cm3 "
      "also determine the exposure: the minimum number of whole turns in which the critical dose lies in the middle "
      "half of the process window, their duration, and the fraction of full intensity. The figures at the critical "
      "dose "
      "(cured_part and the like, outside_gelled_voxels) and --mesh are then those of the print: of that exposure for "
      "the "
      "dose of one turn, and of the dose as it is for one of vam-dose --exposure-plan or --shown.",
      "V ends at the writable radius, or at the edge of the resin for a part that extends beyond it (vam-slice "
      "--extent resin). It comprises all voxels of the volume within that radius, those in its corners, too. Where the "
      "volume "
      "ends before it, as those of --geometry parallel do, whose dose is computed in the target's volume, a line "
      "states "
      "the radius within which all void is judged (judged_radius_mm of the report); vam-slice --extent writable makes "
      "the "
      "volume larger. Resin beyond the writable radius is lit from some stage angles only; --lit-fraction writes "
      "their fraction for every voxel.",
      "Voxels that the part's surface cuts (0 < coverage < 1) are scored only with --surface.",
      "With --grey-target, the option of vam-optimize, the target is a dose for every voxel, E = |x - f| the error of "
      "a "
      "voxel. A dose in mJ/cm3 is divided by what vam-dose states a relative dose of 1 to be (dose_unit of the "
      "report), "
      "unless the target is in mJ/cm3, too. VER is the fraction of voxels with E > EPSILON (--band), PW = - max (E - "
      "EPSILON), IPDR = max E, CV the "
      "root mean square of E, IoU = 1 - VER; bias is the mean of x - f in the part, which a longer or shorter exposure "
      "changes. A target that seems grey causes a warning without this option. --void states the constraint on the "
      "void; with --void below, E of a void voxel is the amount by "
      "which its dose exceeds LOW, with EPSILON = 0.",
      "With --require the exit status is 1 if a condition does not hold, so that a Makefile can reject a part that "
      "will not print, and 64 if it is on a figure that the inputs do not determine: cured_part, cured_void, cured_iou "
      "and cured_wrong require a critical dose; turns, duration_s, multiplier and peak_intensity_mw_cm2 a critical "
      "dose and a dose in mJ/cm3; efficiency --sinogram."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {{"Score a simulated print:",
           "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
           "vam-optimize part.vdb | vam-dose --like part.vdb -o dose.vdb\n"
           "vam-score dose.vdb --target part.vdb"},
          {"Reject a dose that will not print:",
           "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
           "vam-optimize part.vdb | vam-dose --like part.vdb | vam-score --target part.vdb --require "
           "'ver<=0.01,iou>=0.95'"},
          {"Graded stiffness, met within 0.25 of the dose prescribed, where the void may have any dose up to 0.4:",
           "vam-project --pattern ramp --steps 6 --set projector.columns=40 --set projector.rows=40 --set "
           "projector.telecentric=true -o ramp/\n"
           "vam-slice ramp --voxel 0.2 --stretch-z 1 -o graded.vdb\n"
           "vam-optimize --grey-target --void below --dose-low 0.4 --band 0.25 --angles 120 --iterations 20 graded.vdb "
           "| vam-dose --like graded.vdb -o dose.vdb\n"
           "vam-score --grey-target --void below --dose-low 0.4 --band 0.25 dose.vdb --target graded.vdb"},
          {"Write the print as a mesh and as points coloured by dose:",
           "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
           "vam-optimize part.vdb | vam-dose --like part.vdb -o dose.vdb\n"
           "vam-score dose.vdb --target part.vdb --mesh print.ply\n"
           "vam-score dose.vdb --target part.vdb --mesh points.ply --ply-as points"}};
}

std::vector<std::string> notes() {
  return {
      "Accuracy: extremes, means and the figures at the critical dose are exact; VER, IoU and percentiles resolve the "
      "dose to 2^-12 of its value, and void voxels that this resolution cannot distinguish from the minimum part dose "
      "count as errors in VER.",
      "Memory: 64 slices, 0.3 bytes per voxel, and 0.15 GiB. Voxels of both volumes beyond 32 MiB are kept in a "
      "scratch file in $TMPDIR, else /var/tmp. --mesh adds the dose.",
      "Sources: Kelly et al., Computed Axial Lithography, 2017, fig 8 (print as points); Rackson et al., Object-space "
      "optimization of tomographic reconstructions, 2021 (VER, PW, IPDR)."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-score",   "score a dose against its target",
          description(), examples(),
          notes(),       {"vam-dose", "vam-optimize", "vam-sdf", "vam-view"}};
}

}  // namespace vam::score_tool
