// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-curethrough/manual.hpp"

namespace vam::curethrough {

namespace {

std::vector<std::string> description() {
  return {
      "In continuous stereolithography, light that passes through the slice at the window cures the resin behind it. "
      "In a clear, fast resin the gaps above each feature close (cure-through) while its bottom edge remains soft "
      "(undercure). vam-curethrough computes the dose that a stack of slices delivers, and the grey slices that cure "
      "exactly the part, column by column.",
      "Direction: slice 0 is the lowest slice of the volume (--platform top: the highest). It adheres to the platform "
      "and is printed first; the light enters through the window, from the side of the last slice. \"Above\" a feature "
      "means towards the platform, the direction in which light propagates.",
      "Dose: Omega(n) = Phi_n (1 - q) + q Omega(n + 1), with q = 10^(-slice height / absorbance height), Omega in "
      "units of the full-cure dose D_f and Phi in units of the full-cure intensity speed x D_f. With --exposure-mode "
      "layered the platform rests for each layer: Omega(n) = q (Phi_n + Omega(n + 1)) at the far side of layer n.",
      "correct: inside features the dose is at least 1 and at most --omega-max, 1 at both edges, below 1 outside. It "
      "rises below a feature at maximum intensity, as late as possible, and falls above it at minimum intensity. With "
      "--omega-max 1 the total exposure is the minimum under these constraints; with more, features receive as much "
      "dose as their edges and the limit allow. Additional slices follow the last slice of the part, as its lowest "
      "features require. A gap of a single slice between two features cannot stay open at any intensity; such columns "
      "are reported and marked in --mask.",
      "model: dose and cure map of any slices: EXR, a folder of images, or the ordinary slices of a volume (maximum "
      "intensity in the part, minimum outside). A voxel is cured if the dose at its centre is at least 1. The height "
      "error of a feature is the undercured height inside it plus the cured height of the gap above it.",
      "working-curve: absorbance height h_a and gelation threshold from cured thickness against exposure. response: "
      "the table for projector.response from photodiode readings. sweep: height errors of a ladder as a function of "
      "the assumed full-cure dose and omega-max."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {{"The ladder of the paper and the result of ordinary slices:",
           "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 | vam-curethrough model --max-irradiance 110 "
           "--min-irradiance 0.2 --section ordinary.png"},
          {"The corrected slices of the ladder, exact and as 8-bit images:",
           "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 | vam-curethrough correct --max-irradiance 110 "
           "--min-irradiance 0.2 -o slices.exr --png slices"},
          {"The result of the corrected slices:",
           "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 -o ladder.vdb\n"
           "vam-curethrough correct ladder.vdb --max-irradiance 110 --min-irradiance 0.2 -o slices.exr\n"
           "vam-curethrough model slices.exr --target ladder.vdb --max-irradiance 110 --min-irradiance 0.2 --section "
           "corrected.png --report corrected.json"},
          {"Comparison of three resins for this part:",
           "printf 'name,absorbance_height_um,full_cure_dose_mj_cm3\\nclear,2000,576\\ndyed,800,576\\ndark,300,576\\n' "
           ">resins.csv\n"
           "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 | vam-curethrough correct --max-irradiance 110 "
           "--min-irradiance 0.2 --catalogue resins.csv"},
          {"Absorbance height and gelation threshold from measured thicknesses:",
           "printf 'exposure_mj_cm2,thickness_um\\n20,370\\n20,381\\n50,1168\\n50,1175\\n130,2004\\n130,1996\\n' | "
           "vam-curethrough working-curve --plot curve.png"},
          {"The grey response from photodiode readings:",
           "printf 'grey,reading\\n0,0.2\\n64,5.3\\n128,24\\n192,57\\n255,110\\n' | vam-curethrough response -o "
           "response.csv"},
          {"The study of the paper's figure 5c:",
           "vam-curethrough sweep df_over_dc=1..8,omega_max=1..5 --max-irradiance 110 --min-irradiance 0.2 --report "
           "sweep.json"}};
}

std::vector<std::string> notes() {
  return {
      "Memory of correct: one bit per voxel, 30 bytes per column, a few slices, and while reading 130 bytes per block "
      "of 8 x 8 x 8 voxels that the surface crosses, from a file or a pipe. At 1920 x 1080 x 1000 voxels a gyroid "
      "whose surface crosses nearly every block takes 0.7 GiB and about 50 s of processor time shared by the cores, "
      "mostly for compression. --quantise keeps all slices (2 bytes per pixel). Memory of model: one bit and an eighth "
      "of a byte per voxel and some slices, 1.0 GiB in this example, plus the dose volume with -o.",
      "Grey levels: rounding to 8 bits would shift the dose inside features by up to half a level of Phi, more than a "
      "percent. The levels of --png and --quantise are chosen from the last slice upwards, each the lowest that still "
      "reaches the dose given the levels below it; the dose is therefore never too low, and too high by at most the "
      "contribution of one level in a single slice.",
      "Timing: slice n is shown from time n / fps, fps = speed / slice height. The stack has the attributes vam:fps, "
      "vam:exposure (--exposure-mode), vam:speed_mm_h (--print-speed) and a time for each slice, the folder an index "
      "frames.csv in the format of vam-project.",
      "Accuracy: the recursion agrees with the integral of Beer's law over time to 1e-6, and the correction with the "
      "optimum of a linear program. Voxels are inside or outside the part, by --min-coverage. Flow, diffusion and "
      "inhibition are neglected.",
      "Full-cure dose: D_f is the dose to which features are exposed; the paper, which calls it D_c, found five times "
      "the gelation threshold D_c of working-curve (D_gel of the paper) to be best: the default, where "
      "resin.critical_dose_mj_cm3 gives D_c.",
      "With --exposure-mode layered, the depth cured beyond a feature's top edge by the minimum intensity alone is not "
      "corrected: absorbance height x log10(1 + Phi_min).",
      "Source: Pritchard et al., Modelling and correcting cure-through in continuous stereolithographic 3D printing, "
      "Adv. Mater. Technol. 2019 [CURE19]; working curve: Jacobs, Rapid Prototyping and Manufacturing, 1992."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-curethrough", "model and correct cure-through in continuous stereolithography",
          description(),     examples(),
          notes(),           {"vam-slice", "vam-project", "vam-view", "vam-score"}};
}

}  // namespace vam::curethrough
