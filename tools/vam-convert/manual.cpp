// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

cli::Manual manual() {
  return {
      "vam-convert",
      "exchange volumes and projections with other programs",
      {"vam-convert reads data of other programs and writes files of these tools, or the reverse; the content of the "
       "input decides. A volume (VDB) or a stack (EXR) becomes a NumPy array (.npy). An array of 2 or 3 axes "
       "(NumPy .npy and .npz, HDF5, NRRD, MRC, TIFF of several pages) becomes a volume with --voxel, or a stack of "
       "sinograms "
       "with --geometry, so that vam-dose computes the "
       "dose of projections made by any program. A folder of numbered images (PNG, TIFF) or a video (MKV, MP4) is read "
       "as projections, one for each stage angle; with --voxel a folder is read as the slices of a volume, from the "
       "lowest up, the top row "
       "of an image at the largest y, as one sees it from above and as vam-slice reads it.",
       "Arrays have the order [z][y][x] for volumes, z upwards and y from the lowest; [slice][angle][column] for "
       "sinograms, slices upwards; "
       "and [frame][row][column] for frames, row 0 at the top. Output is in little-endian 4-byte floats in C order. "
       "Input may be integers of 1 to 8 bytes, floats of 2, 4 or 8 bytes, or booleans, in either byte order and in C "
       "or "
       "Fortran order. --axes gives another order of the axes: projections of VAMToolbox, [column][angle][z], have the "
       "order xaz. Values are unchanged unless --full-scale is given. Python objects (pickles) are refused. "
       "Of NRRD, MRC and TIFF files the values are read (x the fastest axis, pages as z, and as of every array the "
       "rows of a page from the lowest y up) and voxel size and place are "
       "given by options; where the header of an NRRD file states other voxels than --voxel (spacings, space "
       "directions), a "
       "warning states both. What MRC and TIFF files state is not compared, as many programs leave it at 1 or at the "
       "resolution of a screen. "
       "NRRD values must be in the same file, raw or gzip, TIFF pages grey and in strips.",
       "A volume is taken as it lies. The print of a target is lower than its volume by the vertical magnification of "
       "the projector, for which vam-slice stretches its parts; for arrays --stretch-z does so, and without it a "
       "warning states the factor (1.04 for the default printer). --stretch-z 1 is for arrays that are stretched "
       "already.",
       "Of HDF5 files one dataset is read, of integers or floats of any size, packed by gzip, shuffle or szip, or not: "
       "the one that --array names, else /exchange/data (DXchange), else that of the NeXus groups, else the only one "
       "of "
       "3 axes. With --geometry the projections of DXchange and NXtomo files are read as these keep them, "
       "[angle][row][column] with row 0 at the top, unless --axes is given; of NXtomo those whose image_key is 0. "
       "Their "
       "stage angles (theta, rotation_angle, in degrees, or in radians where their attribute units says so) give the "
       "step and the first angle, unless --view-step is given; each must lie within a tenth of a step of even ones. "
       "Flat and dark fields are not divided out. MATLAB stores the axes in reverse order. Values in other files "
       "(external links, virtual datasets) and filters of plugins (LZF of h5py, Blosc) are refused, the latter with "
       "the "
       "command that unpacks a copy.",
       "Projections of other programs do not state their geometry, which is therefore given by options: the column "
       "pitch at the axis (--pixel), the stage angle between projections (--view-step), the column of the axis "
       "(--axis-column), the row of z = 0 (--axis-row) and the orientation of the images (--orientation). With "
       "--geometry parallel they are those of a parallel beam in the resin, as of a telecentric projector with an "
       "index-matching bath; columns are added until the axis is in the middle. With --geometry vial they are "
       "images of the projector of the printer file, shifted so that the axis is at projector.axis_column, and "
       "vam-dose "
       "follows their rays through bath, glass and resin.",
       "A folder of EXR images, numbered in the order of the stage angles (patterns/0000.exr, 0001.exr, ... of "
       "Dr.TVAM), "
       "is read as other folders are, but its values are intensities, not grey levels: from channel Y, or the only "
       "one, unchanged unless --full-scale is given. Dr.TVAM's pixel_size is --pixel; patterns that are even "
       "over one turn need no --view-step. Compare the direction of the turn with a part that is not symmetric; "
       "--view-step -360/N reverses it.",
       "Grey values of images are fractions of full grey. They are used as intensity, or with --geometry vial "
       "converted by projector.response. Colour images and videos are read as luma (0.299 red, 0.587 green, 0.114 "
       "blue): "
       "for a video in blue only, as OpenCAL plays it, full intensity is --full-scale 0.114. Of H.264 in yuv420p some "
       "25 "
       "levels of blue remain; if that is too coarse, write RGB (libx264rgb, or FFV1 in bgr0) or extract the blue "
       "channel "
       "first. Videos in YUV have a limited range (black at 16, white at 235 of 255) unless they state the full one, "
       "as yuvj420p does; grey and RGB have the full range, whatever they state, as ffmpeg takes them. "
       "The stage angle between the frames of a video is 6 x turns per minute / frames per second."},
      {{"A part to NumPy, and back:",
        "vam-slice --shape disc-grid --voxel 0.5 | vam-convert -o part.npy\n"
        "vam-convert part.npy --voxel 0.5 --stretch-z 1 -o again.vdb"},
       {"Its projections as an array, and the dose of such an array:",
        "vam-slice --shape disc-grid --voxel 0.5 -o part.vdb\n"
        "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-convert -o sino.npy\n"
        "vam-convert sino.npy --geometry parallel --pixel 0.5 | vam-dose --like part.vdb -o dose.vdb"},
       {"Projections from an HDF5 file in the order of tomography, as DXchange keeps them:",
        "vam-slice --shape disc-grid --voxel 0.5 -o part.vdb\n"
        "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-convert -o sino.npy\n"
        "/usr/bin/python3 -c 'import h5py, numpy\n"
        "sino = numpy.load(\"sino.npy\")\n"
        "with h5py.File(\"scan.h5\", \"w\") as f:\n"
        "    f[\"exchange/data\"] = sino[::-1].transpose(1, 0, 2)\n"
        "    f[\"exchange/theta\"] = numpy.arange(360.0)'\n"
        "vam-convert scan.h5 --geometry parallel --pixel 0.5 | vam-dose --like part.vdb -o dose.vdb"},
       {"Does a folder of frames print?",
        "vam-slice --print-printer --set projector.columns=64 --set projector.rows=64 --set projector.pixel_mm=0.5 -o "
        "small.toml\n"
        "export VAM_PRINTER=small.toml\n"
        "vam-slice --shape disc-grid --voxel 0.5 -o part.vdb\n"
        "vam-sinogram --filter ram-lak --negative clip part.vdb | vam-resample | vam-project --turns 1 -o frames\n"
        "vam-convert frames --geometry vial --like part.vdb | vam-dose --like part.vdb | vam-score --target part.vdb"}},
      {"Memory: one image of an array in C order, and the file for .npz and TIFF, and for HDF5 from a pipe; of HDF5 "
       "the images of a chunk, or an eighth of the memory in another order; the whole of any other array in another "
       "order, whose first values are needed last; 4 bytes for each lit pixel of frames that become sinograms; a "
       "volume as it is stored.",
       "An array is parsed in a process of its own (vam-formats(7), DESCRIPTION). Sizes are up to 65536 along an axis "
       "and 2^28 an image. Values that are not finite are refused."},
      {"vam-dose", "vam-project", "vam-score", "vam-view"}};
}

}  // namespace vam::convert_tool
