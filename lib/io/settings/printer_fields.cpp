// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/private/printer_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "model/device_schemes.hpp"

namespace vam::io {

namespace {

using namespace model;

template <auto Section, auto Member>
Slot at(Printer& printer) {
  return &(printer.*Section.*Member);
}

// No lamp and no resin comes near; what is beyond would leave the range of floats in a product.
constexpr double most_mw_cm2 = 1e9;
constexpr double most_mj_cm3 = 1e9;

std::vector<std::string> schemes_of(const auto& table) {
  std::vector<std::string> schemes;
  for (const auto& row : table) schemes.emplace_back(row.scheme);
  return schemes;
}

std::string comment_on(const auto& table) { return model::forms_of(table) + ", a simulated one; empty: none"; }

// clang-format off
const std::vector<PrinterField> fields{
    {"projector", "columns", at<&Printer::projector, &Projector::columns>, "pixels across", 1, 65536},
    {"projector", "rows", at<&Printer::projector, &Projector::rows>, "pixels along the rotation axis", 1, 65536},
    {"projector", "pixel_mm", at<&Printer::projector, &Projector::pixel_mm>, "pixel pitch in the plane of the rotation axis", 0, 100, true},
    {"projector", "throw_ratio", at<&Printer::projector, &Projector::throw_ratio>, "lens distance / image width", 0, 1e6, true},
    {"projector", "lens_distance_mm", at<&Printer::projector, &Projector::lens_distance_mm>, "distance from lens to rotation axis; replaces throw_ratio", 0, 1e9, true},
    {"projector", "telecentric", at<&Printer::projector, &Projector::telecentric>, "parallel chief rays; replaces throw_ratio"},
    {"projector", "telecentric_columns", at<&Printer::projector, &Projector::telecentric_columns>, "parallel chief rays seen along the rotation axis only"},
    {"projector", "telecentric_rows", at<&Printer::projector, &Projector::telecentric_rows>, "horizontal chief rays: parallel seen from the side only"},
    {"projector", "min_intensity_mw_cm2", at<&Printer::projector, &Projector::min_intensity_mw_cm2>, "intensity at grey 0: black level", 0, most_mw_cm2},
    {"projector", "max_intensity_mw_cm2", at<&Printer::projector, &Projector::max_intensity_mw_cm2>, "intensity at full grey", 0, most_mw_cm2, true},
    {"projector", "response", at<&Printer::projector, &Projector::response>, "response table: CSV file \"grey,intensity\", relative to this file; empty: linear"},
    {"projector", "flat", at<&Printer::projector, &Projector::flat>, "flat field (EXR): light of the pixels at one grey level, by which frames are evened to the darkest; relative to this file; empty: even"},
    {"projector", "bits", at<&Printer::projector, &Projector::bits>, "number of grey levels = 2^bits", 1, 16, false, {"1", "2", "4", "8", "10", "16"}},
    {"projector", "fps", at<&Printer::projector, &Projector::fps>, "frames per second", 0.001, 1e6},
    {"projector", "axis_column", at<&Printer::projector, &Projector::axis_column>, "column of the rotation axis, from 0 at the left, before orientation; the middle if absent", -65536, 131072},
    {"projector", "axis_row", at<&Printer::projector, &Projector::axis_row>, "row level with the lens, where z = 0; from 0 at the top, before orientation; the middle if absent", -65536, 131072},
    {"projector", "orientation", at<&Printer::projector, &Projector::orientation>, "orientation of the image: normal, flip-columns, flip-rows or rotate-180", 0, 0, false, {"normal", "flip-columns", "flip-rows", "rotate-180"}},
    {"projector", "half_angle_deg", at<&Printer::projector, &Projector::half_angle_deg>, "half angle of the round cone of light of a pixel, in air: the aperture of the lens; default: 0, chief rays only", 0, 5},
    {"projector", "focus_mm", at<&Printer::projector, &Projector::focus_mm>, "distance of the sharp image behind the rotation axis, without vial and bath; default: 0", -100, 100},
    {"projector", "latency_ms", at<&Printer::projector, &Projector::latency_ms>, "delay from vertical blank to light output", -1000, 1000},
    {"projector", "max_led_current_percent", at<&Printer::projector, &Projector::max_led_current_percent>, "maximum LED current of the light engine, in per cent of its full current", 0, 100},
    {"projector", "relay", at<&Printer::projector, &Projector::relay>, "dead-man relay on the lamp's power: " + comment_on(model::relay_schemes), 0, 0, false, {}, schemes_of(model::relay_schemes)},
    {"vial", "radius_mm", at<&Printer::vial, &Vial::radius_mm>, "outer radius", 0, 1e6, true},
    {"vial", "wall_mm", at<&Printer::vial, &Vial::wall_mm>, "wall thickness; 0: glass and resin are index-matched", 0, 1e6},
    {"vial", "index_glass", at<&Printer::vial, &Vial::index_glass>, "refractive index of the wall", 1, 4},
    {"bath", "index", at<&Printer::bath, &Bath::index>, "refractive index around the vial; 1: air, no bath", 1, 4},
    {"bath", "window_mm", at<&Printer::bath, &Bath::window_mm>, "distance of the flat window before the axis; 0: none", 0, 1e6},
    {"resin", "name", at<&Printer::resin, &Resin::name>, "name, for information only"},
    {"resin", "index", at<&Printer::resin, &Resin::index>, "refractive index at the projector's wavelength", 1, 4},
    {"resin", "absorption_per_mm", at<&Printer::resin, &Resin::absorption_per_mm>, "absorption coefficient, natural logarithm (base e)", 0, 1e6},
    {"resin", "initiator_mmol_l", at<&Printer::resin, &Resin::initiator_mmol_l>, "concentration of the initiator: with extinction_l_mol_cm it states absorption_per_mm", 0, 1e6, true},
    {"resin", "extinction_l_mol_cm", at<&Printer::resin, &Resin::extinction_l_mol_cm>, "molar extinction coefficient of the initiator at the projector's wavelength, base 10", 0, 1e9, true},
    {"resin", "critical_dose_mj_cm3", at<&Printer::resin, &Resin::critical_dose_mj_cm3>, "absorbed dose at the gelation threshold", 0, most_mj_cm3, true},
    {"resin", "psf_mm", at<&Printer::resin, &Resin::psf_mm>, "Gaussian sigma of the beam, across it and along z", 0, 10},
    {"resin", "diffusion_mm2_s", at<&Printer::resin, &Resin::diffusion_mm2_s>, "diffusion coefficient of what absorbed the dose, not of oxygen", 0, 0.1},
    {"resin", "dose_lifetime_s", at<&Printer::resin, &Resin::dose_lifetime_s>, "lifetime of what diffuses; not set: it outlives the print", 0, 1e9, true},
    {"resin", "dark_s", at<&Printer::resin, &Resin::dark_s>, "from the end of the print until the part is rinsed", 0, 1e6},
    {"stage", "device", at<&Printer::stage, &PrinterStage::device>, comment_on(model::stage_schemes), 0, 0, false, {}, schemes_of(model::stage_schemes)},
    {"stage", "speed_deg_s", at<&Printer::stage, &PrinterStage::speed_deg_s>, "rotation speed", 0.001, 1e6},
    {"stage", "turns", at<&Printer::stage, &PrinterStage::turns>, "turns of a print whose light states no plan", 1, 1e6},
    {"stage", "direction", at<&Printer::stage, &PrinterStage::direction>, "direction of rotation, 1: clockwise seen from above, theta increases; -1: the other way", -1, 1, false, {"1", "-1"}},
    {"stage", "motion", at<&Printer::stage, &PrinterStage::motion>, "while a frame is shown: stepped (the stage stands), held (it turns by the angle between frames, as live) or interpolated (it turns, and a video has fps frames a second between those of the stack)", 0, 0, false, {"stepped", "held", "interpolated"}},
    {"camera", "device", at<&Printer::camera, &PrinterCamera::device>, comment_on(model::camera_schemes), 0, 0, false, {}, schemes_of(model::camera_schemes)},
    {"camera", "distance_mm", at<&Printer::camera, &PrinterCamera::distance_mm>, "distance from entrance pupil to rotation axis", 0, 1e9, true},
    {"camera", "telecentric", at<&Printer::camera, &PrinterCamera::telecentric>, "parallel chief rays in both directions; distance_mm is ignored"},
    {"camera", "pixel_mm", at<&Printer::camera, &PrinterCamera::pixel_mm>, "pitch of an unbinned pixel at the rotation axis", 0, 100, true},
    {"camera", "azimuth_deg", at<&Printer::camera, &PrinterCamera::azimuth_deg>, "angle from the projector", -360, 360},
    {"camera", "binning", at<&Printer::camera, &PrinterCamera::binning>, "binning: pixels per axis", 1, 64},
    {"camera", "exposure_us", at<&Printer::camera, &PrinterCamera::exposure_us>, "exposure time", 0, 1e9, true},
    {"camera", "fps", at<&Printer::camera, &PrinterCamera::fps>, "frames per second", 0.001, 1e6},
    {"camera", "gain", at<&Printer::camera, &PrinterCamera::gain>, "gain, in dB or the camera's own steps; default: unchanged", -1e6, 1e6},
    {"camera", "black_level", at<&Printer::camera, &PrinterCamera::black_level>, "black level, in the camera's own unit; default: unchanged", -1e6, 1e6},
    {"camera", "stamp", at<&Printer::camera, &PrinterCamera::stamp>, "moment of an exposure that its time stamp names: auto (that of the camera model), start, middle or end", 0, 0, false, {"auto", "start", "middle", "end"}},
    {"camera", "lag_ms", at<&Printer::camera, &PrinterCamera::lag_ms>, "delay of the time stamps from that moment", -10000, 10000},
    {"camera", "index_resin", at<&Printer::camera, &PrinterCamera::index_resin>, "refractive index of the resin at the camera's wavelength", 1, 4},
    {"camera", "absorption_per_mm", at<&Printer::camera, &PrinterCamera::absorption_per_mm>, "absorption coefficient of the resin at the camera's wavelength, natural logarithm (base e)", 0, 1e3},
    {"camera", "axis_column", at<&Printer::camera, &PrinterCamera::axis_column>, "column of the rotation axis at the middle row of its images; found in the views if absent", -65536, 131072},
    {"camera", "axis_row", at<&Printer::camera, &PrinterCamera::axis_row>, "row level with the lens, where z = 0; the middle row if absent", -65536, 131072},
    {"camera", "tilt_deg", at<&Printer::camera, &PrinterCamera::tilt_deg>, "tilt of the axis in the images, its lower end towards higher columns", -180, 180},
    {"camera", "flat", at<&Printer::camera, &PrinterCamera::flat>, "flat field (EXR), relative to this file; empty: none"},
    {"optimize", "surface", at<&Printer::optimize, &OptimizeSettings::surface>, "dose of the part's surface: threshold, free (unconstrained), or voxels (as part or void by coverage)", 0, 0, false, {"threshold", "free", "voxels"}},
    {"optimize", "surface_margin_mm", at<&Printer::optimize, &OptimizeSettings::surface_margin_mm>, "voxels within this distance of the part's surface are unconstrained", 0, 1e6},
    {"optimize", "void_weight", at<&Printer::optimize, &OptimizeSettings::void_weight>, "relative cost of an error in the void; that in the part is 1", 0, 1e300, true},
    {"optimize", "void_band", at<&Printer::optimize, &OptimizeSettings::void_band>, "grey targets: maximum deviation in the void; default: that of --band", 0, 1e300},
    {"optimize", "softness", at<&Printer::optimize, &OptimizeSettings::softness>, "width of the logistic response, as a dose; default: the method's", 0, 1e300, true},
    {"optimize", "void_dose", at<&Printer::optimize, &OptimizeSettings::void_dose>, "dose-norm: target dose of the void", 0, 1},
    {"optimize", "min_intensity", at<&Printer::optimize, &OptimizeSettings::min_intensity>, "fbp, dose-norm: lower bound on projected intensity"},
    {"optimize", "negative", at<&Printer::optimize, &OptimizeSettings::negative>, "fbp: negative intensities are set to the lower bound (clip), or a slice is raised by its minimum (offset)", 0, 0, false, {"clip", "offset"}},
    {"optimize", "power", at<&Printer::optimize, &OptimizeSettings::power>, "bclp, pm: exponent of the norm", 1, 20},
    {"optimize", "absorption_model", at<&Printer::optimize, &OptimizeSettings::absorption_model>, "absorption by the resin: exact, disc (of parallel beams: by the dose of a uniform disc) or none", 0, 0, false, {"exact", "disc", "none"}},
    {"optimize", "line_integrals", at<&Printer::optimize, &OptimizeSettings::line_integrals>, "sums along parallel beams in clear resin, without --certify: footprints, fourier or auto (the faster)", 0, 0, false, {"footprints", "fourier", "auto"}},
    {"optimize", "blur", at<&Printer::optimize, &OptimizeSettings::blur>, "compensate for point spread and diffusion"},
    {"optimize", "diffusion_time_s", at<&Printer::optimize, &OptimizeSettings::diffusion_time_s>, "diffusion that is compensated, by the time in which the light arrives; default: the duration of stage.turns turns", 0, 1e300},
    {"optimize", "full_scale", at<&Printer::optimize, &OptimizeSettings::full_scale>, "--bits: intensity at full grey; default: the largest of all projections", 0, 1e300, true},
    {"optimize", "dither", at<&Printer::optimize, &OptimizeSettings::dither>, "--bits: carry the rounding error over to neighbouring columns and angles"},
    {"optimize", "yield_printers", at<&Printer::optimize, &OptimizeSettings::yield_printers>, "--robust: number of random printers for the yield", 0, 100000},
    {"calibration", "folder", at<&Printer::calibration, &Calibration::folder>, "folder of the records, relative to this file; empty: none are used"},
    {"calibration", "instrument", at<&Printer::calibration, &Calibration::instrument>, "name of this printer; records of another printer are refused"},
    {"calibration", "vial", at<&Printer::calibration, &Calibration::vial>, "name of the vial in use; edges and axis records of another vial are refused"},
    {"calibration", "valid_hours", at<&Printer::calibration, &Calibration::valid_hours>, "validity period of new records", 0, 1e6, true},
};
// clang-format on

std::string beyond(const PrinterField& field, const std::string& value) {
  return value + " is not between " + plain_number(field.low) + (field.open_low ? " (excluded) and " : " and ") +
         plain_number(field.high);
}

std::string number_objection(const PrinterField& field, double value) {
  if (value >= field.low && value <= field.high && !(field.open_low && value == field.low)) return "";
  return beyond(field, plain_number(value));
}

std::string word_objection(const PrinterField& field, const std::string& word) {
  for (const auto& allowed : field.words) {
    if (word == allowed) return "";
  }
  return excerpt(word) + " is not one of " + join(field.words, ", ");
}

// No device is a value, too: a tool that needs one reports it.
std::string device_objection(const PrinterField& field, const std::string& device) {
  const std::size_t colon = device.find(':');
  if (device.empty()) return "";
  const auto& known = field.schemes;
  if (colon != std::string::npos && std::find(known.begin(), known.end(), device.substr(0, colon)) != known.end()) {
    return "";
  }
  return excerpt(device) + ": unknown device scheme; use one of " + join(known, ":, ") + ":";
}

/// By the initiator, if both are known: ln 10 eps c [physics §4], of l/(mol cm) and mmol/l.
std::optional<double> absorption_of(const Resin& resin) {
  if (!resin.initiator_mmol_l || !resin.extinction_l_mol_cm) return std::nullopt;
  return std::numbers::ln10 * *resin.extinction_l_mol_cm * *resin.initiator_mmol_l * 1e-4;
}

std::string absorption_objection(const Resin& resin) {
  if (resin.initiator_mmol_l.has_value() != resin.extinction_l_mol_cm.has_value())
    return "resin.initiator_mmol_l and resin.extinction_l_mol_cm state the absorption together; set both, or neither";
  constexpr double rounding = 1e-3;
  const auto stated = absorption_of(resin);
  if (!stated || std::abs(*stated - resin.absorption_per_mm) <= rounding * *stated) return "";
  return "resin.absorption_per_mm " + format_number(resin.absorption_per_mm) + " is not the " + format_number(*stated) +
         " of resin.initiator_mmol_l and resin.extinction_l_mol_cm; delete it, or these two";
}

}  // namespace

std::span<const PrinterField> printer_fields() { return fields; }

Printer without_axis() {
  Printer printer;
  printer.projector.axis_column = printer.projector.axis_row = std::numeric_limits<double>::quiet_NaN();
  return printer;
}

void settle(Printer& printer) {
  if (const auto stated = absorption_of(printer.resin); stated && printer.resin.absorption_per_mm == 0)
    printer.resin.absorption_per_mm = *stated;
  Projector& projector = printer.projector;
  if (std::isnan(projector.axis_column)) projector.axis_column = 0.5 * (projector.columns - 1);
  if (std::isnan(projector.axis_row)) projector.axis_row = 0.5 * (projector.rows - 1);
}

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const auto& field : printer_fields()) {
    if (names.empty() || names.back() != field.section) names.emplace_back(field.section);
  }
  return names;
}

