#include "vam-view/options.hpp"

namespace vam::view_tool {

cli::Manual manual() {
  return {
      "vam-view",
      "make a picture of a volume, a sinogram, frames or a video",
      {"vam-view looks at what is in the file, whatever its name: an OpenVDB volume (part, dose, scatter, distance), "
       "an OpenEXR stack (sinograms or frames), an FFV1 or H.264 video, or a folder of numbered pictures. It writes "
       "one PNG with axes in mm or degrees, a colour bar with the unit, and a scale bar where a pixel has a size.",
       "Of a volume it shows a section: axial (x to the right, y up), coronal (x to the right, z up) or sagittal (y to "
       "the right, z up), the middle one or the one at --at. Of sinograms it shows the middle slice, columns to the "
       "right and stage angles downwards; of frames the first one, upright as in the file. --sheet N shows N of them, "
       "evenly spread.",
       "--target draws the surface of the part (coverage 1/2) as a line over the dose. --histogram shows the doses "
       "inside and outside the part instead, as shares of the voxels on each side: where the two overlap, no threshold "
       "prints the part. Voxels that the surface cuts, and those outside the writable circle, are left out.",
       "Coverage and light are grey; dose and other amounts are viridis, in which equal steps look equal; signed "
       "values are blue, white and red with zero in the middle. --export writes the numbers as NRRD for ParaView, 3D "
       "Slicer or numpy."},
      {{"The part from the side, and a sheet of nine slices:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb && vam-view part.vdb --plane coronal -o side.png && vam-view "
        "part.vdb --sheet 9 -o sheet.png"},
       {"Its filtered sinogram:",
        "vam-sinogram part.vdb --filter ram-lak -o sino.exr && vam-view sino.exr -o sino.png"},
       {"The numbers for ParaView:", "vam-view part.vdb --export part.nrrd"}},
      {"Memory: the volume as it is in its file and the pictures shown; stacks go by one image at a time.",
       "Pixels are enlarged by whole factors, so that each voxel is a square of the same size; reduced pictures are "
       "averaged after colouring.",
       "Sources: the histogram is that of Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, "
       "2022, fig S6."},
      {"vam-dose", "vam-project", "vam-score", "vam-sinogram", "vam-slice"}};
}

}  // namespace vam::view_tool
