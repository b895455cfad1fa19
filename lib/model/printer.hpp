// SPDX-License-Identifier: GPL-3.0-or-later
// The instrument: plain structs, units in the names, defaults in place.
// The defaults are the printer of [RAY21].
#pragma once

#include <optional>
#include <string>

namespace vam::model {

struct Projector {
  int columns = 1024;
  int rows = 768;
  double pixel_mm = 0.065;                 // pitch in the plane of the rotation axis
  double throw_ratio = 1.8;                // lens distance / image width; ignored when one of the next two is given
  std::optional<double> lens_distance_mm;  // lens to rotation axis
  bool telecentric = false;                // in both directions
  bool telecentric_columns = false;        // chief rays are parallel seen along the rotation axis
  bool telecentric_rows = false;           // chief rays stay level
  double min_intensity_mw_cm2 = 0;         // at grey 0: 0 or the contrast limit
  double max_intensity_mw_cm2 = 3.8;       // at full grey
  std::string response;                    // CSV "grey,intensity"; empty = linear
  std::string flat;                        // flat field (EXR), by which frames are evened; empty = even
  int bits = 8;
  double fps = 16;
  double axis_column = 511.5;            // where the rotation axis appears
  double axis_row = 383.5;               // the row of z = 0 of a centred part
  std::string orientation = "normal";    // normal, flip-columns, flip-rows, rotate-180
  std::optional<double> half_angle_deg;  // of the light of a pixel in the image, in air: the lens's aperture; absent: 0
  std::optional<double> focus_mm;        // of the image in air, behind the axis; absent: 0
  double latency_ms = 0;                 // from a vertical blank to the light
  double max_led_current_percent = 40;   // of the light engine; more is refused
  std::string relay;                     // dead-man relay on the lamp's power; empty: none

  /// The rotation axis is in the image, whose first pixel is around 0.
  [[nodiscard]] bool shows_axis() const { return axis_column >= -0.5 && axis_column <= columns - 0.5; }
};

struct Vial {
  double radius_mm = 12.7;  // outer
  double wall_mm = 0;       // 0: glass and resin matched, one shell
  double index_glass = 1.53;
};

struct Bath {
  double index = 1.0;    // 1 = no bath, the vial stands in air
  double window_mm = 0;  // flat window, distance before the axis
};

struct Resin {
  std::string name;
  double index = 1.53;
  // natural logarithm of intensity lost per mm; 0 absorbs nothing and leaves doses relative
  double absorption_per_mm = 0;
  std::optional<double> initiator_mmol_l;     // its concentration; with the next, absorption_per_mm follows from it
  std::optional<double> extinction_l_mol_cm;  // of the initiator, base 10
  std::optional<double> critical_dose_mj_cm3;
  double psf_mm = 0;  // Gaussian sigma of the beam, across it and along z
  double diffusion_mm2_s = 0;
  std::optional<double> dose_lifetime_s;  // of what diffuses; empty: it outlives the print
  double dark_s = 0;                      // from the end of the print until the part is rinsed
};

struct PrinterStage {
  std::string device;  // empty: none is named
  double speed_deg_s = 10;
  int turns = 1;
  int direction = 1;            // +1: the vial turns clockwise seen from above and theta increases; -1: the other way
  std::string motion = "held";  // during a frame: stepped, the stage stands; held, or interpolated, it turns
};

struct PrinterCamera {
  std::string device;        // empty: none is named
  double distance_mm = 200;  // entrance pupil to rotation axis
  bool telecentric = false;  // its chief rays are parallel; the distance is without effect
  double pixel_mm = 0.039;   // at the axis
  double azimuth_deg = 90;
  int binning = 1;
  double exposure_us = 20000;
  double fps = 10;
  std::optional<double> gain;         // as the camera counts it; absent: as it has it
  std::optional<double> black_level;  // the same
  std::string stamp = "auto";         // the moment of an exposure that a time stamp names: start, middle or end
  double lag_ms = 0;                  // from that moment to the time stamp
  double index_resin = 1.53;          // at the camera's wavelength
  double absorption_per_mm = 0;       // of the resin there, natural logarithm of intensity lost per mm
  std::optional<double> axis_column;  // where the rotation axis appears at the middle row; found in the views if absent
  std::optional<double> axis_row;     // level with the lens, z = 0; the middle row if absent
  std::optional<double> tilt_deg;     // of the axis in the image, its lower end towards higher columns
  std::string flat;                   // flat field (EXR); empty = none
};

/// Where this instrument's calibration records are, and which of them may be used.
struct Calibration {
  std::string folder;       // empty: none are used
  std::string instrument;   // a name of this printer
  std::string vial;         // the vial in it, e.g. its number
  double valid_hours = 24;  // of new records
};

/// How vam-optimize computes projections, for experts.
struct OptimizeSettings {
  std::string surface = "threshold";          // dose of the part's surface: threshold, free, or voxels: as part or void
  double surface_margin_mm = 0;               // voxels so near to the surface are unconstrained
  double void_weight = 1;                     // cost of an error in the void; that in the part is 1
  std::optional<double> void_band;            // of grey targets; that of --band if absent
  std::optional<double> softness;             // width of the logistic response, as a dose; the method's if absent
  double void_dose = 0.5;                     // dose-norm: target dose of the void
  double min_intensity = 0;                   // fbp, dose-norm: lower bound on projected intensity
  std::string negative = "clip";              // fbp: clip or offset
  double power = 2;                           // bclp, pm: exponent of the norm
  std::string absorption_model = "exact";     // exact, disc or none
  std::string line_integrals = "footprints";  // footprints, fourier or auto
  bool blur = true;                           // point spread and diffusion are compensated
  std::optional<double> diffusion_time_s;     // in which the light arrives; that of stage.turns turns if absent
  std::optional<double> full_scale;           // intensity at full grey; the largest of all projections if absent
  bool dither = false;                        // rounding errors go to neighbouring columns and angles
  int yield_printers = 200;                   // random printers of the yield of --robust
};

struct Printer {
  Projector projector;
  Vial vial;
  Bath bath;
  Resin resin;
  PrinterStage stage;
  PrinterCamera camera;
  OptimizeSettings optimize;
  Calibration calibration;
};

/// Distance from lens to rotation axis, as set or by the throw ratio.
[[nodiscard]] double lens_distance_mm(const Projector& projector);
/// Distance from lens to rotation axis in mm as the columns and as the rows see it, empty when telecentric in them.
[[nodiscard]] std::optional<double> columns_lens_mm(const Projector& projector);
[[nodiscard]] std::optional<double> rows_lens_mm(const Projector& projector);

/// Duration of so many turns.
[[nodiscard]] inline double seconds_of(const PrinterStage& stage, double turns) {
  return turns * 360 / stage.speed_deg_s;
}

/// Inner radius of the vial.
[[nodiscard]] double resin_radius_mm(const Vial& vial);

/// The bench at half of the resolution: column c covers columns 2 c and 2 c + 1, row r rows 2 r and 2 r + 1; the lens
/// stays where it is.
[[nodiscard]] Printer coarser(const Printer& printer);

}  // namespace vam::model
