#include "base/text.hpp"
#include "optimize/methods/method.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

namespace {

/// A paragraph for each row of the method table.
std::vector<std::string> methods() {
  std::vector<std::string> texts;
  for (const auto& entry : optimize::method_table()) {
    const std::string reads = entry.options.empty() ? "" : " Reads " + join(entry.options, ", ") + ".";
    texts.push_back("Method " + entry.name + ": " + entry.summary + reads + " Source: " + entry.paper + ".");
  }
  return texts;
}

std::vector<std::string> description() {
  std::vector<std::string> texts{
      "Intensities are non-negative, so no set of projections gives exactly the dose that a part requires. "
      "vam-optimize reads the target (VDB, coverage 0...1) and computes non-negative projections whose dose separates "
      "part from void, so that a resin with a gelation threshold prints the part. The default beam model consists of "
      "the projector's chief rays, diverging from the lens and refracted by the vial; the output is a projector "
      "sinogram, one image per slice, ready for vam-project. With --geometry parallel the output is a virtual "
      "(parallel-beam) sinogram, which vam-resample converts for a projector: three to four times faster, but "
      "resampling then halves the process window.",
      "Step lengths are determined automatically."};
  const auto compensating =
      optimize::method_names([](const optimize::MethodEntry& entry) { return entry.make({})->keeps_scale(); });
  for (const auto& text : methods()) texts.push_back(text);
  texts.insert(
      texts.end(),
      {"The dose of the projections is relative: the printing threshold is (LOW + HIGH)/2 of --dose-low and "
       "--dose-high, the same number in every slice. Each slice is scaled so that this threshold lies in the middle of "
       "its process window, or so that the part's minimum dose is HIGH if the window is wider than that, or, where the "
       "threshold dose is prescribed on the surface, so that it lies in the middle half of the window. The dose is "
       "the sum of intensity * (angle step in radian) over all angles along the rays.",
       "Intensity is limited (--max-intensity, --turns), because the brightest pixel at full grey determines the "
       "duration of the print: unconstrained projections consist of single-pixel peaks, and their print takes some "
       "ten times as long at the same process window. The scale is the even intensity, at which the mean dose is the "
       "threshold dose if every pixel is lit at every angle. The limit is twice that, and is raised while the "
       "conditions of --until are not met; --shortest begins lower and raises it in smaller steps, with which most "
       "parts print with 1.2 to 1.5 times the even intensity. Some parts have a wider process window without a limit "
       "(--max-intensity 0). With a known resin the report contains the number of turns and their duration at full "
       "grey.",
       "With --robust the projections tolerate deviations of the printer from its settings: each iteration evaluates "
       "the printer "
       "as set and at two others with all tolerances used up, in opposite ways. The report has the figures as set and "
       "at either end of each tolerance, the tolerance that costs most, and the yield, all at one exposure, judged by "
       "the simulation of vam-dose with the grey levels of --bits. --until and --trace are about the printer as set; "
       "all --iterations are done unless they or --patience are given.",
       "Vial and part need not stand still: with --poses each frame has a displacement of the vial with its contents "
       "or "
       "of the part in it (vam-formats(7), Poses), as of a part that sinks by a known curve; --wobble takes that of a "
       "vial off the rotation axis from a calibration record; --helix lifts a part that is taller than the image "
       "past "
       "it (vam-slice --any-height). Such projections are valid only with their poses: the table is part of the stack. "
       "It is computed frame by frame, which takes three to five times as long. A displaced vial cannot be combined "
       "with "
       "a part beyond the writable radius.",
       "A grid 'insert' in the same file is an opaque object to print around (overprinting): it casts a "
       "shadow. Part voxels in its shadow from all sides are reported and excluded.",
       "Absorption by the resin (resin.absorption_per_mm) attenuates the beam: e^(-mu s), s the path length from the "
       "point of entry into the resin, is part of the forward model, and intensities are those at the point of entry.",
       "Voxels that the part's surface cuts (0 < coverage < 1) are neither part nor void. Method apg asks for the "
       "threshold dose on the surface itself, so that the print has the size of the design; --free-surface does not, "
       "nor do other methods, whose prints are smaller by half a voxel all around. The band of --surface-margin around "
       "the surface is unconstrained. --surface constrains surface voxels like others. A slice with only such "
       "voxels is printed if any of them is at least half covered. --weights sets the relative cost of errors.",
       "With --grey-target the target is a dose for every voxel, for graded stiffness or colour: doses (or responses) "
       "must be "
       "met within --band, or within the tolerance of each voxel. The projections are not scaled then. VER is the "
       "fraction of voxels outside their band, PW the smallest margin of any voxel, negative outside, IPDR the largest "
       "and CV the root mean square error, IoU 1 - VER.",
       "The point spread of the beam (resin.psf_mm) and the diffusion of dose (resin.diffusion_mm2_s) blur the dose; " +
           join(compensating, ", ") + " compensate for it. Slices are then optimised together with their neighbours."});
  return texts;
}

}  // namespace

