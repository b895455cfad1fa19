// Options of vam-sdf.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "metrology/ost/bodies.hpp"
#include "model/mesh.hpp"

namespace vam::sdf_tool {

struct Options {
  std::string command;
  std::string print = "-";
  std::string design;
  std::string output;
  std::string align = "full";
  bool scale = false;
  std::optional<double> isovalue;
  std::string resin_record;
  std::optional<double> pieces_mm3;
  double design_isovalue = 0.5;
  int samples = 200000;
  std::string histogram;
  int bins = 101;
  std::optional<double> limit_mm;
  std::string require;
  std::string report;
  std::optional<double> tolerance_mm;
  std::string volume;
  double volume_voxel_mm = 0;
};

/// vam-sdf height.
struct HeightOptions {
  std::string image = "-";
  std::string design;
  double pixel_mm = 0.05;
  double full_mm = 1;
  std::optional<double> lowest_mm;
  std::string align = "full";
  double design_isovalue = 0.5;
  std::string output;
  std::vector<double> line;
  std::string plot;
  std::string require;
  std::string report;
};

/// A mesh as it is, or the surface of a volume at `isovalue`, in the frame of the part: vam-slice's stretch in z
/// undone.
[[nodiscard]] model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue);

/// The same for a print: without the bodies that are too small to belong to it (metrology::keep_bodies), which are
/// counted in `bodies`; a mesh stays as it is.
[[nodiscard]] model::TriangleSoup read_print(const std::string& path, std::optional<double> isovalue,
                                             std::optional<double> least_mm3,
                                             std::optional<metrology::BodyCount>& bodies);

/// The deviation around the design's surface as a volume, for vam-slice --compensate. `print` is aligned.
void write_deviation_volume(const cli::App& app, const Options& options, const model::TriangleSoup& print,
                            const model::TriangleSoup& design, double rms_mm);

/// Print against design.
void deviation(const cli::App& app, const Options& options);

/// Height image against design.
void height(const HeightOptions& options);

}  // namespace vam::sdf_tool
