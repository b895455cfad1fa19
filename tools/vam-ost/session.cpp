// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-ost/session.hpp"

#include <algorithm>
#include <utility>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/settings/printer_file.hpp"
#include "optics/chief_ray.hpp"
#include "session/printer.hpp"

namespace vam::ost_tool {

namespace {

// Users and records count pixels before binning; b binned ones begin where the first of b begins.
double binned(double px, int binning) { return (px + 0.5) / binning - 0.5; }
double captured(double px, int binning) { return (px + 0.5) * binning - 0.5; }

}  // namespace

Session::Session(const cli::App& app, const Options& options)
    : app_(app), options_(options), printer_(session::load_printer(options.printer)) {
  if (!options.dark.empty()) fields_.dark = io::read_field(options.dark);
  if (!options.flat.empty()) {
    fields_.flat = io::read_field(options.flat);
    if (!fields_.dark.values.empty() && fields_.dark.size() == fields_.flat.size()) {
      for (std::size_t i = 0; i < fields_.flat.size(); ++i) fields_.flat.values[i] -= fields_.dark.values[i];
    }
  }
  if (options.flat.empty() && !printer_.camera.flat.empty()) fields_.flat = io::read_field(printer_.camera.flat);
  (void)optics::camera_view(printer_);  // an impossible bench is no matter of the views
}

void Session::Readings::add(const metrology::Exposure& exposure) {
  zeros += exposure.least == 0 ? exposure.pixels_at_least : 0;
  all += exposure.pixels;
  most = std::max(most, exposure.most);
}

// Noise that is cut off below 0 leaves a background where nothing is, and none within the print. Without noise there
// are readings of 0, too, but no background.
bool Session::Readings::cut_noise(const metrology::CleaningReport& dirt) const {
  constexpr double many = 0.1;
  constexpr double seen = 0.002;  // of the brightest reading: less moves surfaces by less than 0.02 pixels
  return zeros > many * all && dirt.has_background && dirt.background > seen * static_cast<double>(most);
}

metrology::CameraView Session::take(io::CameraFrame frame, const metrology::Exposure& exposure) {
  readings_.add(exposure);
  metrology::CameraView view{metrology::corrected(std::move(frame.image), fields_, options_.binning, frame.name),
                             frame.angle_deg, frame.time_s};
  if (width_ == 0) {
    width_ = view.image.width;
    height_ = view.image.height;
  }
  if (view.image.width != width_ || view.image.height != height_) {
    throw Error{Fault::data, frame.name + ": " + std::to_string(view.image.width) + " x " +
                                 std::to_string(view.image.height) + " pixels after binning, but the first frame has " +
                                 std::to_string(width_) + " x " + std::to_string(height_)};
  }
  return view;
}

Session::Attempt Session::attempt(std::span<const metrology::CameraView> views, double stack_pixel_mm) {
  try {
    refine_axis(views, stack_pixel_mm);
    return {reconstruct(views, stack_pixel_mm), {}};
  } catch (const Error& error) {
    if (error.fault != Fault::data) throw;
    return {std::nullopt, error.what()};
  }
}

// A later turn shows the axis better; where it does not, what was found before is kept.
void Session::refine_axis(std::span<const metrology::CameraView> views, double stack_pixel_mm) {
  if (!rig_ || certain()) return;
  try {
    set_up(views, stack_pixel_mm);
  } catch (const Error& error) {
    if (error.fault != Fault::data) throw;
  }
}

// The bars of the axis: a tenth of a pixel and a twentieth of a degree.
bool Session::certain() const { return axis_.column_sigma < 0.1 && axis_.tilt_sigma_rad < 0.05 * rad_per_deg; }

model::Volume Session::reconstruct(std::span<const metrology::CameraView> views, double stack_pixel_mm) {
  if (!rig_) set_up(views, stack_pixel_mm);
  model::Volume volume = rig_->reconstruct(views, &dirt_);
  say_dirt();
  return volume;
}

metrology::VoxelUncertainty Session::uncertainty(std::span<const metrology::CameraView> views) const {
  return rig_->uncertainty(views);
}

io::SparseVolume Session::sparse(const std::string& name, const model::Volume& volume, const Origin& origin) const {
  io::SparseVolume made(name, volume.grid);
  made.history = origin.history;
  made.metadata = origin.facts;
  made.history.push_back(app_.history());
  made.metadata["vam:printer"] = io::printer_settings(printer_);
  made.units = "view units per mm";
  made.show(volume.values.data());
  return made;
}

void Session::write(const model::Volume& volume, const std::string& path, const Origin& origin) const {
  io::SparseVolume made = sparse("scatter", volume, origin);
  io::write_volume(path, made);
}

void Session::write(const metrology::VoxelUncertainty& voxels, const std::string& path, const Origin& origin) const {
  io::SparseVolume made = sparse("uncertainty", voxels.sigma, origin);
  made.metadata["vam:correlation_xy"] = format_number(voxels.correlation_xy, 4);
  made.metadata["vam:correlation_z"] = format_number(voxels.correlation_z, 4);
  io::write_volume(path, made);
}

void Session::say_dirt() const {
  std::string words;
  const auto add = [&](double percent, const char* what) {
    if (percent > 0) words += (words.empty() ? "" : ", ") + format_number(percent, 2) + " % through " + what;
  };
  add(dirt_.speck_percent, "specks");
  if (!dirt_.bubbles_exceed_limit) add(dirt_.bubble_percent, "bubbles");
  if (dirt_.flicker_percent >= metrology::removed_flicker_percent) {
    note("views divided by their relative intensities, which vary by " + format_number(dirt_.flicker_percent, 2) +
         " % (RMS)");
  }
  constexpr double many_percent = 5;  // of rays through bubbles; so many are rather something systematic
  const bool systematic = !dirt_.bubbles_exceed_limit && dirt_.bubble_percent > many_percent;
  if (!words.empty()) {
    note("rays replaced by their reverse, half a turn later: " + words +
         (systematic ? "; without bubbles, the resin absorbs at this wavelength (camera.absorption_per_mm)" : ""));
  }
  if (readings_.cut_noise(dirt_)) {
    const std::string line =
        format_number(100 * readings_.zeros / readings_.all, 3) +
        " % of the camera's readings are 0, with a background of " + format_number(dirt_.background, 2) +
        " beside them: its noise is cut off, which makes prints smaller, by more than their uncertainty; raise its "
        "black level";
    options_.live ? note(line) : warn(line);
  }
  if (dirt_.bubbles_exceed_limit) {
    note("views are inconsistent in " + format_number(dirt_.bubble_percent, 2) +
         " % of the rays: the print changes or wobbles, the axis is wrong, or the resin absorbs at this wavelength "
         "(camera.absorption_per_mm)");
  }
}

Json Session::figures(const model::Volume& volume) const {
  const auto& a = axis_;
  Json json{{"axis_column_px", captured(a.pose.column, options_.binning)},
            {"axis_column_sigma_px", a.column_sigma * options_.binning},
            {"axis_tilt_deg", a.pose.tilt_rad * deg_per_rad},
            {"axis_tilt_sigma_deg", a.tilt_sigma_rad * deg_per_rad},
            {"voxel_mm", volume.grid.voxel_mm},
            {"size_voxels", {volume.grid.nx, volume.grid.ny, volume.grid.nz}}};
  json["dirt"] = dirt();
  json["run_out"] = run_out();
  json["apparent_absorption_per_mm"] = run_out_.absorption_per_mm;
  json["apparent_absorption_sigma_per_mm"] = run_out_.absorption_sigma_per_mm;
  return json;
}

// What the options say, else the calibrated axis, else what the views show.
metrology::AxisEstimate Session::axis_of(std::span<const metrology::CameraView> views) const {
  metrology::AxisEstimate axis = axis_;
  const std::optional<double> column = options_.axis_column ? options_.axis_column : printer_.camera.axis_column;
  const std::optional<double> tilt_deg = options_.tilt_deg ? options_.tilt_deg : printer_.camera.tilt_deg;
  if (!column || !tilt_deg) {
    const auto found = metrology::find_axis(views);
    if (!rig_ || found.column_sigma < axis.column_sigma) axis = found;  // else what is known is better
  }
  if (column) axis.pose.column = binned(*column, options_.binning);
  if (tilt_deg) axis.pose.tilt_rad = *tilt_deg * rad_per_deg;
  return axis;
}

// Axis, run-out and reconstruction belong together: all are replaced, or none where the turn is incomplete.
void Session::set_up(std::span<const metrology::CameraView> views, double stack_pixel_mm) {
  metrology::AxisEstimate axis = axis_of(views);
  metrology::RunOut run_out;
  const double pixel_mm = options_.pixel_mm.value_or(stack_pixel_mm > 0 ? stack_pixel_mm : printer_.camera.pixel_mm);
  metrology::OstOptions how = options_.how;
  how.growing = options_.live;
  how.refraction = !options_.no_refraction;
  if (printer_.camera.axis_row) how.axis_row = binned(*printer_.camera.axis_row, options_.binning);
  how.non_negative = options_.negative == "clip";
  const auto stand = [&] {
    return std::make_unique<metrology::OstReconstructor>(printer_, pixel_mm * options_.binning, width_, height_,
                                                         axis.pose, how);
  };
  auto rig = stand();
  if (!options_.keep_run_out) {
    run_out = rig->find_run_out(views);
    if (run_out.seen()) {
      how.run_out_mm = run_out.mm;
      if (!axis_is_given()) axis.pose.column = run_out.column;
      if (!axis_is_given()) axis.column_sigma = run_out.column_sigma;
      rig = stand();
    }
  }
  rig_ = std::move(rig);
  axis_ = axis;
  run_out_ = run_out;
  say_axis();
}

void Session::say_axis() const {
  note("axis at column " + format_number(captured(axis_.pose.column, options_.binning), 6) + " +- " +
       format_number(axis_.column_sigma * options_.binning, 2) + " px, tilt " +
       format_number(axis_.pose.tilt_rad * deg_per_rad, 3) + " +- " +
       format_number(axis_.tilt_sigma_rad * deg_per_rad, 2) + " deg");
  if (run_out_.seen()) {
    note("run-out of the vial " + format_number(run_out_.size_mm(), 3) + " +- " + format_number(run_out_.sigma_mm, 2) +
         " mm, removed");
  } else if (!run_out_.determined && !options_.keep_run_out && !options_.no_refraction && !run_out_.absorbs()) {
    const std::string line =
        "the run-out of the vial is not determined by these views and none is removed; clean window and resin, or give "
        "--keep-run-out where there is none";
    options_.live ? note(line) : warn(line);
  }
  if (run_out_.absorbs()) {
    warn("the views look as if the resin absorbs the scattered light by " +
         format_number(run_out_.absorption_per_mm, 2) + " +- " + format_number(run_out_.absorption_sigma_per_mm, 1) +
         " per mm; measure it at the wavelength of the camera and set camera.absorption_per_mm");
  }
}

bool Session::axis_is_given() const { return options_.axis_column || printer_.camera.axis_column; }

}  // namespace vam::ost_tool
