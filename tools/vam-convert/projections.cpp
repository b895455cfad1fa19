// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "light/grids/lit_grid.hpp"
#include "model/dose/dose_metrics.hpp"
#include "optics/writable_radius.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "session/volumes.hpp"
#include "vam-convert/conversions.hpp"
#include "vam-convert/resliced.hpp"
#include "vam-convert/slices.hpp"
#include "vam-convert/turns.hpp"

namespace vam::convert_tool {

namespace {

/// Heights of slices along z.
struct Heights {
  int count = 0;
  double z0_mm = 0;
  double pitch_mm = 0;
};

Heights heights_of(const model::Grid& grid) { return {grid.nz, grid.z_mm(0), grid.voxel_mm}; }

/// Where the columns of a slice go.
struct Place {
  double shift = 0;  // to the right
  int columns = 0;
};

/// Turns as frames state them, or as the projections make where they are no turn to be repeated; 0: not known. Throws
/// Fault::data where frames are not all that they state, as of a video that was cut, unless an option says that they
/// are.
session::Exposure stated_exposure(const Options& options, const io::ImageSource& source, const model::Printer& printer,
                                  const Turns& turns) {
  const std::string name = io::input_name(options.input);
  const model::StackInfo& stated = source.info();
  session::Exposure shown = session::exposure_of(name, stated, printer, 0);
  if (!shown.planned || options.view_step_deg || options.speed_deg_s) {
    shown.turns = shown.planned || options.speed_deg_s || turns.count() != 1 ? turns.count() : 0;
    return shown;
  }
  const double per_turn = stated.count / turns.count(), frames = shown.turns * per_turn;
  if (std::abs(frames - stated.count) <= 0.5) return shown;
  throw Error{Fault::data, name + ": has " + std::to_string(stated.count) + " of the " + format_number(frames) +
                               " frames of its light (vam:shown_turns " + format_number(shown.turns) +
                               "); write all of them again, or give --view-step " + format_number(360.0 / per_turn) +
                               " to take those that are there"};
}

/// What projections make together, and how exact the speed of the stage must be: the last one moves by half a column at
/// the edge of the light. Frames of which nothing states the step may be those of several turns, as videos often are.
void tell_turns(const Options& options, const Slices& slices, const std::vector<double>& edges_deg, const Turns& turns,
                double axis) {
  const std::string name = io::input_name(options.input) + ": ";
  const int count = slices.size().rows;
  if (options.from != "none") {
    note(name + "as of " + options.from + ": the first projection at " +
         format_number(0.5 * (edges_deg[0] + edges_deg[1]), 4) + " degrees, the last at " +
         format_number(0.5 * (edges_deg[count - 1] + edges_deg[count]), 4) + ", the axis in column " +
         format_number(axis));
  }
  if (!options.in_vial() && options.view_step_deg && turns.count() > 1) {
    warn(name + std::to_string(count) + " projections make " + format_number(turns.count(), 4) +
         " turns, and a sinogram of parallel light is one: of those at the same angle the mean counts; check "
         "--view-step");
  }
  if (are_angles_stated(options, slices.source())) {
    const double reach = std::max({axis - slices.lit().first, slices.lit().second - axis, 0.5});
    return note(name + std::to_string(count) + " projections in " + format_number(turns.count()) +
                (turns.count() == 1 ? " turn" : " turns") + " from " + format_number(turns.start_deg()) + " deg, " +
                format_number(count / turns.count()) + " a turn; a speed that is off by " +
                format_number(100 * 0.5 / (turn_rad * turns.count() * reach), 2) +
                " % moves the last one by half a column at the edge of the light");
  }
  if (!slices.are_frames()) return;
  const bool video = !slices.source().times_s().empty();
  (video ? warn : note)(name + std::to_string(count) + " frames are taken as one turn, " +
                        format_number(360.0 / count, 4) + " degrees each; give --view-step" +
                        (video ? " or --speed" : "") + " otherwise");
}

double axis_column(const Options& options, const model::Projector& projector, int columns) {
  const double middle = 0.5 * (columns - 1);
  if (std::abs(options.axis_column.value_or(middle) - middle) > columns) {
    throw Error{Fault::data, io::input_name(options.input) + ": --axis-column " + format_number(*options.axis_column) +
                                 " is beside its " + std::to_string(columns) + " columns by more than half of them; " +
                                 "give one of " + format_number(middle - columns) + " to " +
                                 format_number(middle + columns)};
  }
  if (options.axis_column) return *options.axis_column;
  const bool own = options.in_vial() && options.from == "none" && columns == projector.columns;
  return own ? projector.axis_column : axis_of(columns, convention_of(options.from).columns_at_half);
}

/// Slices are counted upwards, rows of images downwards.
double slice_of_zero(const Options& options, const model::Projector& projector, int slices, bool from_top) {
  const bool own = from_top && options.in_vial() && slices == projector.rows;
  if (!options.axis_row && !own) return 0.5 * (slices - 1);
  const double row = options.axis_row.value_or(projector.axis_row);
  return from_top ? slices - 1 - row : row;
}

Place place_columns(const Options& options, const model::Projector& projector, int columns) {
  const double axis = axis_column(options, projector, columns);
  if (options.in_vial()) return {projector.axis_column - axis, projector.columns};
  const int all = ceil_int(2 * std::max(axis, columns - 1 - axis) + 1 - 1e-6);
  return {0.5 * (all - 1) - axis, all};
}

double pixel_mm(const Options& options, const model::Projector& projector) {
  const double pitch = options.pixel_mm.value_or(projector.pixel_mm);
  if (options.in_vial() && std::abs(pitch / projector.pixel_mm - 1) > 1e-6) {
    throw Error{Fault::usage, "--pixel: " + format_number(pitch) + " mm, but projector.pixel_mm is " +
                                  format_number(projector.pixel_mm) +
                                  "; give --set projector.pixel_mm=" + format_number(pitch) + " here and to vam-dose"};
  }
  return pitch;
}

/// Linear between columns.
Image shifted(const Image& turn, const Place& place, const std::string& name) {
  if (place.shift == 0 && place.columns == turn.width) return turn;
  const int whole = floor_int(place.shift);
  const auto part = static_cast<float>(place.shift - whole);
  Image placed(place.columns, turn.height);
  for (int a = 0; a < turn.height; ++a) {
    for (int c = 0; c < turn.width; ++c) {
      const float value = turn(c, a);
      if (value == 0) continue;
      for (const int right : {0, 1}) {
        const float weight = right == 1 ? part : 1 - part;
        const int to = c + whole + right;
        if (weight == 0) continue;
        if (to < 0 || to >= place.columns) {
          throw Error{Fault::data, name + ": has light on column " + std::to_string(c) + ", which is column " +
                                       std::to_string(to) + " of " + std::to_string(place.columns) +
                                       " of the projector; check --axis-column and --set projector.columns"};
        }
        placed(to, a) += weight * value;
      }
    }
  }
  return placed;
}

model::StackInfo info_of(const cli::App& app, const Options& options, const model::Printer& printer,
                         const io::ImageSource& source, const Turns& turns, int columns, const Heights& heights) {
  model::StackInfo info;
  info.extra = source.info().extra;
  const bool projector = options.in_vial(), levels = source.is_grey() && options.units == "relative";
  info.space = projector ? model::Space::projector : model::Space::virtual_;
  info.width = columns;
  info.height = turns.rows();
  info.count = heights.count;
  info.pixel_mm = pixel_mm(options, printer.projector);
  info.row_mm = heights.pitch_mm;
  info.z_start_mm = heights.z0_mm;
  info.angle_start_deg = turns.start_deg();
  info.angle_step_deg = 360.0 / turns.rows();
  info.units = levels ? "fraction of full intensity" : options.units;
  info.history = {app.history()};
  session::Exposure shown = stated_exposure(options, source, printer, turns);
  if (levels) shown.full_scale = 1;
  if (shown.turns > 0 || shown.full_scale > 0) session::state_exposure(info.extra, shown.turns, shown.full_scale);
  if (projector) info.extra["vam:printer"] = io::printer_settings(printer);
  return info;
}

Heights own_heights(const Options& options, const model::Projector& projector, int slices, bool from_top) {
  const double pitch_mm = options.slice_height_mm.value_or(pixel_mm(options, projector));
  return {slices, -slice_of_zero(options, projector, slices, from_top) * pitch_mm, pitch_mm};
}

/// The grid of the part, or the only one.
std::optional<io::SparseVolume> volume_like(const Options& options) {
  if (options.like.empty()) return std::nullopt;
  std::vector<io::SparseVolume> volumes = session::read_like(options.like);
  return session::taken(volumes, session::target_or_first(volumes));
}

/// Its slices, and those above and below that the projector's climbing rays light as well.
Heights lit_slices(const io::SparseVolume& like, const Options& options, const model::Printer& printer) {
  if (!options.in_vial()) return heights_of(like.grid());
  const double radius_mm = optics::judged_radius_mm(printer, io::farthest_mm(like, model::coverage_rounding));
  light::Margin margin = light::lit_margin(printer, like.grid(), radius_mm);
  margin.side = 0;
  return heights_of(light::extended(like.grid(), margin));
}

void warn_of_dark(const Options& options, const Heights& own, const model::Grid& grid) {
  const double low_mm = own.z0_mm - 0.5 * own.pitch_mm;
  const double high_mm = low_mm + own.count * own.pitch_mm;
  const double bottom_mm = grid.z_mm(-0.5);
  const double top_mm = grid.z_mm(grid.nz - 0.5);
  const double spare_mm = own.pitch_mm + grid.voxel_mm;
  if (low_mm < bottom_mm + spare_mm && high_mm > top_mm - spare_mm) return;
  const auto mm = [](double from, double to) { return format_number(from, 3) + " to " + format_number(to, 3) + " mm"; };
  warn(io::input_name(options.input) + ": its slices are at z = " + mm(low_mm, high_mm) + ", those of " + options.like +
       " at " + mm(bottom_mm, top_mm) + ", and the rest is dark; check --slice-height and --axis-row");
}

/// Filtered projections have negative values, images that a projector shows have none.
void warn_of_negative(const Options& options, float least) {
  if (least >= 0) return;
  warn(io::input_name(options.input) + ": has values down to " + format_number(least) +
       ", and no projector shows intensities below 0; they are kept");
}

/// Are they frames of a projector that lies on its side?
bool is_exchanged(const io::ArraySize& size, const model::Projector& projector) {
  return size.columns == projector.rows && size.images == projector.columns && size.columns != size.images;
}

/// The order of the axes in which an array that was read as zax is as wide and high as the projector's image; empty
/// where there is none, or this one is.
std::string fitting_axes(const io::ArraySize& size, const model::Projector& projector) {
  const std::array<int, 3> sizes{size.images, size.rows, size.columns};
  const auto fits = [&](const std::string& order) {
    return sizes[order.find('z')] == projector.rows && sizes[order.find('x')] == projector.columns;
  };
  if (fits("zax")) return "";
  for (const char* order : {"azx", "xaz", "zxa", "axz", "xza"}) {
    if (fits(order)) return order;
  }
  return "";
}

/// The remedy for light above or below all slices.
std::string place_remedy(const Options& options, const Slices& slices, const model::Projector& projector, bool frames) {
  if (frames) {
    return is_exchanged(slices.size(), projector) ? "columns and rows look exchanged" : "check --axis-row";
  }
  const std::string axes = !options.axes.empty() ? "" : fitting_axes(slices.size(), projector);
  if (axes.empty()) return "check --axis-row";
  return "check --axes, as its sizes fit the projector in the order " + axes + ", and --axis-row";
}

/// remedy: what is to be checked.
void warn_of_light(const Options& options, double left_out, const std::string& remedy) {
  if (left_out < 1e-3) return;
  warn(io::input_name(options.input) + ": " + format_number(100 * left_out, 3) + " % of the light is above or below " +
       options.like + " and is left out; " + remedy);
}

/// Warns of frames that the projector would have shown in another size.
void warn_of_size(const Options& options, const io::ArraySize& size, const model::Projector& projector) {
  if (!options.in_vial() || (size.columns == projector.columns && size.images == projector.rows)) return;
  warn(io::input_name(options.input) + ": images of " + std::to_string(size.columns) + " x " +
       std::to_string(size.images) + " pixels, but the projector has " + std::to_string(projector.columns) + " x " +
       std::to_string(projector.rows) +
       (!is_exchanged(size, projector) ? "; they are taken for a part of its image, pixel by pixel"
        : options.orientation == "normal"
            ? "; columns and rows look exchanged: give --orientation rotate-90 or rotate-270"
            : "; columns and rows look exchanged: check --orientation"));
}

/// Warns of frames in one colour, whose full intensity is the luma of that colour, within a level of limited range.
void warn_of_colour(const Options& options, double peak) {
  constexpr double level = 1.0 / 219;
  for (const auto& [colour, luma] : {std::pair{"blue", 0.114}, {"red", 0.299}, {"green", 0.587}}) {
    if (std::abs(peak - luma) > level) continue;
    warn(io::input_name(options.input) + ": its brightest pixel is " + format_number(100 * peak, 3) +
         " % of full scale, as of images in " + colour + " alone; if that is full intensity, give --full-scale " +
         format_number(luma));
  }
}

}  // namespace

void make_projections(const cli::App& app, Options options, std::optional<io::FileType> type) {
  const Convention& program = convention_of(options.from);
  if (program.speed_in_name && !options.view_step_deg && !options.speed_deg_s && type == io::FileType::video)
    options.speed_deg_s = named_speed_deg_s(options.input);
  Slices slices(options, type, "zax");
  const io::ImageSource& source = slices.source();
  const model::Metadata& stated = source.info().extra;
  const std::string name = io::input_name(options.input);
  model::Printer printer = session::printer_of(options.printer, stated, name);
  printer.stage.speed_deg_s = std::abs(options.speed_deg_s.value_or(printer.stage.speed_deg_s));
  if (!app.given("--orientation") && stated.contains("vam:printer"))
    options.orientation = printer.projector.orientation;
  else if (!app.given("--orientation"))
    options.orientation = program.frames;
  const bool frames = slices.are_frames();
  if (frames) slices.collect(options, printer);
  const io::ArraySize size = slices.size();
  const std::vector<double> edges_deg = stage_edges_deg(options, source, size.rows);
  const Turns turns(edges_deg, options.speed_deg_s.has_value(), name);
  if (turns.blurred()) printer.stage.motion = "stepped";  // the width of held frames is in the rows
  tell_turns(options, slices, edges_deg, turns, axis_column(options, printer.projector, size.columns));
  const Place place = place_columns(options, printer.projector, size.columns);
  const Heights own = own_heights(options, printer.projector, size.images, frames);
  Heights heights = own;
  if (const std::optional<io::SparseVolume> like = volume_like(options)) {
    heights = lit_slices(*like, options, printer);
    warn_of_dark(options, own, like->grid());
  }
  Resliced resliced(slices, heights.count, (heights.z0_mm - own.z0_mm) / own.pitch_mm, heights.pitch_mm / own.pitch_mm,
                    true);
  io::StackWriter out(options.output, info_of(app, options, printer, source, turns, place.columns, heights),
                      options.stack);
  Image slice;
  float least = 0;
  Progress progress("converting", heights.count);
  while (resliced.next(slice)) {
    least = std::min(least, *std::min_element(slice.values.begin(), slice.values.end()));
    out.write(shifted(turns.fold(slice), place, name));
    progress.tick();
  }
  warn_of_negative(options, least);
  warn_of_light(options, resliced.left_out(), place_remedy(options, slices, printer.projector, frames));
  if (source.is_grey() && !options.full_scale) warn_of_colour(options, slices.peak());
  if (frames) warn_of_size(options, size, printer.projector);
  out.commit();
}

}  // namespace vam::convert_tool
