#include "vam-convert/options.hpp"

namespace vam::convert_tool {

cli::Manual manual() {
  return {
      "vam-convert",
      "exchange volumes and projections with other programs",
      {"vam-convert reads data of other programs and writes the files of these tools, and the other way round. It "
       "recognizes a file by its content. A volume (VDB) or a stack (EXR) becomes an array of NumPy (.npy). An array "
       "of 2 "
       "or 3 axes (.npy, .npz) becomes a volume if --voxel is given, or with --projections a stack of sinograms, so "
       "that "
       "vam-dose computes the dose of anybody's projections. A folder of numbered images (PNG, TIFF) and a video (MKV, "
       "MP4) are read as projections, too, one for each stage angle, or with --voxel as the slices of a volume.",
       "Arrays: [z][y][x] of volumes, z upwards; [slice][angle][column] of sinograms, slices upwards; "
       "[frame][row][column] "
       "of frames, row 0 at the top. Written are little-endian 4-byte floats in C order. Read are whole numbers of 1 "
       "to 8 "
       "bytes, floats of 2, 4 and 8, and truth, of either byte order, in C or Fortran order, the latter without "
       "another "
       "word. --axes names the axes of an array in another order: projections of VAMToolbox, which are "
       "[column][angle][z], "
       "have the order xaz. Values are kept as they are unless --full-scale is given. Python objects (pickles) are "
       "never read.",
       "Projections: other programs do not state where they belong, so it is said here: the pitch of the columns at "
       "the "
       "axis (--pixel), the stage angle between projections (--angle-step), the column of the axis (--axis-column), "
       "the "
       "row of z = 0 (--axis-row) and how the images are turned (--orientation). With --projections virtual they are "
       "those "
       "of a parallel beam in the resin, as of a telecentric projector with an index bath; the columns are extended "
       "until "
       "the axis is in their middle. With --projections projector they are images of the projector of the printer "
       "file, "
       "moved so that the axis is at projector.axis_column, and vam-dose follows their rays through bath, glass and "
       "resin.",
       "Grey of images is a fraction of full grey, and that is the intensity, or with --projections projector what "
       "projector.response makes of it. Colours are read as their luma, so that of a film in blue alone, as OpenCAL "
       "plays "
       "it, full intensity is --full-scale 0.114 and some 30 levels are left; extract its blue channel first where "
       "that is too coarse. The stage angle from frame to frame of a film is 6 x turns per minute / frames per "
       "second."},
      {{"A part to NumPy, and back:",
        "vam-slice --shape disc-grid --voxel 0.5 -o part.vdb && vam-convert part.vdb -o part.npy && vam-convert "
        "part.npy "
        "--voxel 0.5 -o again.vdb"},
       {"Its projections as an array, and the dose of such an array:",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-convert -o sino.npy && vam-convert sino.npy "
        "--projections virtual --pixel 0.5 | vam-dose --like part.vdb -o dose.vdb"},
       {"Does a folder of frames print?",
        "vam-sinogram part.vdb --filter ram-lak --negative clip | vam-resample --set projector.columns=64 --set "
        "projector.rows=64 --set projector.pixel_mm=0.5 | vam-project --set projector.columns=64 --set "
        "projector.rows=64 "
        "--set projector.pixel_mm=0.5 --turns 1 -o frames && vam-convert frames --projections projector --set "
        "projector.columns=64 --set projector.rows=64 --set projector.pixel_mm=0.5 --like part.vdb | vam-dose --like "
        "part.vdb --set "
        "projector.columns=64 --set projector.rows=64 --set projector.pixel_mm=0.5 | vam-score --target part.vdb"}},
      {"Memory: one image in C order; all of the array in another order, as its first values are needed last; of "
       "frames "
       "that become sinograms what is not dark in them, 4 bytes a pixel; a volume as it is stored.",
       "An array is parsed in a process of its own (vam-formats(7), DESCRIPTION). Sizes are up to 65536 along an axis "
       "(volumes: 32768) and 2^28 an image. Values that are not finite are refused."},
      {"vam-dose", "vam-project", "vam-score", "vam-view"}};
}

}  // namespace vam::convert_tool
