// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

namespace {

std::vector<std::string> description() {
  return {
      "vam-dose reads sinograms and writes the volume 'dose': the energy absorbed by every voxel during one turn of "
      "the vial. It predicts the print before resin is used, because the cure of a voxel is determined by its dose.",
      "Projector sinograms (vam-optimize, vam-resample) are simulated with chief rays in three dimensions: for every "
      "voxel and stage angle the column and row whose ray passes through the voxel, including refraction and Fresnel "
      "losses, the density of the rays there, and absorption along the path through the resin. The rays of a projector "
      "that is not telecentric climb: a row also exposes slices other than its own, several voxels away at the ends of "
      "the part. --in-plane neglects this, for comparison. With --like the dose also covers the exposed resin around "
      "the part: up to the writable radius, and above and below as far as the rays climb. Virtual sinograms "
      "(vam-sinogram, vam-optimize --geometry parallel) are back-projected along parallel rays, with absorption if the "
      "resin has any.",
      "A stack for a vial or part that moves during the print contains its poses (vam-formats(7), Poses) and is "
      "simulated with them: the dose is then that of all frames, which may span several turns, and figures of the "
      "report for one turn refer to all frames. --poses simulates the projections with poses other than those for "
      "which they were computed.",
      "A grid 'insert' in the volume of --like is an opaque object to print around (overprinting; vam-slice --insert): "
      "every ray ends at the first voxel that the insert covers at least half, the region behind it is in shadow, and "
      "the insert itself absorbs no dose. Voxels of the part that no ray reaches are reported (dark_part_voxels), with "
      "a warning.",
      "The dose is in units of intensity times radian (a uniform intensity of 1 gives at most 2 pi), or in mJ/cm3 if "
      "the printer file has resin.critical_dose_mj_cm3 and resin.absorption_per_mm: then the largest value of the "
      "stack, or --full-scale, corresponds to projector.max_intensity_mw_cm2, and the report has the number of turns "
      "and the duration of the print at stage.speed_deg_s. With --exposure-plan the dose is that of a whole print: the "
      "minimum number of turns with which the critical dose lies in the middle half of the process window at full "
      "intensity or less; if possible, the intensity is reduced so that it lies in the middle. The planned_full_scale "
      "of the report is the --full-scale for vam-project.",
      "With --shown the dose is that delivered by a print according to its log: each image for the time and at the "
      "stage angles at which it was displayed, including missed vertical blanks, an abort and a stop by --until. "
      "Without --printer the settings are those of the run, its printer.toml; others are rejected where they "
      "change the light. The full scale is that of the print; a resumption may have had another one, and another "
      "intensity, which are converted. Where a print showed several sinograms (vam-project --frames-from), each "
      "SINOGRAM "
      "counts for the time in which it was shown, and one that is not given is refused. An image on which the "
      "projector hung counts at the angle "
      "where it began. A warning names the print that a resumption continues if it is not given. The report then "
      "contains dose_shown instead of "
      "dose_per_turn, and shown_turns, the mean number of turns over the stage angles.",
      "The point spread of the beam (resin.psf_mm) and the diffusion of dose during the print (resin.diffusion_mm2_s) "
      "blur the volume; the dose beyond its faces is assumed to be 0."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {
      {"Simulate the print of the disc grid and score it:",
       "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
       "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-resample | vam-dose --like part.vdb -o dose.vdb\n"
       "vam-score dose.vdb --target part.vdb"},
      {"Effect of a telecentric correction on a projector that is not telecentric:",
       "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
       "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-resample --set projector.telecentric=true | "
       "vam-dose --like part.vdb -o wrong.vdb"},
      {"Projections computed for a centred vial, shown to one that wobbles by 0.3 mm:",
       "seq 0 89 | awk 'BEGIN { print \"angle_deg,dx_mm,dy_mm,dz_mm,moves\" } { t = $1 * 3.14159265 / 45; print 4 * $1 "
       "\",\" 0.3 * cos(t) \",\" (-0.3 * sin(t)) \",0,vial\" }' >wobble.csv\n"
       "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
       "vam-optimize --angles 90 part.vdb | vam-dose --poses wobble.csv --like part.vdb -o wobbled.vdb"},
      {"A handle printed around the shaft of a screwdriver:",
       "vam-slice --shape handle --insert-shape screwdriver --voxel 0.8 -o handle.vdb\n"
       "vam-optimize --angles 60 handle.vdb | vam-dose --like handle.vdb | vam-score --target handle.vdb"},
      {"Duration of a print in an absorbing resin:",
       "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
       "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-resample -o projector.exr\n"
       "vam-dose projector.exr --like part.vdb --set resin.absorption_per_mm=0.06 --set resin.critical_dose_mj_cm3=100 "
       "--report time.json -o dose.vdb"},
      {"The dose of an aborted print, here a dry run:",
       "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb\n"
       "vam-sinogram --filter ram-lak --negative clip --angles 90 part.vdb | vam-resample -o short.exr\n"
       "timeout 15 vam-print short.exr --display null: --uncalibrated --set stage.device=sim: --set "
       "stage.speed_deg_s=85 --max-missed 0.9 --run-up 0.1 --turns 20 --run ended || vam-dose short.exr --shown ended "
       "--like part.vdb --report given.json -o given.vdb"}};
}

std::vector<std::string> notes() {
  return {
      "Accuracy: chief-ray doses agree with a sum over individual rays to 1e-3. The dose of a voxel is the mean over "
      "its volume, across the beam exactly for pixels of uniform intensity, along the axis linear between rows. Beyond "
      "the writable radius rays form caustics; doses there are accurate to 1 % of the maximum (RMS; single voxels to "
      "some per cent).",
      "Memory with climbing rays: 90 slices of dose; the intensities of 64 slices and of the slices around them whose "
      "rows reach them, 4 bytes per lit column and angle; 48 images of the stack; the table of rays, 90 bytes for each "
      "of 1440 directions and of the voxels from the axis to the corner of the grid (16 times as many beyond the "
      "writable radius); 0.3 bytes per voxel; and 0.1 GiB. Voxels of the dose and of --like beyond 32 MiB are kept in "
      "a scratch file in $TMPDIR, else /var/tmp. An insert adds 24 bytes per voxel, the whole stack, and three times "
      "the intensities of its lit columns. With horizontal rays: three batches of 64 slices and images.",
      "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq 8; "
      "Kelly et al., Volumetric additive manufacturing via tomographic reconstruction, Science 2019, eq 1."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-dose", "simulate the dose that a print delivers to the resin",   description(), examples(),
          notes(),    {"vam-optimize", "vam-resample", "vam-score", "vam-view"}};
}

}  // namespace vam::dose_tool