cli::Manual manual() {
  return {
      "vam-optimize",
      "optimise the projections that print a part",
      description(),
      {{"Projections of a gyroid for the default printer:",
        "vam-slice --shape gyroid --voxel 0.25 -o part.vdb && vam-optimize part.vdb -o sinogram.exr"},
       {"Computed axial lithography, with the figures of merit of every iteration:",
        "vam-optimize --method cal --iterations 20 --trace trace.csv part.vdb -o cal.exr"},
       {"Resume from that result until the part separates from the void:",
        "vam-optimize --method cal --init cal.exr --until 'ver=0,pw>=0.02' --iterations 40 part.vdb -o better.exr"},
       {"Quantised to the 16 grey levels of a 4-bit projector:",
        "vam-optimize --bits 4 --error-feedback part.vdb -o coarse.exr"},
       {"Compensated for a beam that is 0.1 mm wide, and safe to interrupt:",
        "vam-optimize --set resin.psf_mm=0.1 --checkpoint part.state part.vdb -o sharp.exr"},
       {"For printers whose axis and lamp are not quite as set:",
        "vam-optimize --robust 'axis=0.5px,lamp=3%' --yield-printers 10 --report robust.json part.vdb -o robust.exr"},
       {"A part three times as tall as the image, in three turns:",
        "printer='--set projector.rows=40 --set projector.axis_row=19.5 --set projector.pixel_mm=0.1 --set "
        "projector.columns=240 --set projector.axis_column=119.5' && vam-slice --shape gyroid:diameter=8,height=11 "
        "--voxel 0.25 $printer --any-height -o tall.vdb && vam-optimize --angles 60 --helix 5.2 $printer tall.vdb -o "
        "helix.exr"},
       {"A part that sinks by 1 mm during the turn:",
        "seq 0 59 | awk 'BEGIN { print \"angle_deg,dx_mm,dy_mm,dz_mm,moves\" } { print 6 * $1 \",0,0,\" (-$1 / 59) "
        "\",part\" }' "
        ">sinking.csv && vam-optimize --angles 60 --poses sinking.csv part.vdb -o sinking.exr"},
       {"Graded stiffness: a bar whose dose rises from one grey image to the next, each to 0.25:",
        "vam-project --pattern ramp --steps 6 --set projector.columns=40 --set projector.rows=40 --set "
        "projector.telecentric=true -o ramp/ && vam-slice ramp --voxel 0.2 --stretch-z 1 -o graded.vdb && vam-optimize "
        "--grey-target --resin-response linear --band 0.25 --angles 120 --iterations 20 graded.vdb -o graded.exr"}},
      {"Figures of merit (VER, PW, IPDR, CV, IoU; defined in vam-score(1)) are computed slice by slice. In --trace and "
       "--until PW is that of the worst slice, IPDR the largest, the others are means weighted by voxel count.",
       "Speed: skew rays couple the slices, and all are then optimised together; two projections of 160 "
       "slices of 256 x 256 voxels at 360 angles then take 3 s on two cores. Otherwise identical slices are computed "
       "once. A parallel beam gives the same dose from either side, so for an even number of angles half of them are "
       "computed and mirrored. Memory: three arrays of a slice and three of a sinogram each, of all slices where they "
       "are coupled, else of 64 slices at a time, plus at most 512 MiB of finished slices that occur again; with "
       "--bits "
       "and without --full-scale all projections. With --robust an iteration takes three times as long and needs one "
       "array more of the slices and four of the sinograms, and all projections are kept; each printer that is judged "
       "costs about a third of a plain iteration."},
      {"vam-slice", "vam-sinogram", "vam-resample", "vam-dose", "vam-score"},
      {},
      {{130, "SIGINT; with --checkpoint the run can be resumed."}, {143, "SIGTERM; likewise."}}};
}

}  // namespace vam::optimize_tool
