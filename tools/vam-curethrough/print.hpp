// What the subcommands share: the options of a print, and the part in printing order.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/json.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/vdb.hpp"
#include "resin/curethrough.hpp"
#include "resin/part_columns.hpp"
#include "resin/response.hpp"

namespace vam::curethrough {

struct PrintOptions {
  double speed_mm_h = resin::Process{}.speed_mm_h;
  std::optional<double> absorbance_height_um;
  std::optional<double> critical_dose_mj_cm3;
  std::optional<double> min_intensity_mw_cm2;
  std::optional<double> max_intensity_mw_cm2;
  std::string exposure = "continuous";
  std::string response;
  cli::PrinterOptions printer;
};
void add_print(cli::App& app, PrintOptions& options);

/// The printer file with the options on top. An option wins over the file, the file over resin::Process's defaults.
struct Print {
  model::Printer printer;
  resin::Process process;
  resin::Limits limits;
  resin::Response response;
};
[[nodiscard]] Print resolve(const PrintOptions& options, double slice_um);

[[nodiscard]] Json to_json(const resin::Process& process);
/// What later tools need to show the slices in time, as text attributes.
[[nodiscard]] std::map<std::string, std::string> attributes(const resin::Process& process);
[[nodiscard]] double frames_per_s(const resin::Process& process);

struct PartOptions {
  std::string path = "-";
  std::string platform = "bottom";  // which end of z is printed first
  double threshold = 0.5;
};
void add_part(cli::App& app, PartOptions& options);

/// A target volume in printing order: slice 0 is the one at the platform.
class PartSource {
 public:
  explicit PartSource(const PartOptions& options);
  [[nodiscard]] const model::Grid& grid() const { return volume_.grid(); }
  [[nodiscard]] const std::vector<std::string>& history() const { return volume_.history; }
  [[nodiscard]] double slice_um() const { return grid().voxel_mm * 1e3; }
  [[nodiscard]] double threshold() const { return options_.threshold; }
  [[nodiscard]] const std::string& name() const { return name_; }
  void read(int first, int count, float* out) const;
  /// The grid of something that has `slices` slices in printing order, of which the first are this part's.
  [[nodiscard]] model::Grid extended(int slices) const;
  /// Slices in printing order to those of `volume`, a SparseVolume on extended().
  void write(io::SparseVolume& volume, int first, int count, std::vector<float>& slices) const;

 private:
  PartOptions options_;
  std::string name_;
  io::SparseVolume volume_;
};

/// Reads the whole part into bits. Throws Fault::data when it is empty.
[[nodiscard]] resin::PartColumns pack(const PartSource& part, resin::Exposure exposure);

}  // namespace vam::curethrough
