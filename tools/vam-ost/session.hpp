// One run of vam-ost: the corrections of the views, the rig, and what is written for every volume.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/json.hpp"
#include "cli/app.hpp"
#include "io/image/view_source.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/ost/bodies.hpp"
#include "metrology/ost/cured.hpp"
#include "metrology/ost/ost.hpp"
#include "model/printer.hpp"
#include "vam-ost/options.hpp"

namespace vam::ost_tool {

class Session {
 public:
  /// Reads printer, fields, record and reference: all secondary inputs, before the views.
  Session(const cli::App& app, const Options& options);

  /// A frame as a view: its size checked, corrected, binned.
  metrology::CameraView take(const io::CameraFrame& frame);
  /// Live: a turn may show nothing yet, or have gaps; the next one may be better. The axis is found as soon as
  /// something is visible, and again until it is certain.
  struct Attempt {
    std::optional<model::Volume> volume;
    std::string problem;  // why there is none
  };
  Attempt attempt(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  /// The first call finds the axis and sets up the rig.
  model::Volume reconstruct(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  void write(const model::Volume& volume, const std::string& path, const std::vector<std::string>& history) const;
  /// Throws Fault::data when --mesh is wanted and no voxel reaches the isovalue.
  void require_print(const model::Volume& volume) const;
  /// With an isovalue: drops the bodies that are not the print, for all that follows. Says what was dropped.
  void keep_print(model::Volume& volume);
  /// --mesh and --projections.
  void write_print(const model::Volume& volume) const;
  /// What the last call of keep_print() kept and dropped; null without an isovalue.
  [[nodiscard]] Json bodies() const;
  /// What was taken out of the views of the last volume.
  [[nodiscard]] Json dirt() const { return metrology::to_json(dirt_); }
  [[nodiscard]] Json figures(const model::Volume& volume) const;
  /// Nothing without isovalue and reference.
  [[nodiscard]] std::optional<metrology::Cured> state(const model::Volume& volume) const;

 private:
  void say_dirt() const;
  void place_axis(std::span<const metrology::CameraView> views);
  [[nodiscard]] bool certain() const;
  void refine_axis(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  void set_up(std::span<const metrology::CameraView> views, double stack_pixel_mm);

  const cli::App& app_;
  const Options& options_;
  model::Printer printer_;
  std::optional<double> isovalue_;
  metrology::BodyRules rules_;  // what of a volume is the print
  metrology::CameraFields fields_;
  std::optional<model::Volume> reference_;
  metrology::AxisEstimate axis_;
  metrology::BodyCount bodies_;
  metrology::Dirt dirt_;
  std::unique_ptr<metrology::OstReconstructor> rig_;
  int width_ = 0;
  int height_ = 0;
};

/// Reconstructs a sliding turn as frames come.
void live(const cli::App& app, const Options& options);

[[nodiscard]] model::Volume dense(const io::SparseVolume& sparse);

}  // namespace vam::ost_tool