std::string dotted_name(const PrinterField& field) { return std::string(field.section) + "." + field.key; }

std::string objection_to_whole(const PrinterField& field, const std::string& digits) {
  return field.words.empty() ? beyond(field, digits) : word_objection(field, digits);
}

std::string objection(const PrinterField& field, const Slot& slot) {
  if (const auto* word = std::get_if<std::string*>(&slot)) {
    if (!field.schemes.empty()) return device_objection(field, **word);
    return field.words.empty() ? "" : word_objection(field, **word);
  }
  if (const auto* whole = std::get_if<int*>(&slot)) {
    return field.words.empty() ? number_objection(field, **whole) : word_objection(field, std::to_string(**whole));
  }
  if (const auto* number = std::get_if<double*>(&slot)) return number_objection(field, **number);
  if (const auto* maybe = std::get_if<std::optional<double>*>(&slot)) {
    return **maybe ? number_objection(field, ***maybe) : "";
  }
  return "";
}

std::string contradiction(const Printer& printer) {
  const auto& [projector, vial, bath, resin, stage, camera, optimize, calibration] = printer;
  if (const std::string why = absorption_objection(resin); !why.empty()) return why;
  if (vial.wall_mm >= vial.radius_mm) {
    return "vial.wall_mm " + mm_text(vial.wall_mm) + " leaves no room in vial.radius_mm " + mm_text(vial.radius_mm);
  }
  if (projector.min_intensity_mw_cm2 >= projector.max_intensity_mw_cm2) {
    return "projector.min_intensity_mw_cm2 " + format_number(projector.min_intensity_mw_cm2) +
           " is not below projector.max_intensity_mw_cm2 " + format_number(projector.max_intensity_mw_cm2);
  }
  if (bath.window_mm > 0 && bath.window_mm < vial.radius_mm) {
    return "bath.window_mm " + mm_text(bath.window_mm) + " cuts into vial.radius_mm " + mm_text(vial.radius_mm);
  }
  const auto lens_mm = columns_lens_mm(projector) ? columns_lens_mm(projector) : rows_lens_mm(projector);
  const double obstacle_mm = std::max(vial.radius_mm, bath.window_mm);
  if (lens_mm && *lens_mm <= obstacle_mm) {
    return "the projector's lens, " + mm_text(*lens_mm) + " from the axis, is not outside " +
           (bath.window_mm > 0 ? "bath.window_mm " : "vial.radius_mm ") + mm_text(obstacle_mm) +
           "; its distance is lens_distance_mm, or throw_ratio x columns x pixel_mm";
  }
  if (!camera.telecentric && camera.distance_mm <= vial.radius_mm) {
    return "camera.distance_mm " + mm_text(camera.distance_mm) + " is not outside vial.radius_mm " +
           mm_text(vial.radius_mm);
  }
  return "";
}

}  // namespace vam::io
