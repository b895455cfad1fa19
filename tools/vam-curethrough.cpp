// vam-curethrough: continuous stereolithography without cure-through [CURE19].
#include <string>

#include "cli/app.hpp"
#include "printer.hpp"
#include "vam-curethrough/figures.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace {

using namespace vam;

const char* const ladder = "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 -o ladder.vdb";

cli::Manual manual() {
  return {
      "vam-curethrough",
      "model and correct cure-through in continuous stereolithography",
      {"In continuous stereolithography light that passes through the slice at the window cures the resin behind it. "
       "In a clear, fast resin the gaps above each feature close (cure-through) while its bottom edge stays soft "
       "(undercure). vam-curethrough computes the dose that a stack of slices leaves in the part, and the grey slices "
       "that cure the part and nothing else, exactly and column by column.",
       "Direction: slice 0 is the lowest slice of the volume (--platform top: the highest). It sticks to the platform "
       "and is printed first; the light comes through the window, from the side of the last slice. \"Above\" a feature "
       "means towards the platform: that is where its light goes on to.",
       "Dose: Omega(n) = Phi_n (1 - q) + q Omega(n + 1), with q = 10^(-slice height / absorbance height), Omega in "
       "critical doses and Phi in units of the critical intensity speed x critical dose. With --exposure layered the "
       "platform rests for each layer: Omega(n) = q (Phi_n + Omega(n + 1)) at the far side of layer n.",
       "correct: inside features the dose is at least 1 and at most --omega-max, 1 at both edges, below 1 outside. It "
       "rises below a feature at the greatest intensity, as late as possible, and falls above it at the least. With "
       "--omega-max 1 no slices that keep these rules bring less light; with more, features get as much as their edges "
       "and the limit allow. After the part's last slice come those that its lowest features need. A gap of a single "
       "slice between two features cannot stay open at any intensity; such columns are counted, and --mask shows them.",
       "model: dose and cure map of any slices: EXR, a folder of pictures, or the ordinary slices of a volume (full "
       "light in the part, the least outside). A voxel is cured where the dose at its centre is at least 1. The height "
       "error of a feature is what is undercured inside it plus what is cured in the gap above it.",
       "working-curve: cured thickness against exposure gives the absorbance height h_a and the gelation dose. "
       "response: photodiode readings become the table that projector.response names. sweep: how the height errors of "
       "a ladder depend on the critical dose that is assumed and on omega-max."},
      {{"The ladder of the paper and what ordinary slices make of it:",
        std::string(ladder) +
            " && vam-curethrough model ladder.vdb --max-intensity 110 --min-intensity 0.2 --plane ordinary.png"},
       {"Its corrected slices, exact and as 8-bit pictures:",
        "vam-curethrough correct ladder.vdb --max-intensity 110 --min-intensity 0.2 -o slices.exr --png slices"},
       {"What those make of it:",
        "vam-curethrough model slices.exr --part ladder.vdb --max-intensity 110 --min-intensity 0.2 --plane "
        "corrected.png --report corrected.json"},
       {"Three resins compared for this part:",
        "printf 'name,absorbance_height_um,critical_dose_mj_cm3\\nclear,2000,576\\ndyed,800,576\\ndark,300,576\\n' > "
        "resins.csv && vam-curethrough correct ladder.vdb --max-intensity 110 --min-intensity 0.2 --catalogue "
        "resins.csv"},
       {"Absorbance height and gelation dose from measured thicknesses:",
        "printf 'exposure_mj_cm2,thickness_um\\n20,370\\n20,381\\n50,1168\\n50,1175\\n130,2004\\n130,1996\\n' | "
        "vam-curethrough working-curve --plot curve.png"},
       {"The grey response from photodiode readings:",
        "printf 'grey,reading\\n0,0.2\\n64,5.3\\n128,24\\n192,57\\n255,110\\n' | vam-curethrough response -o "
        "response.csv"},
       {"The study of the paper's figure 5c:",
        "vam-curethrough sweep dc=1..8,omega_max=1..5 --max-intensity 110 --min-intensity 0.2 --report sweep.json"}},
      {"Memory of correct: one bit a voxel, 30 bytes a column, a few slices, and while reading 130 bytes for each "
       "block of 8 x 8 x 8 voxels that the surface crosses, from a file and from a pipe. At 1920 x 1080 x 1000 voxels "
       "a gyroid whose surface crosses nearly every block takes 0.7 GiB, and about 50 s of processor time shared by "
       "the cores, most of it compression. --quantise keeps all slices (2 bytes a pixel). Memory of model: one bit and "
       "an eighth of a byte a voxel and some slices, 1.0 GiB there, and the dose volume when it is asked for.",
       "Grey levels: an ordinary rounding to 8 bits shifts the dose inside features by up to half a level of Phi, "
       "which is more than a percent. The levels of --png and --quantise are chosen from the last slice up, each the "
       "lowest that still reaches the dose after the levels below it; so the dose is never short, and over by at most "
       "one level's share of a single slice.",
       "Timing: slice n is shown from n / fps on, fps = speed / slice height. The stack has the attributes vam:fps, "
       "vam:speed_mm_h and a time for each slice, the folder an index frames.csv, in the form of vam-project's.",
       "Accuracy: the recursion agrees with the integral of Beer's law over time to 1e-6, and the correction with a "
       "linear program's optimum. Slices are taken as in or out of the part at --threshold. The model knows no flow, "
       "diffusion or inhibition; the paper found the best critical dose to be five times the gelation dose.",
       "Layer by layer, what is cured beyond a feature's top edge by the least intensity alone stays uncorrected: "
       "absorbance height x log10(1 + Phi_min).",
       "Source: Pritchard et al., Modelling and correcting cure-through in continuous stereolithographic 3D printing, "
       "Adv. Mater. Technol. 2019 [CURE19]; working curve: Jacobs, Rapid Prototyping and Manufacturing, 1992."},
      {"vam-slice", "vam-project", "vam-view", "vam-score"}};
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  std::string chosen;
  curethrough::Model model;
  curethrough::Correct correct;
  curethrough::WorkingCurve working_curve;
  curethrough::GreyResponse response;
  curethrough::Sweep sweep;
  cli::App& for_model = app.subcommand("model", "dose and cure map of slices", chosen);
  cli::App& for_correct = app.subcommand("correct", "slices without cure-through", chosen);
  cli::App& for_curve = app.subcommand("working-curve", "absorbance height and gelation dose", chosen);
  cli::App& for_response = app.subcommand("response", "grey response from photodiode readings", chosen);
  cli::App& for_sweep = app.subcommand("sweep", "parameter study on a ladder", chosen);
  curethrough::declare(for_model, model);
  curethrough::declare(for_correct, correct);
  curethrough::declare(for_curve, working_curve);
  curethrough::declare(for_response, response);
  curethrough::declare(for_sweep, sweep);
  return app.run(argc, argv, [&] {
    if (chosen == "model" && !tool::print_printer(model.print.printer)) run(app, for_model, model);
    if (chosen == "correct" && !tool::print_printer(correct.print.printer)) run(app, for_correct, correct);
    if (chosen == "working-curve") run(app, for_curve, working_curve);
    if (chosen == "response") run(app, for_response, response);
    if (chosen == "sweep" && !tool::print_printer(sweep.print.printer)) run(app, for_sweep, sweep);
  });
}
