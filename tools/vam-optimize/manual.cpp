#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

cli::Manual manual() {
  return {
      "vam-optimize",
      "find projections that print a part",
      {"Light only adds up, so no set of projections gives exactly the dose that a part asks for. vam-optimize reads "
       "the target (VDB, coverage 0...1) and looks for non-negative projections whose dose separates part from void, "
       "so that a resin with a threshold prints the part. It works with the projector's own chief rays, diverging from "
       "the lens and refracted on their way, and writes a projector's sinogram stack, one image a slice, ready for "
       "vam-project. With --geometry parallel it writes a virtual (parallel-beam) stack instead, which vam-resample "
       "takes to a projector: three to four times faster, but resampling then costs the print half of its process "
       "window.",
       "Methods: fbp is filtered back-projection with negative light set to 0. dose-norm raises the void to a "
       "background and divides the target once by the dose that it gets: quick and good. cal descends the gradient of "
       "the print's error with the resin's threshold inside the loop. osmo corrects a model of the part by the dose's "
       "errors, void and part in turn. pm minimises how far doses are on the wrong side of LOW and HIGH, to the power "
       "P; bclp how far the resin's response is outside a band around the target. apg, the best of them, asks the void "
       "to stay below LOW and the part to reach HIGH and descends by preconditioned, accelerated projected gradient, "
       "slice by slice from the better of fbp and dose-norm; a slice that has reached both is asked for a wider "
       "window. "
       "No method has a step length to choose.",
       "The dose that the projections give is relative: the printing threshold is (LOW + HIGH)/2 of --dose-low and "
       "--dose-high, the same number in every slice. Each slice is scaled so that this threshold lies in the middle of "
       "its process window, or so that the part's least dose is HIGH where the window is wider than that. Adding up "
       "light * (angle step in radian) over all angles along the rays gives this dose.",
       "A grid 'insert' in the same file is an opaque object to print around (overprinting): rays carry no light "
       "behind it. Part voxels that no light can reach are counted in the report and left out.",
       "A resin that absorbs (resin.absorption_per_mm) weakens light on its way: e^(-mu s) is then part of the dose "
       "that the method works with, s the path from where the ray enters the resin, and light is what enters there.",
       "Voxels that the part's surface cuts (0 < coverage < 1) are neither part nor void: they are asked for nothing, "
       "nor is the band of --tolerance-mm around the surface. --surface asks them too. A slice that has only such "
       "voxels is printed if any of them is at least half covered. --weights says which errors cost more.",
       "With --grey the target is a dose for every voxel, for graded stiffness or colour: doses (or responses) are to "
       "be met within --band, or within a tolerance of each voxel's own. The light is not scaled then. VER is the "
       "share of the voxels outside their band, PW the least margin that any has, negative outside, IPDR the largest "
       "and CV the root mean square error, IoU 1 - VER.",
       "The beam's point spread (resin.psf_mm) and the diffusion of dose (resin.diffusion_mm2_s) smear the dose; apg, "
       "cal, pm and bclp find light that makes up for it. The slices are then optimised together with their "
       "neighbours."},
      {{"Projections of a gyroid for the default printer:",
        "vam-slice --shape gyroid --voxel 0.25 -o part.vdb && vam-optimize part.vdb -o light.exr"},
       {"Computed axial lithography, with the figures of merit of every iteration:",
        "vam-optimize --method cal --iterations 20 --trace trace.csv part.vdb -o cal.exr"},
       {"Go on from there until the part separates from the void:",
        "vam-optimize --method cal --init cal.exr --until 'ver=0,pw>=0.02' --iterations 40 part.vdb -o better.exr"},
       {"In the 16 grey levels of a 4-bit projector:", "vam-optimize --bits 4 --error-feedback part.vdb -o coarse.exr"},
       {"Made up for a beam that is 0.1 mm wide, and safe to interrupt:",
        "vam-optimize --set resin.psf_mm=0.1 --checkpoint part.state part.vdb -o sharp.exr"},
       {"Graded stiffness: a bar whose dose rises from one grey picture to the next, each to 0.25:",
        "vam-project --pattern ramp --steps 6 --set projector.columns=40 --set projector.rows=40 --set "
        "projector.telecentric=true -o ramp/ && vam-slice ramp --voxel 0.2 --stretch-z 1 -o graded.vdb && vam-optimize "
        "--grey --response linear --band 0.25 --angles 120 --iterations 20 graded.vdb -o graded.exr"}},
      {"Figures of merit (physics of the field: VER, PW, IPDR, CV, IoU; vam-score has their definitions) are worked "
       "out slice by slice. In --trace and --until PW is that of the worst slice, IPDR the largest, the others are "
       "means by voxel count.",
       "Speed: identical slices are computed once. Two projections of 64 slices of 256 x 256 voxels at 360 angles take "
       "0.2 s on two cores in the vial, 0.06 s in parallel light. Parallel light gives the same dose from either side, "
       "so for an even number of angles half of them are computed and mirrored. Memory: 64 slices at a time, three "
       "arrays of a slice and three of a sinogram each, plus at most 512 MiB of finished slices that come again; with "
       "--bits and without --peak all projections.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, eq 3 and fig 2; Kelly et al., Science 2019, eq 4; "
       "Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, Methods and fig S6 (where the "
       "text floors the projections at the background, but the figures show them non-negative: --floor 0 is right); "
       "Rackson et al., Object-space optimization of tomographic reconstructions, 2021 (osmo); Bhattacharya et al., "
       "High fidelity volumetric additive manufacturing, 2021 (pm); Li, Toombs, Taylor and Wallin, Tomographic "
       "projection optimization for volumetric additive manufacturing with general band constraint Lp-norm "
       "minimization, 2024 (bclp); Beck and Teboulle, FISTA, 2009, and Bertsekas, two-metric projection, 1982 (apg)."},
      {"vam-slice", "vam-sinogram", "vam-resample", "vam-dose", "vam-score"}};
}

}  // namespace vam::optimize_tool
