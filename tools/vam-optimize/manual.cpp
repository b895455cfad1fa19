// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/methods/method.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

namespace {

void append(std::vector<std::string>& texts, const std::vector<std::string>& more) {
  texts.insert(texts.end(), more.begin(), more.end());
}

std::vector<std::string> purpose() {
  return {
      "Intensities are non-negative, so no set of projections gives exactly the dose that a part requires. "
      "vam-optimize reads the target (VDB, coverage 0...1) and computes non-negative projections whose dose separates "
      "part from void, so that a resin with a gelation threshold prints the part. The default beam model consists of "
      "the projector's chief rays, diverging from the lens and refracted by the vial; the output is a projector "
      "sinogram, one image per slice, ready for vam-project. With --geometry parallel the output is a virtual "
      "(parallel-beam) sinogram, which vam-resample converts for a projector: three to four times faster, but "
      "resampling then halves the process window.",
      "Step lengths are determined automatically.",
      "--method auto starts from projections that were optimised at half of the resolution, which in turn start from "
      "a quarter, as long as the finer of the two has at least 48 voxels across the part: an iteration takes an eighth "
      "of the time there, so most of the convergence is cheap. With --init, poses, --robust, --tradeoff or "
      "--grey-target, or if the coarser part does not print, auto is " +
          std::string(optimize::automatic_method) + " at full resolution with at least " +
          std::to_string(optimize::automatic_iterations) + " iterations."};
}

/// A paragraph for each row of the method table.
std::vector<std::string> methods() {
  std::vector<std::string> texts;
  for (const auto& entry : optimize::method_table()) {
    const std::string options = entry.options.empty() ? "" : " Options: " + join(entry.options, ", ") + ".";
    texts.push_back("Method " + entry.name + ": " + entry.summary + options + " Source: " + entry.paper + ".");
  }
  return texts;
}

std::vector<std::string> dose_and_intensity() {
  return {
      "The dose of the projections is relative: the printing threshold is (LOW + HIGH)/2 of --dose-low and "
      "--dose-high, the same number in every slice. Each slice is scaled so that this threshold lies in the middle of "
      "its process window; if the window is wider than HIGH requires, so that the minimum dose of the part is HIGH; if "
      "the threshold dose is prescribed on the surface, so that the threshold lies in the middle half of the window. "
      "The dose is the sum of intensity * (angle step in radian) over all angles along the rays.",
      "Intensity is limited (--max-intensity, --turns), because the brightest pixel at full grey determines the "
      "duration of the print: unconstrained projections consist of single-pixel peaks, and the print takes about ten "
      "times as long at the same process window. The reference is the even intensity, at which the mean dose is the "
      "threshold dose if every pixel is lit at every angle. The maximum intensity is twice that, and is raised while "
      "the conditions of --until are not met; --shortest begins lower and raises it in smaller steps, with which most "
      "parts print at 1.2 to 1.5 times the even intensity. Some parts have a wider process window without a limit "
      "(--max-intensity 0). If the resin is known, the report contains the number of turns and their duration at full "
      "grey."};
}

/// Numbers are those of preview.cpp.
std::vector<std::string> verdict() {
  return {
      "--preview optimises the part in 4 to 16 iterations on voxels four times as large as those of the target (twice "
      "as large, or equal, where walls or gaps of the part are too thin for these, or the print of the estimate is in "
      "other "
      "pieces than the part, and the part is small). The answer "
      "is yes or no, or unsure with the reason: the process window is narrower than 0.03, or walls and gaps of the "
      "part are too thin to be seen, or so thin, below 2.3 voxels of the target, that the print may have holes or "
      "bridges there, or the print of the estimate is torn: in other pieces than the part, with cut walls, shut gaps "
      "or holes. It includes a lower bound like "
      "that of --certify, computed on voxels of twice "
      "that size.",
      "The verdict of a full run counts the pieces of the print, its broken walls and shut gaps as vam-score does, "
      "except with "
      "--slices, where vam-score judges the joined volume."};
}

std::vector<std::string> printer_and_poses() {
  return {
      "With --robust the projections tolerate deviations of the printer from its settings: each iteration evaluates "
      "the nominal printer and two printers at opposite corners of the tolerances. The report contains the figures of "
      "merit of the nominal printer and at both ends of each tolerance, the costliest tolerance, and the yield, all at "
      "one exposure, simulated as by vam-dose with the grey levels of --bits. --until and --trace refer to the nominal "
      "printer; all --iterations are performed unless --until or --patience is given.",
      "Vial and part may move during the print. With --poses each frame has a displacement of the vial with its "
      "contents, or of the part within it (vam-formats(7), Poses), such as that of a part that sinks along a known "
      "curve. --wobble-record derives the displacement of a vial off the rotation axis from a calibration record. "
      "--helix lifts a part that is taller than the image past it (vam-slice --any-height). The projections are valid "
      "only for their poses, which are stored in the stack. The computation proceeds frame by frame, which takes three "
      "to five times as long. A displaced vial cannot be combined with a part that extends beyond the writable "
      "radius."};
}

std::vector<std::string> part_and_resin() {
  const auto compensating =
      optimize::method_names([](const optimize::MethodEntry& entry) { return entry.make({})->keeps_scale(); });
  return {
      "A grid 'insert' in the same file is an opaque object to print around (overprinting), which casts a shadow. Part "
      "voxels that it shadows from all stage angles are reported and excluded.",
      "Absorption by the resin (resin.absorption_per_mm) attenuates the beam: e^(-mu s), s the path length from the "
      "point of entry into the resin, is part of the forward model, and intensities are those at the point of entry.",
      "Voxels that the part's surface cuts (0 < coverage < 1) are neither part nor void. Method apg constrains the "
      "dose on the surface itself to the threshold, so that the print has the size of the design; with --free-surface, "
      "and with the other methods, prints are smaller by half a voxel all around. The band of --surface-margin around "
      "the surface is unconstrained. --surface constrains surface voxels like others. A slice with only such voxels is "
      "printed if any of them is at least half covered. --weights sets the relative cost of errors.",
      "With --grey-target the target is a dose for every voxel, for graded stiffness or colour: doses (or responses) "
      "must be met within --band, or within the tolerance of each voxel. The projections are then not scaled. VER is "
      "the fraction of voxels outside their band, PW the smallest margin of any voxel, negative outside, IPDR the "
      "largest and CV the root mean square error, IoU 1 - VER. Without it a target that seems grey causes a warning.",
      "The point spread of the beam (resin.psf_mm) and the diffusion of dose (resin.diffusion_mm2_s) blur the dose; " +
          join(compensating, ", ") + " compensate for it. Slices are then optimised together with their neighbours."};
}

std::vector<std::string> description() {
  std::vector<std::string> texts = purpose();
  append(texts, methods());
  append(texts, dose_and_intensity());
  append(texts, verdict());
  append(texts, printer_and_poses());
  append(texts, part_and_resin());
  return texts;
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {
      {"Projections of a gyroid for the default printer:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 -o part.vdb\n"
       "vam-optimize part.vdb -o sinogram.exr"},
      {"Will it print, for how long?",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 | vam-optimize --preview"},
      {"Computed axial lithography, with the figures of merit of every iteration:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 | vam-optimize --method cal --iterations 20 --trace "
       "trace.csv -o cal.exr"},
      {"Continue from that result until part and void are separated:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 -o part.vdb\n"
       "vam-optimize --method cal --iterations 20 part.vdb -o cal.exr\n"
       "vam-optimize --method cal --init cal.exr --until 'ver=0,pw>=0.02' --iterations 40 part.vdb -o better.exr"},
      {"Quantised to the 16 grey levels of a 4-bit projector:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 | vam-optimize --bits 4 --dither 1 -o coarse.exr"},
      {"Compensated for a beam 0.1 mm wide, and safe to interrupt:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 -o part.vdb\n"
       "vam-optimize --set resin.psf_mm=0.1 --checkpoint part.state part.vdb -o sharp.exr"},
      {"Robust to errors of the axis and of the lamp:",
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 | vam-optimize --angles 24 --robust "
       "'axis=0.5px,lamp=3%' "
       "--yield-printers 10 --report robust.json -o robust.exr"},
      {"A bound for any projections, and the regions of the part that determine it:",
       "vam-slice --shape gyroid:diameter=4,height=1 --voxel 0.25 | vam-optimize --angles 12 --certify proof.vdb "
       "--report proved.json -o best.exr\n"
       "vam-view proof.vdb -o proof.png"},
      {"A part three times as tall as the image, in three turns:",
       "vam-slice --print-printer --set projector.rows=40 --set projector.pixel_mm=0.1 --set projector.columns=240 -o "
       "low.toml\n"
       "export VAM_PRINTER=low.toml\n"
       "vam-slice --shape gyroid:diameter=8,height=11 --voxel 0.25 --any-height -o tall.vdb\n"
       "vam-optimize --angles 60 --helix 5.2 tall.vdb -o helix.exr"},
      {"What is left after one turn in full light:",
       "vam-slice --print-printer --set resin.critical_dose_mj_cm3=50 --set resin.absorption_per_mm=0.05 -o lab.toml\n"
       "export VAM_PRINTER=lab.toml\n"
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 -o part.vdb\n"
       "vam-optimize --angles 90 part.vdb -o whole.exr\n"
       "vam-dose whole.exr --like part.vdb -o turn.vdb\n"
       "vam-optimize --angles 90 part.vdb --delivered turn.vdb --init whole.exr --turns 1 -o rest.exr"},
      {"A part that sinks by 1 mm during the turn:",
       "seq 0 59 | awk 'BEGIN { print \"angle_deg,dx_mm,dy_mm,dz_mm,moves\" } { print 6 * $1 \",0,0,\" (-$1 / 59) "
       "\",part\" }' >sinking.csv\n"
       "vam-slice --shape gyroid:diameter=5,height=2 --voxel 0.25 | vam-optimize --angles 60 --poses sinking.csv -o "
       "sinking.exr"},
      {"Graded stiffness: a bar whose dose rises from one grey image to the next, each met within 0.25:",
       "vam-project --pattern ramp --steps 6 --set projector.columns=40 --set projector.rows=40 --set "
       "projector.telecentric=true -o ramp/\n"
       "vam-slice ramp --voxel 0.2 --stretch-z 1 -o graded.vdb\n"
       "vam-optimize --grey-target --resin-response linear --band 0.25 --angles 120 --iterations 20 graded.vdb -o "
       "graded.exr"}};
}

std::vector<std::string> notes() {
  return {
      "Figures of merit (VER, PW, IPDR, CV, IoU; defined in vam-score(1)) are computed slice by slice. In --trace and "
      "--until PW is that of the worst slice, IPDR the largest, the others are means weighted by voxel count.",
      "Speed: skew rays couple the slices, and all are then optimised together; two projections of 160 slices of 256 x "
      "256 voxels at 360 angles then take 3 s on two cores. Otherwise identical slices are computed once. A parallel "
      "beam gives the same dose from either side, so for an even number of angles half of them are computed and "
      "mirrored.",
      "Where rays climb, all methods share one scale, one step and one goal among all slices. The light of halves of a "
      "gyroid and of a boat that were optimised apart (osmo, pm, apg; 8 iterations) differs from that of the whole by "
      "0.09 to 1 of the peak (largest value; RMS 0.0007 to 0.03), with 32 slices of the other half around each by 0.1 "
      "to 1 (RMS 0.001 to 0.03). --slices is therefore refused there.",
      "Memory: three arrays of a slice and three of a sinogram's lit columns each (apg: seven and three; minimax: "
      "eight and ten), with "
      "--patience one more of the latter, 4 bytes per "
      "value, of all slices if they are coupled, else of 64 slices at a time, plus the target as stored in its file, "
      "0.5 kB for each slice, 0.2 GiB and at most 512 MiB for "
      "finished slices that recur; with --bits all projections. Of coupled slices, what exceeds --memory is kept in "
      "scratch files in TMPDIR (default: /var/tmp). With --robust an iteration "
      "takes three times as long and needs one more array of the slices and four more of the sinograms, and all "
      "projections are kept; each simulated printer takes the time of vam-dose."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-optimize",
          "optimise the projections that print a part",
          description(),
          examples(),
          notes(),
          {"vam-slice", "vam-sinogram", "vam-resample", "vam-dose", "vam-score"},
          {},
          {{130, "SIGINT; with --checkpoint the run can be resumed."}, {143, "SIGTERM; likewise."}}};
}

}  // namespace vam::optimize_tool
