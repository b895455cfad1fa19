#include "io/mesh/file.hpp"
#include "solid/shapes/shapes.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

cli::Manual manual() {
  cli::Manual manual{
      "vam-slice",
      "voxelise a mesh, images or a test part into the target volume",
      {"Writes the grid 'target': the fraction, 0 to 1, of every voxel that the part covers. Coordinates are "
       "millimetres; x = y = 0 is the rotation axis, z points up along it, and z = 0 is level with the projector's "
       "lens (projector.axis_row), the middle of its rows unless set. A second grid, 'insert', is an opaque object to "
       "print around.",
       "PART is a mesh (" + io::mesh_format_names() +
           ", identified by content), or a folder of numbered grey images (PNG or "
           "TIFF), one for each slice from the lowest up, white inside, each pixel a voxel. --shape makes a test part "
           "without a file.",
       "Meshes are repaired first: coincident points are welded, rounding cracks closed, degenerate and duplicate "
       "triangles removed, all others oriented outwards. Solids may overlap; nested shells are a solid within a solid, "
       "or a cavity if the inner shell faces inwards in the file. Repairs are reported in a warning. If holes remain, "
       "the inside test is a vote: along x, y and z, windings are counted from both ends of every row of voxels, and "
       "the median decides. A surface that encloses no volume is an error.",
       "The vial reduces the image of a projector that is not telecentric vertically, by M_vp < 1 (Orth et al. 2022). "
       "The target is therefore stretched along z by 1/M_vp, so that slices are rows of the projector and the print "
       "has its true height. --stretch-z 1 disables this. The factor is recorded as vam:stretch_z.",
       "Rays of a projector that is not telecentric climb, the more the farther from the height of the lens: level "
       "faces there are less sharp than those level with it. --place lifts the part, --place auto to where its level "
       "faces suffer least. The target has the part at that height, and so have its projections.",
       "A part that is too large is refused with the value of --scale (--fit, --voxel) that makes it fit. It must fit "
       "into the projector's rows, unless --any-height is given: a machine that lifts the vial during the print brings "
       "it past the image (vam-optimize --helix). A part that all but vanishes, without a voxel wholly inside or "
       "below a tenth of the writable width, is a warning with the unit that the file is probably in, or the voxel "
       "that may help.",
       "An insert has a size and place of its own: that of its file, in mm or --insert-unit, with its origin where the "
       "origin of PART's file comes to lie and turned as PART is, so that parts of one assembly stay together as long "
       "as PART is not scaled. --insert-at, --insert-rotate and --insert-scale replace that. An insert that misses the "
       "part, or takes up room of it, is a warning; --cut-insert subtracts it, with a clearance. The report has its "
       "size, its middle and how many voxels touch the part.",
       "Within the writable radius resin is lit from all stage angles, beyond it from some. A part that reaches beyond "
       "is "
       "refused, unless --extent resin is given: vam-optimize then uses the rays there are and constrains all of the "
       "resin. vam-score --reach shows from how many angles each voxel is lit."},
      {{"The gyroid of Orth et al. 2022, cell 7 mm, sheet 1 mm, in a cylinder of 14 mm x 10 mm:",
        "vam-slice --shape gyroid -o gyroid.vdb"},
       {"The disc grid of Orth et al. 2021 on a coarser grid, with a report:",
        "vam-slice --shape disc-grid:height=1 --voxel 0.13 --report discs.json -o discs.vdb"},
       {"A boat as large as the printer allows:", "vam-slice --shape boat --fit-writable --voxel 0.13 -o boat.vdb"},
       {"A cone whose base is level with the lens, where rays do not climb:",
        "vam-slice --shape cone:bottom=8,height=6 --voxel 0.13 --place auto -o cone.vdb"},
       {"A handle to be printed around the shaft of a screwdriver:",
        "vam-slice --shape handle --insert-shape screwdriver --voxel 0.13 -o handle.vdb"},
       {"A block around a steel pin of 3 mm, 0.05 mm of clearance, 2 mm beside the axis:",
        "vam-slice --shape box:x=8,y=6,z=5 --insert-shape cylinder:diameter=3,height=12 --insert-at 2,0,0 --cut-insert "
        "0.05 --voxel 0.1 -o block.vdb"}},
      {},
      {"vam-optimize", "vam-sdf", "vam-sinogram", "vam-view"}};
  manual.notes = {
      "Accuracy: coverage by a closed mesh is exact (divergence theorem on triangles cut to voxels; 1e-6). Where the "
      "surfaces of two overlapping solids cross within a voxel its coverage is their sum, at most 1. With holes of 8 % "
      "of the diameter or 0.5 % of the facets missing, fewer than one voxel in 1000 is wrong by more than a half. "
      "Shapes: 2e-4 of the volume for features of a few voxels.",
      "Speed and memory: a million triangles on 512 x 512 x 512 voxels take 2 s on two cores. Memory: the "
      "mesh, 16 slices, and the volume with its interior as tiles.",
      "The volume is square in x and y and just contains the bounding circle of the part; metrics of the void use the "
      "writable circle, regardless of the size of the volume. --extent writable makes volumes of several parts match.",
      "Sources: [CAL17] Kelly et al., Computed Axial Lithography, 2017; [CAL19] Kelly et al., Science 2019; [RAY21] "
      "Orth et al., Opt. Express 2021; [OST22] Orth et al., On-the-fly 3D metrology, 2022; [CURE19] Pritchard et al., "
      "2019.",
      "The shapes, with their parameters and defaults (mm and counts):"};
  for (const std::string& line : solid::describe_shapes()) manual.notes.push_back(line);
  return manual;
}

}  // namespace vam::slice_tool
