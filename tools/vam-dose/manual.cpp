#include "vam-dose/options.hpp"

namespace vam::dose_tool {

cli::Manual manual() {
  return {
      "vam-dose",
      "simulate the dose that a print leaves in the resin",
      {"Reads sinograms and writes the volume 'dose': the energy absorbed by every voxel during one turn of the vial. "
       "It predicts the print before resin is used: voxels of equal dose cure alike.",
       "Projector sinograms (vam-optimize, vam-resample) are simulated with chief rays in three dimensions: for every "
       "voxel and stage angle the column and row whose ray passes through the voxel, including refraction and Fresnel "
       "losses, the density of the rays there, and absorption along the path through the resin. The rays of a "
       "projector that is not telecentric climb: a row exposes other slices than its own, by several voxels at the "
       "ends of the part. --in-plane neglects that, for comparison. With --like the dose also covers the resin around "
       "the part that is exposed: up to the writable radius, and above and below as far as the rays climb. "
       "Virtual sinograms (vam-sinogram, "
       "vam-optimize --geometry parallel) are back-projected along parallel rays, with absorption if the resin has "
       "any.",
       "A stack that was made for a vial or part that is displaced while it is shown knows its poses (vam-formats(7), "
       "Poses), and is judged with them: the dose is then that of all its frames, which may be several turns, and what "
       "the report states for one turn is stated for all frames. --poses simulates the projections with other poses "
       "than "
       "those they were computed for.",
       "A grid 'insert' in the volume of --like is an opaque object to print around (overprinting; vam-slice "
       "--insert): every ray ends at the first voxel that is at least half insert, all behind it is in shadow, and "
       "the insert itself absorbs no dose. Voxels of the part that no ray reaches are reported (dark_part_voxels), "
       "with a warning.",
       "The dose is in units of intensity times radian (a uniform intensity of 1 gives at most 2 pi), or in mJ/cm3 if "
       "the printer file has resin.critical_dose_mj_cm3 and resin.absorption_per_mm: then the largest value of the "
       "stack, or --full-scale, corresponds to projector.max_intensity_mw_cm2, and the report has the number of turns "
       "and the duration of the print at stage.speed_deg_s. With --exposure-plan the dose is that of a whole print: "
       "the minimum number of turns in which the critical dose lies in the middle half of the process window at full "
       "intensity or less, with the intensity reduced to put it in the middle where it can be; the report's "
       "planned_full_scale is the --full-scale for vam-project.",
       "With --shown the dose is that which a print has given, by its log: every image for as long as it was on, at "
       "the "
       "stage angle that it was on at, missed blanks, an abort and a stop by --until included. stage.speed_deg_s and "
       "the "
       "other settings are those of the run: give its printer.toml as --printer. The report then has dose_shown "
       "instead "
       "of dose_per_turn, and shown_turns, the mean number of turns over the stage angles.",
       "The point spread of the beam (resin.psf_mm) and the diffusion of dose during the print "
       "(resin.diffusion_mm2_s) blur the volume; the dose beyond its faces is taken as 0."},
      {{"Simulate the print of the disc grid and score it:",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-sinogram part.vdb --filter ram-lak --negative clip "
        "| vam-resample | vam-dose --like part.vdb -o dose.vdb && vam-score dose.vdb --target part.vdb"},
       {"The effect of a telecentric correction on a projector that is not telecentric:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample --set projector.telecentric=true | "
        "vam-dose --like part.vdb -o wrong.vdb"},
       {"Projections for a centred vial, in one that wobbles by 0.3 mm:",
        "seq 0 89 | awk 'BEGIN { print \"angle_deg,dx_mm,dy_mm,dz_mm,moves\" } { t = $1 * 3.14159265 / 45; print 4 * "
        "$1 "
        "\",\" 0.3 * cos(t) \",\" (-0.3 * sin(t)) \",0,vial\" }' >wobble.csv && vam-optimize --angles 90 part.vdb | "
        "vam-dose "
        "--poses wobble.csv --like part.vdb -o wobbled.vdb"},
       {"A handle printed around the shaft of a screwdriver:",
        "vam-slice --shape handle --insert-shape screwdriver --voxel 0.8 -o handle.vdb && vam-optimize --angles 60 "
        "handle.vdb | vam-dose --like handle.vdb | vam-score --target handle.vdb"},
       {"Duration of a print in an absorbing resin:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample | vam-dose --like part.vdb --set "
        "resin.absorption_per_mm=0.06 --set resin.critical_dose_mj_cm3=100 --report time.json -o dose.vdb"},
       {"The dose of an aborted print, here a dry run:",
        "vam-sinogram part.vdb --angles 90 --filter ram-lak --negative clip | vam-resample -o short.exr && timeout 15 "
        "vam-print short.exr --display null: --uncalibrated --set stage.device=sim: --set stage.speed_deg_s=85 "
        "--missed "
        "0.9 --run-up 0.1 --turns 20 --run ended || vam-dose short.exr --shown ended --printer ended/printer.toml "
        "--like "
        "part.vdb --report given.json -o given.vdb"}},
      {"Accuracy: chief-ray doses agree with a sum over individual rays to 1e-3. The dose of a voxel is the mean over "
       "its volume, across the beam exactly for pixels of uniform intensity, along the axis linear between rows. "
       "Outside the radius that is lit from all sides, rays form caustics; doses there are accurate to some per cent.",
       "Memory, where rays climb: 90 slices of dose; the light of 64 slices and of those around them whose rows reach "
       "them, 4 bytes a lit column and angle; 48 images of the stack; the table of rays, 90 bytes for each of 1440 "
       "directions and of the voxels from the axis to the corner of the grid (8 times as many beyond the writable "
       "radius); 0.3 bytes a voxel; and 0.1 GiB. Of dose and --like the voxels beyond 32 MiB lie in a scratch file in "
       "$TMPDIR, else /var/tmp. Around an insert 24 bytes a voxel, the whole stack and three times the light "
       "of its lit columns are added. Where rays stay level: three batches of 64 slices and images.",
       "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq "
       "8; Kelly et al., Volumetric additive manufacturing via tomographic reconstruction, Science 2019, eq 1."},
      {"vam-optimize", "vam-resample", "vam-score", "vam-view"}};
}

}  // namespace vam::dose_tool
