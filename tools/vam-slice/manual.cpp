// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/file.hpp"
#include "solid/shapes/shapes.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

namespace {

std::vector<std::string> description() {
  return {
      "vam-slice writes the grid 'target': the fraction of each voxel, 0 to 1, that the part covers. Coordinates are "
      "in millimetres; x = y = 0 is the rotation axis, z points upwards along it, and z = 0 is the height of the "
      "projector's lens (projector.axis_row; by default the middle of its rows). A second grid, 'insert', represents "
      "an opaque object to print around.",
      "PART is a mesh (" + io::mesh_format_names() +
          ", identified by content), or a folder of numbered grey images (PNG or TIFF), one per slice from the lowest "
          "upwards, white inside, the top row at the largest y; each pixel is a voxel. --shape generates a test part "
          "without a file.",
      "Meshes are repaired first: coincident points are welded, rounding cracks closed, degenerate and duplicate "
      "triangles removed, all others oriented outwards. Solids may overlap or share faces; nested shells represent a "
      "solid within a "
      "solid, or a cavity if the inner shell faces inwards in the file. Repairs are reported in a warning. If holes "
      "remain, the inside is determined by majority: windings are counted along x, y and z from both ends of every row "
      "of voxels, "
      "and the median decides. A surface that encloses no volume is an error.",
      "The vial reduces the image of a projector that is not telecentric vertically, by M_vp < 1 (Orth et al. 2022). "
      "The target is therefore stretched along z by 1/M_vp, so that slices are rows of the projector and the print has "
      "its true height. --stretch-z 1 disables this. The factor is recorded as vam:stretch_z.",
      "Rays of a projector that is not telecentric climb, and climb more steeply with increasing distance from the "
      "height of the lens: horizontal faces far from that height are printed less sharply. --place raises the part; "
      "--place auto chooses the height at which its horizontal faces are blurred least. By default the part is at the "
      "height of the lens, or as near to it as the rows allow with two more voxels beyond each end. Target and "
      "projections then contain the part at this height."};
}

std::vector<std::string> limits() {
  return {
      "A part that is too large is refused; the error states the value of --scale (--fit, --voxel) that makes it fit. "
      "The part must fit into the projector's rows unless --any-height is given, for machines that lift the vial past "
      "the image during the print (vam-optimize --helix). A part without a voxel wholly inside, or smaller than a "
      "tenth of the writable width, causes a warning with the probable unit of the file or a suitable voxel size, "
      "and so do walls of which no voxel is half covered, which are not printed, and gaps of which none is three "
      "quarters free, which are printed shut.",
      "Slices of meshes and shapes begin where a row of the projector does (projector.axis_row), so that voxels "
      "that are one or several pixels high coincide with rows.",
      "3MF files state their unit, which is converted to mm; --unit and --insert-unit are refused for them.",
      "An insert keeps the size of its file, in mm or --insert-unit; one smaller than a tenth of the writable width "
      "causes a warning with the probable unit. Its origin coincides with that of PART's file and "
      "it is rotated with PART, so that the parts of an assembly stay together as long as PART is not scaled; "
      "--insert-at, --insert-rotate and --insert-scale override this. The volume has slices below and above the part "
      "where an insert shades light that climbs to it. An insert that misses the part, or overlaps it, causes a "
      "warning; --cut-insert subtracts it from the part with a clearance. A clearance below a voxel is in the "
      "coverage of the voxels, but they leave no room that stays free of light: where no voxel between insert and part "
      "is more than three quarters free a warning states on which share of the lines between them (clearance_shut in "
      "the "
      "report); a clearance of two voxels is free wherever it lies. At the insert's sharp "
      "edges and corners the clearance is up to 0.4 voxels less. The report contains its size, its "
      "centre and the number of its voxels in contact with the part.",
      "Within the writable radius resin is lit from all stage angles, beyond it from some. A part that extends beyond "
      "it is refused unless --extent resin is given; vam-optimize then uses the available rays and constrains the "
      "whole resin. vam-score --lit-fraction writes the fraction of stage angles from which each voxel is lit."};
}

std::vector<std::pair<std::string, std::string>> examples() {
  return {{"The gyroid of Orth et al. 2022, cell 7 mm, sheet 1 mm, in a cylinder of 14 mm x 10 mm:",
           "vam-slice --shape gyroid -o gyroid.vdb"},
          {"The disc grid of Orth et al. 2021 with coarser voxels, and a report:",
           "vam-slice --shape disc-grid:height=1 --voxel 0.13 --report discs.json -o discs.vdb"},
          {"A boat of the largest size that the printer allows:",
           "vam-slice --shape boat --fit-writable --voxel 0.13 -o boat.vdb"},
          {"A cone whose base is at the height of the lens, where rays do not climb:",
           "vam-slice --shape cone:bottom=8,height=6 --voxel 0.13 --place auto -o cone.vdb"},
          {"A handle to be printed around the shaft of a screwdriver:",
           "vam-slice --shape handle --insert-shape screwdriver --voxel 0.13 -o handle.vdb"},
          {"A block around a steel pin of 3 mm diameter, with 0.2 mm clearance, 2 mm off the axis:",
           "vam-slice --shape box:x=8,y=6,z=5 --insert-shape cylinder:diameter=3,height=12 --insert-at 2,0,0 "
           "--cut-insert 0.2 --voxel 0.1 -o block.vdb"}};
}

std::vector<std::string> notes() {
  std::vector<std::string> texts{
      "Accuracy: coverage by a closed mesh is exact (divergence theorem on triangles cut to voxels; 1e-6), also "
      "of solids that overlap or share faces; where their surfaces cross obliquely within a voxel, to 0.002. With "
      "holes "
      "of 8 % of the diameter, or 0.5 % of the facets missing, fewer than one voxel in 1000 is wrong by more than a "
      "half. A single shell that overlaps itself by less than a voxel is counted twice there. "
      "Test shapes are accurate to 2e-4 of their volume for features of a few voxels.",
      "Walls and gaps of a mesh between faces less than 2 voxels apart, and ridges and grooves of less than 1.5 voxels "
      "side by side, cause a warning with their thickness, a place and the voxels that resolve them; those below 1.5 "
      "voxels leave the verdict of vam-score and vam-optimize in doubt, and so do gaps below 2.83 voxels, such as "
      "bores, where no voxel at their middle or beside it is wholly outside the part (blocked_gaps in the report). "
      "Faces are found by short rays along the "
      "normals "
      "from points on the surface, one for each face of a voxel, 200000 at most; a wall counts from two such faces on, "
      "ridges from 120, and notches across an edge of a plate, such as half bores, only where they have two parallel "
      "faces. Faces that would meet within six voxels or four times their distance, as at the edge of a wedge "
      "or where a ball stands on a "
      "plate, are no walls and gaps, unless they are of surfaces that do not touch.",
      "Cavities that are closed on all sides, of 8 voxels or more, cause a warning with their number, their volume and "
      "a place in the largest, as resin cannot drain from them (trapped_resin in the report), but for a part with an "
      "insert. They are judged by voxels that are less than half covered and share faces: where walls are lost to the "
      "voxels no cavity is closed.",
      "Speed: a million triangles on 512 x 512 x 512 voxels take 2 s on two cores. Memory: the mesh, 16 slices, and "
      "the volume, whose interior is stored as tiles.",
      "The volume is square in x and y and just contains the bounding circle of the part; metrics of the void use the "
      "writable circle, regardless of the size of the volume. With --extent writable the volumes of several parts have "
      "the same size.",
      "Sources: [CAL17] Kelly et al., Computed Axial Lithography, 2017; [CAL19] Kelly et al., Science 2019; [RAY21] "
      "Orth et al., Opt. Express 2021; [OST22] Orth et al., On-the-fly 3D metrology, 2022; [CURE19] Pritchard et al., "
      "2019.",
      "Test shapes, with their parameters and defaults (mm and counts):"};
  for (const std::string& line : solid::describe_shapes()) texts.push_back(line);
  return texts;
}

}  // namespace

cli::Manual manual() {
  std::vector<std::string> paragraphs = description();
  for (const std::string& paragraph : limits()) paragraphs.push_back(paragraph);
  return {"vam-slice", "voxelise a mesh, images or a test part into the target volume", paragraphs, examples(),
          notes(),     {"vam-optimize", "vam-sdf", "vam-sinogram", "vam-view"}};
}

}  // namespace vam::slice_tool
