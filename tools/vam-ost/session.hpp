// SPDX-License-Identifier: GPL-3.0-or-later
// One run of vam-ost, from views to volumes: their corrections, the axis, the rig.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/text/json.hpp"
#include "cli/app.hpp"
#include "io/image/view_source.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/ost/ost.hpp"
#include "model/printer.hpp"
#include "vam-ost/options.hpp"

namespace vam::ost_tool {

class Session {
 public:
  /// Reads the printer and the fields, before the views.
  Session(const cli::App& app, const Options& options);

  /// A frame as a view: its size checked, corrected, binned.
  metrology::CameraView take(io::CameraFrame frame, const metrology::Exposure& exposure);
  /// All views of the source but those without contrast, saturated ones and those whose light failed, each with a
  /// warning: the angles of the others are known. Throws Fault::data with the first reason where that is more than a
  /// tenth of them.
  [[nodiscard]] std::vector<metrology::CameraView> usable_views(io::ViewSource& source, const std::string& subject);
  /// Live: a turn may show nothing yet, or have gaps; the next one may be better. The axis is found as soon as
  /// something is visible, and again until it is certain.
  struct Attempt {
    std::optional<model::Volume> volume;
    std::string problem;  // why there is none
  };
  Attempt attempt(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  /// Standard deviations of its voxels.
  [[nodiscard]] metrology::VoxelUncertainty uncertainty(std::span<const metrology::CameraView> views) const;
  /// What a written volume tells of its views.
  struct Origin {
    std::vector<std::string> history;
    std::map<std::string, std::string> facts = {};
  };
  void write(const model::Volume& volume, const std::string& path, const Origin& origin) const;
  void write(const metrology::VoxelUncertainty& voxels, const std::string& path, const Origin& origin) const;
  /// Disturbances that were removed from the views of the last volume.
  [[nodiscard]] Json dirt() const { return metrology::to_json(dirt_); }
  [[nodiscard]] Json run_out() const { return metrology::to_json(run_out_); }
  /// Figures of axis, volume and views, for a report.
  [[nodiscard]] Json figures(const model::Volume& volume) const;
  [[nodiscard]] const model::Printer& printer() const { return printer_; }

 private:
  [[nodiscard]] io::SparseVolume sparse(const std::string& name, const model::Volume& volume,
                                        const Origin& origin) const;
  /// Of the camera, as they came.
  struct Readings {
    double zeros = 0;
    double all = 0;
    float most = 0;
    void add(const metrology::Exposure& exposure);
    [[nodiscard]] bool cut_noise(const metrology::CleaningReport& dirt) const;
  };
  void say_dirt() const;
  void say_axis() const;
  [[nodiscard]] metrology::AxisEstimate axis_of(std::span<const metrology::CameraView> views) const;
  [[nodiscard]] bool certain() const;
  [[nodiscard]] bool axis_is_given() const;
  void refine_axis(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  /// The first call finds the axis and sets up the rig.
  model::Volume reconstruct(std::span<const metrology::CameraView> views, double stack_pixel_mm);
  void set_up(std::span<const metrology::CameraView> views, double stack_pixel_mm);

  const cli::App& app_;
  const Options& options_;
  model::Printer printer_;
  metrology::CameraFields fields_;
  metrology::AxisEstimate axis_;
  metrology::RunOut run_out_;
  metrology::CleaningReport dirt_;
  Readings readings_;
  std::unique_ptr<metrology::OstReconstructor> rig_;
  int width_ = 0;
  int height_ = 0;
};

/// Reconstructs a sliding turn as frames come.
void live(const cli::App& app, const Options& options);

}  // namespace vam::ost_tool
