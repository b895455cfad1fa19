// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-view/options.hpp"

namespace vam::view_tool {

cli::Manual manual() {
  return {
      "vam-view",
      "draw volumes, sinograms, frames, videos, meshes and traces as figures",
      {"vam-view recognises a file by its content, not by its name: an OpenVDB volume (part, dose, scatter, distance), "
       "an OpenEXR stack (sinograms or frames), an FFV1 or H.264 video, or a folder of numbered images. It draws it "
       "with "
       "axes in mm or degrees and a colour bar with the unit, as PNG, PDF or SVG.",
       "For a volume it shows a section: axial (x to the right, y up), coronal (x to the right, z up) or sagittal (y "
       "to the right, z up), the middle one or the one at --at. For sinograms it shows the middle slice, detector bins "
       "to the right and stage angles downwards; for frames the first one, oriented as in the file. --sheet N shows N "
       "of them, evenly spaced. z is in mm of the print: that of the volume or of its sinograms, which vam-slice "
       "stretches for the magnification of the projector, divided by vam:stretch_z.",
       "--target draws the surface of the part (coverage 1/2) as a line over the dose. --dose-histogram instead shows "
       "the distributions of dose inside and outside the part, each as a percentage of its voxels (logarithmic): if "
       "they overlap, no "
       "threshold separates the part from its surroundings. Voxels cut by the surface and voxels outside the writable "
       "circle are excluded.",
       "--cure-map shows what prints at a threshold: correctly cured (grey), missing (blue) and overcured (vermilion); "
       "without --at the section nearest to the middle with much missing, if any. Walls that no voxel nearby is half "
       "covered by, and where walls are cut, are missing, too. "
       "--render shows the same in three dimensions, the print beside the target; without --target it shows the "
       "surface of any grid. With an output in .mp4 it is a movie: the print as it grows, from where the first resin "
       "gels to the end of the exposure, at a constant intensity. Its label counts turns and seconds where the dose "
       "states "
       "them (vam-dose --exposure-plan or --shown) or vam-score would plan them, for a resin with a critical dose; "
       "else "
       "it is the percentage of the exposure. --compare shows two volumes beside each other in the "
       "same colours, and their "
       "difference. Meshes are shown as bodies, in the colours of their vertices if there are any (vam-sdf "
       "--output); the --trace of vam-optimize, a file that ends in .csv, as curves over the iterations. Any other "
       "table "
       "that ends in .csv and begins with the names of its columns is drawn, too: up to four columns over the first "
       "one. A unit in which all of their names end, as in open_mm,closed_mm, is stated at the axis.",
       "An insert in the volume, or in that of --target, is hatched, and green in three dimensions. Resin that it "
       "shadows from some stage angles is "
       "orange, more saturated with the number of angles (for a horizontal parallel beam). Its voxels are no resin, "
       "and "
       "count neither in --dose-histogram nor in the shares of --cure-map.",
       "Coverage and intensity are shown in grey; dose and other quantities in viridis, which is perceptually uniform; "
       "signed values in blue, white and red, with zero in the middle. The colours end where one pixel in 1000 is "
       "beyond; the legend states how many are, and the extreme. Sinograms are cropped to the columns that are lit. "
       "--export writes the values as NRRD for "
       "ParaView, 3D Slicer or numpy."},
      {{"Side view of a part, and a contact sheet of nine slices:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb\n"
        "vam-view part.vdb --plane coronal -o side.png\n"
        "vam-view part.vdb --sheet 9 -o sheet.png"},
       {"Its filtered sinogram:",
        "vam-slice --shape gyroid --voxel 0.2 | vam-sinogram --filter ram-lak | vam-view -o sino.png"},
       {"What a dose prints, in a section and in three dimensions:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb\n"
        "vam-sinogram part.vdb --filter ram-lak | vam-dose --like part.vdb -o dose.vdb\n"
        "vam-view dose.vdb --target part.vdb --cure-map -o cure.png\n"
        "vam-view dose.vdb --target part.vdb --render -o print.png"},
       {"A movie of the print as it grows, for a talk:",
        "vam-slice --shape gyroid --voxel 0.4 -o part.vdb\n"
        "vam-sinogram part.vdb --filter ram-lak | vam-dose --like part.vdb -o dose.vdb\n"
        "vam-view dose.vdb --target part.vdb --render --image-size 320 -o growth.mp4"},
       {"A section for a paper:",
        "vam-slice --shape gyroid --voxel 0.2 | vam-view --title '' --image-size 320 -o part.pdf"},
       {"Values for ParaView:", "vam-slice --shape gyroid --voxel 0.2 | vam-view --export part.nrrd"}},
      {"Memory: the volume as stored in its file and the images shown; stacks are read one image at a time.",
       "Pixels are enlarged by integer factors at 96 pixels per inch, so that each voxel is a square of the same size; "
       "reduced images are averaged after colour mapping.",
       "Source: the histogram follows Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, 2022, "
       "fig S6."},
      {"vam-dose", "vam-project", "vam-score", "vam-sinogram", "vam-slice"}};
}

}  // namespace vam::view_tool
