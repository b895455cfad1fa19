// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/resample_stack.hpp"

#include <ostream>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optics/writable_radius.hpp"

namespace vam::optics {

namespace {

ResampleOptions placed(ResampleOptions options, const model::Printer& printer, const AxisAlignment& alignment) {
  options.direction = alignment.reverse ? -printer.stage.direction : printer.stage.direction;
  options.angle_offset_rad = alignment.angle_offset_rad;
  return options;
}

void check_pitch(const model::StackInfo& in) {
  if (!(in.pixel_mm > 0)) {
    throw Error{Fault::data, "sinogram: its column pitch is " + format_number(in.pixel_mm) + " mm (vam:pixel_mm)"};
  }
}

}  // namespace

Detector projector_detector(const model::Printer& printer, const AxisAlignment& alignment) {
  return {printer.projector.columns, printer.projector.pixel_mm,
          printer.projector.axis_column + alignment.column_offset};
}

Detector camera_detector(const model::Printer& printer, const AxisAlignment& alignment) {
  const View view = camera_view(printer);
  const int side = ceil_int(edge_column(view).x_p_mm / printer.camera.pixel_mm);
  Detector camera = centred_detector(2 * side + 1, printer.camera.pixel_mm);
  camera.axis_column += alignment.column_offset;
  return camera;
}

Turn turn_of(const model::StackInfo& info) {
  return {info.height, info.angle_start_deg * rad_per_deg, info.angle_step_deg * rad_per_deg};
}

StackResampling stack_to_projector(const model::Printer& printer, const AxisAlignment& alignment,
                                   const model::StackInfo& in, ResampleOptions options) {
  check_pitch(in);
  const Detector projector = projector_detector(printer, alignment);
  StackResampling result;
  result.plan = plan_to_projector(projector_view(printer), centred_detector(in.width, in.pixel_mm), projector,
                                  turn_of(in), placed(options, printer, alignment));
  result.info = in;
  result.info.space = model::Space::projector;
  result.info.width = projector.columns;
  result.info.pixel_mm = projector.pixel_mm;
  return result;
}

StackResampling stack_to_virtual(const model::Printer& printer, const AxisAlignment& alignment,
                                 const model::StackInfo& in, ResampleOptions options, std::optional<double> pixel_mm,
                                 std::optional<int> columns) {
  check_pitch(in);
  const View view = camera_view(printer);
  Detector camera = centred_detector(in.width, in.pixel_mm);
  camera.axis_column += alignment.column_offset;
  options = placed(options, printer, alignment);
  options.angle_offset_rad += printer.camera.azimuth_deg * rad_per_deg;
  const double pitch_mm = pixel_mm.value_or(in.row_mm > 0 ? in.row_mm : in.pixel_mm);
  const int width = columns.value_or(ceil_int(2 * reach_mm(view) / pitch_mm));
  StackResampling result;
  result.plan = plan_to_virtual(view, camera, centred_detector(width, pitch_mm), turn_of(in), options);
  result.info = in;
  result.info.space = model::Space::virtual_;
  result.info.width = width;
  result.info.pixel_mm = pitch_mm;
  result.info.angle_start_deg = result.plan.rows_out.start_rad * deg_per_rad;
  result.info.angle_step_deg = result.plan.rows_out.step_rad * deg_per_rad;
  return result;
}

void write_map(std::ostream& out, const View& view, const Detector& detector, const ResampleOptions& options) {
  out << "x_p_mm,x_v_mm,delta_deg,T,J,weight\n";
  for (int c = 0; c < detector.columns; ++c) {
    const MapPoint point = map_point(view, detector.x_mm(c), options);
    out << format_number(point.x_p_mm, 10);
    if (point.ray.hits) {
      for (const double value : {point.ray.x_v_mm, point.ray.delta_rad * deg_per_rad, point.ray.transmittance,
                                 point.ray.jacobian, point.weight}) {
        out << ',' << format_number(value, 10);
      }
      out << '\n';
    } else {
      out << ",,,,,\n";
    }
  }
}

}  // namespace vam::optics
