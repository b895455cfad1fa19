// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/options.hpp"

namespace vam::project {

namespace {

std::vector<std::string> description() {
  return {
      "Reads a projector sinogram (vam-optimize, vam-resample) and writes one frame for every frame period of the "
      "projector while the stage rotates. A sinogram stack has an image for each slice, with a row for each angle; a "
      "projector requires the transpose: an image for each time, with a row for each slice.",
      "The output name selects the format. A name without an extension, or ending in /, is a folder of numbered PNG "
      "files with an index frames.csv (file, time_s, angle_deg). A name in .mkv is lossless FFV1 video, suitable for "
      "printing. A name in .mp4 is H.264 video for viewing; its errors of up to 59 of 255 make it unsuitable for "
      "printing. A name in .exr, or standard output, is an EXR frame stack with the intensity as a fraction of full "
      "intensity, quantised only when --bits is given.",
      "Live: the output sdl:N is a window over screen N of the desktop, drm:HDMI-A-1 the connector itself by page "
      "flips (without a desktop), null: a dry run. The frames of one turn are preloaded; at every vertical blank the "
      "frame for the stage angle in the middle of its display time is shown. With --follow the angle is predicted from "
      "the output of vam-stage spin, and frames are black before angle 0 and after the last turn. By default the angle "
      "is the speed times the time since the first frame. The run-up turn is a dry run: if vertical blanks are missed "
      "in it, the print does not start. During the print a missed vertical blank leaves a frame on for one period too "
      "long and is logged; the print ends only when their fraction exceeds --max-missed-lit. Frame size and screen "
      "size must be equal.",
      "Time: frame n is centred on the time n / fps and the stage angle n x speed / fps, and is shown for one frame "
      "period. If the sinogram has as many angles as there are frames in a turn, every frame is one of its rows. "
      "Otherwise it is interpolated linearly between the two nearest angles or, where frames are coarser than angles, "
      "averaged over the angles that it spans, so that a turn delivers the same dose.",
      "A stack with poses (vam-optimize --poses, --helix) is shown for its own number of turns, regardless of "
      "stage.turns; if the last pose leads back to the first one, --turns repeats it. vam-project does not move the "
      "vial: index and time of each frame are those of the table of poses. Live, only poses that repeat every turn can "
      "be shown.",
      "Rows: z = 0 is at projector.axis_row, counted from the top, and z points upwards. A row shows the mean of the "
      "slices over its height, so that each slice delivers its light at its own height. Where slices begin and end "
      "with rows, as those of vam-slice do if a voxel is one or several pixels high, they are shown unchanged. Columns "
      "are those of vam-resample, with the axis at projector.axis_column; --column-offset shifts them. Intensity "
      "outside the projector's columns or rows is an error. The orientation is applied last.",
      "Grey: the value --full-scale (default: the maximum of the stack) is shown at full intensity, times "
      "--multiplier. Each pixel is set to the grey level whose intensity is nearest to the required one, by the "
      "measured response (projector.response) or else the linear response from min_intensity to max_intensity.",
      "With --dither N the rounding error of each pixel is carried over to the next columns and angles, and a pixel "
      "between two levels shows the higher one in some of N turns. The dose of a voxel, a sum over hundreds of pixels, "
      "is then accurate to much less than a level, even with 1 bit. Live, the frames of N turns are preloaded. "
      "vam-dose --bits --dither computes the dose of such frames.",
      "Slices of continuous stereolithography (vam-curethrough correct) are shown one after the other, each once, "
      "slice n from n / fps on, with fps = print speed / slice height: both are stated in the EXR stack, --print-speed "
      "or --fps override them, and a folder of images has its times in frames.csv. The slices required after the last "
      "feature are part of the stack. A slice smaller than the projector's image is centred at axis_column, axis_row; "
      "its values are fractions of full intensity, or grey. Live, each is shown for 1 / fps, by elapsed time, and all "
      "are preloaded.",
      "With --flatland the frames show one slice of a virtual sinogram from above: each is the 1-D projection at its "
      "angle, extended across the plane. Projected onto a thin layer of resin they print the cross-section, and the "
      "sum of the frames is its dose (Kelly et al. 2017, fig 3)."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {
      {"The frames of a part as numbered images:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --filter ram-lak --negative clip | vam-resample | "
       "vam-project -o frames/"},
      {"A lossless video of two turns at 24 deg/s and 30 frames per second:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --filter ram-lak --negative clip | vam-resample | "
       "vam-project --turns 2 --speed 24 --fps 30 -o print.mkv"},
      {"Black and white frames for a projector mounted upside down:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --filter ram-lak --negative clip | vam-resample | "
       "vam-project --bits 1 --orientation rotate-180 -o black-white/"},
      {"Black and white frames of two turns whose rounding errors cancel:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --filter ram-lak --negative clip | vam-resample | "
       "vam-project --bits 1 --dither 2 --turns 2 -o cancelling/"},
      {"Validation video of the middle slice:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --angles 90 --filter ram-lak --negative clip | "
       "vam-project --flatland 0 -o flatland.mp4"},
      {"The slices of a continuous print, 1000 mm/h at 50 um per slice, as a video of 5.56 frames per second:",
       "vam-slice --shape ladder:rungs=2 --voxel 0.05 --stretch-z 1 | vam-curethrough correct --max-irradiance 110 "
       "--min-irradiance 0.2 | vam-project --set projector.pixel_mm=0.05 -o slices.mkv"},
      {"A focus star as an image:", "vam-project --pattern star -o star/"},
      {"A synchronised print of one turn, here a dry run on a simulated stage:",
       "vam-slice --shape disc-grid --voxel 0.195 | vam-sinogram --filter ram-lak --negative clip | vam-resample -o "
       "projector.exr\n"
       "vam-stage spin --device sim: --speed 90 --run-up 0.25 | vam-project projector.exr -o null: --follow - --speed "
       "90 "
       "--max-missed 0.1"}};
}

std::vector<std::string> notes() {
  return {
      "Safety (live output). When vam-project ends for any reason, hangs or receives no stage angle for 0.5 s or "
      "misses too many flips, a child process, the guardian, makes the screen black and the light engine dark within "
      "100 ms. Software is no interlock: install a hardware interlock that cuts the lamp. A closed window shows the "
      "desktop behind it: make that black and keep the pointer on another screen. The LED current never exceeds "
      "projector.max_led_current_percent. With projector.relay, a relay in the supply of the lamp receives a heartbeat "
      "while frames are flipped and opens by itself otherwise, even when the machine has failed; a print requires its "
      "reply (its firmware is in vam-devices(7)). After a print on drm:, Linux may return its text console to the "
      "screen: move the console to another one (kernel option fbcon=map:) and use --light, which is then in standby, "
      "or a shutter.",
      "Priority. As root, or with permission for a real-time priority of 2 (see vam-stage(1)), the flips and the "
      "guardian run before other programs.",
      "Light engines. dlpc350:SERIAL (LightCrafter 4500) and dlpc900:SERIAL (6500, 9000) on USB have the options "
      "current_percent=0..100 (of full current; default: unchanged), max_current_percent (at most "
      "projector.max_led_current_percent) and leds (any of r, g and b; default: b). The engine leaves standby, is set "
      "to video with linear grey, and every setting is read back before its LEDs are enabled. At the end its LEDs are "
      "switched off, then patterns are stopped, then it returns to standby. Commands and faults are described in "
      "vam-devices(7).",
      "Linear grey. The gamma of a DLPC350 is switched off. That of a DLPC900 cannot be: it is set to its video "
      "pattern mode, in which each frame is three patterns of 8 bits without gamma, one colour after the other. This "
      "requires a video signal of at most 60 Hz, so its screen must be on. In addition, the GPU's gamma table must be "
      "linear: drm: sets and verifies it; sdl: uses that of the desktop (xrandr --gamma 1:1:1 makes it linear).",
      "Memory. The lit columns of the whole stack as floats, at most 4 bytes x angles x slices x columns (360 angles x "
      "200 slices x 400 lit columns: 115 MB), and a few frames; a display takes all frames, a byte per pixel, and with "
      "--frames-from those to come and those they replace as well. Frames cannot be computed slice by slice.",
      "PNG: 1, 2, 4 and 8 bits are stored at that depth. 10 bits are stored in 16, spread over the full range and "
      "marked by an sBIT chunk, as the PNG specification requires; a shift to the right by 6 restores the level. "
      "Video: depths below 8 bits are spread over 0..255, 10 bits are gray10le with unchanged levels, 16 bits "
      "gray16le. Matroska rounds time stamps to 1 ms; the frame rate itself is exact.",
      "stage.direction is applied in vam-resample, whose rows are stage angles; the stage angle of frames always "
      "increases.",
      "Sources: Kelly et al., Computed Axial Lithography, 2017; Orth et al., Correcting ray distortion in tomographic "
      "additive manufacturing, Opt. Express 2021."};
}

}  // namespace

cli::Manual manual() {
  return {"vam-project",
          "convert sinograms into projector frames and show them",
          description(),
          examples(),
          notes(),
          {"vam-optimize", "vam-resample", "vam-curethrough", "vam-stage", "vam-view"},
          {},
          cli::device_statuses};
}

}  // namespace vam::project
