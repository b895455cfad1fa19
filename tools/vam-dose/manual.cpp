#include "vam-dose/options.hpp"

namespace vam::dose_tool {

cli::Manual manual() {
  return {
      "vam-dose",
      "simulate the dose that a print leaves in the resin",
      {"vam-dose reads sinograms and writes the volume 'dose': the light that every voxel takes up in one turn of the "
       "vial. It is the judge of the chain before resin is spent: what reaches the same dose will print alike.",
       "A projector's sinograms (from vam-resample) are simulated by chief rays: for every voxel and stage angle the "
       "column whose ray passes through the voxel, refraction and Fresnel losses included, its light per width by the "
       "density of the rays at that depth, and absorption along the way through the resin. Virtual sinograms "
       "(vam-sinogram, vam-optimize) are back-projected along parallel rays, with absorption if the resin has any.",
       "A grid 'insert' in the volume of --like is an opaque object that is printed around (overprinting; vam-slice "
       "--insert): every ray ends at the first voxel that is at least half insert, so that all behind it is in shadow, "
       "and the insert itself takes up no dose. Voxels of the part that no ray reaches are counted "
       "(dark_part_voxels of the report) and warned about.",
       "The dose is in units of light times radian (an even light of 1 gives 2 pi at most), or in mJ/cm3 when the "
       "resin "
       "has resin.critical_dose_mj_cm3 and resin.absorption_per_mm: then the largest value of the stack, or "
       "--full-scale, is taken as projector.max_intensity_mw_cm2, and the report says how many turns and seconds the "
       "print takes at stage.speed_deg_s. With --exposure-plan the dose is that of a whole print: the fewest turns in "
       "which the middle of the process window reaches the critical dose, with the light dimmed to reach it exactly; "
       "vam-project --full-scale takes the report's peak_value.",
       "The point spread of the beam (resin.psf_mm) and the diffusion of dose while it prints (resin.diffusion_mm2_s) "
       "blur the volume; beyond its faces it is taken as dark."},
      {{"Will the disc grid print?",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-sinogram part.vdb --filter ram-lak --negative clip "
        "| "
        "vam-resample | vam-dose --like part.vdb -o dose.vdb && vam-score dose.vdb --target part.vdb"},
       {"What a telecentric correction would do on a projector that is not:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample --set projector.telecentric=true | "
        "vam-dose --like part.vdb -o wrong.vdb"},
       {"A handle printed around the shaft of a screwdriver:",
        "vam-slice --shape handle --insert-shape screwdriver --voxel 0.8 -o handle.vdb && vam-optimize --angles 60 "
        "handle.vdb | vam-dose --like handle.vdb | vam-score --target handle.vdb"},
       {"The time a print takes in a resin that absorbs:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample | vam-dose --like part.vdb --set "
        "resin.absorption_per_mm=0.06 --set resin.critical_dose_mj_cm3=100 --report time.json -o dose.vdb"}},
      {"Accuracy: chief-ray doses agree with rays counted one by one to 1e-3. A voxel holds the mean dose of its "
       "volume "
       "across the beam to second order; between columns light is linear. Outside the radius that is lit from all "
       "sides "
       "rays fold into caustics; there doses are good to some per cent. The rays' tilt along the axis is not followed: "
       "a slice lights its own voxels.",
       "Memory: the dose itself, the volume of --like, and three batches of 64 slices.",
       "Sources: Orth et al., Correcting ray distortion in tomographic additive manufacturing, Opt. Express 2021, eq "
       "8; "
       "Kelly et al., Volumetric additive manufacturing via tomographic reconstruction, Science 2019, eq 1."},
      {"vam-optimize", "vam-resample", "vam-score", "vam-view"}};
}

}  // namespace vam::dose_tool
