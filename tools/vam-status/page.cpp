// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-status/page.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/image_file.hpp"
#include "plot/image_figure.hpp"
#include "plot/page.hpp"

namespace vam::status_tool {

namespace {

namespace fs = std::filesystem;

// Mean of blocks, so that no more than `most` columns are left.
Image reduced(const GreyImage& image, int most) {
  const int by = (image.width + most - 1) / most;
  Image small(image.width / by, image.height / by);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      double sum = 0;
      for (int j = 0; j < by; ++j) {
        for (int i = 0; i < by; ++i) sum += image(x * by + i, y * by + j);
      }
      small(x, y) = static_cast<float>(sum / by / by / image.full());
    }
  }
  return small;
}

std::string camera_figure(const RunFolder& run) {
  const auto newest = newest_image(run);
  if (!newest) {
    return plot::page_figure("Camera", "<p class=\"none\">no image</p>",
                             "vam-print --view-step DEG captures images during a print.");
  }
  (void)has_regular_file(newest->path);  // what is no file is an error, a pipe would be waited for
  const GreyImage levels = io::read_image(newest->path);
  const model::PrinterCamera& camera = run.printer().camera;
  const double pixel_mm = camera.pixel_mm * camera.binning;
  const double axis = camera.axis_column.value_or(0.5 * (levels.width - 1));
  const double level = camera.axis_row.value_or(0.5 * (levels.height - 1));
  plot::ImageFigure view;
  view.panels.push_back({reduced(levels, 480), "", {}});
  view.x = {"across the vial, from the axis (mm)", (-0.5 - axis) * pixel_mm, (levels.width - 0.5 - axis) * pixel_mm};
  view.y = {"z (mm)", (level - levels.height + 0.5) * pixel_mm, (level + 0.5) * pixel_mm};
  view.scale.map = plot::ColourMap::grey;
  const Image& shown = view.panels.front().values;
  view.scale.high = std::max(0.02F, *std::max_element(shown.values.begin(), shown.values.end()));
  view.scale.label = "fraction of full scale";
  view.size = 480;
  const std::string when =
      newest->angle_deg ? ", at stage angle " + fixed_number(std::fmod(*newest->angle_deg, 360), 1) + " deg" : "";
  return plot::page_figure("Camera", plot::page_image(plot::draw(view).image(), "camera image"),
                           "Newest image" + when + ".");
}

std::string screen_figure(const RunFolder& run, const LightView& light, double angle_deg, bool lit) {
  plot::ImageFigure view;
  Image image = light.projection(angle_deg);
  if (!lit) std::fill(image.values.begin(), image.values.end(), 0.0F);
  view.panels.push_back({std::move(image), "", {}});
  view.x = {"x (mm), seen from the projector", -run.printer().vial.radius_mm, run.printer().vial.radius_mm};
  view.y = {"z (mm)", light.low_mm(), light.high_mm()};
  view.scale.map = plot::ColourMap::grey;
  view.scale.label = "fraction";
  view.size = 480;
  const double peak = run.printer().projector.max_intensity_mw_cm2;
  return plot::page_figure("Projected image", plot::page_image(plot::draw(view).image(), "image of the projector"),
                           lit ? "At stage angle " + fixed_number(std::fmod(angle_deg, 360), 1) +
                                     " deg; 1 is the maximum intensity of the print, " + format_number(peak, 3) +
                                     " mW/cm2."
                               : "Dark: no light is projected now.");
}

std::string time_text(const std::string& utc) {
  std::tm moment{};
  if (strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%S", &moment) == nullptr) return "age unknown";
  const double age_h = (static_cast<double>(std::time(nullptr)) - static_cast<double>(timegm(&moment))) / 3600;
  return age_h < 48 ? fixed_number(age_h, 1) + " h old" : fixed_number(age_h / 24, 1) + " days old";
}

std::string records_table(const PrintProgress& progress) {
  if (progress.records.empty())
    return "<p class=\"none\">none in force: the settings are those of the printer file.</p>";
  std::string rows = "<table><tr><th>record</th><th>age</th><th>valid until</th><th>status</th></tr>\n";
  for (const RecordAge& record : progress.records) {
    rows += "<tr><td>" + page_text(record.scan) + "</td><td>" + time_text(record.utc) + "</td><td>" +
            page_text(record.valid_until) + "</td><td>" + page_text(record.status) + "</td></tr>\n";
  }
  return rows + "</table>";
}

std::string figures_table(const RunFolder& run) {
  const PrintProgress& p = run.progress();
  const auto row = [](const std::string& name, const std::string& value) {
    return "<tr><th>" + name + "</th><td>" + page_text(value) + "</td></tr>\n";
  };
  std::string rows = "<table>" + row("turn", turn_text(p));
  rows += row("stage angle", angle_text(p));
  rows += row("dose delivered", given_text(p) + " of this print");
  rows += row("missed vertical blanks", std::to_string(p.missed) + " of " + std::to_string(p.blanks));
  rows += p.missing_percent ? row("cured / missing", fixed_number(100 - *p.missing_percent, 1) + " % / " +
                                                         fixed_number(*p.missing_percent, 1) + " % of the part")
                            : row("cured / missing", "not measured (vam-print --until)");
  if (const std::string light = correction_text(run); !light.empty()) rows += row("new light", light);
  if (!p.simulated.empty()) rows += row("simulated", join(p.simulated, ", "));
  return rows + "</table>\n";
}

constexpr const char* style = "#old{background:#b00;color:#fff;padding:.4em .8em;display:none}";

// Without a renewal the page would look alive for ever.
constexpr const char* script =
    "setInterval(function(){var b=document.body;if(b.dataset.live&&Date.now()/1000-b.dataset.written>15)"
    "document.getElementById('old').style.display='block'},1000)";

}  // namespace

std::optional<CameraImage> newest_image(const RunFolder& run) {
  const std::string views = run.file("views");
  if (io::is_capture_folder(views)) {
    const io::CaptureManifest manifest = io::read_manifest(views);
    if (!manifest.frames.empty()) {
      const io::CaptureRecord& last = manifest.frames.rbegin()->second;
      return CameraImage{(fs::path(views) / io::capture_file_name(last.place)).string(), last.angle_deg};
    }
  }
  if (has_regular_file(run.file("camera.png"))) return CameraImage{run.file("camera.png"), {}};
  return std::nullopt;
}

std::string page(const std::string& name, const RunFolder& run, const LightView* light, double period_s) {
  const PrintProgress& progress = run.progress();
  const bool live = !progress.outcome && !progress.abandoned;
  const bool lit = live && progress.blanks > 0 && progress.angle_deg >= progress.from_deg &&
                   progress.angle_deg < 360 * progress.turns;
  const std::time_t now = std::time(nullptr);
  char utc[32];
  std::strftime(utc, sizeof utc, "%Y-%m-%d %H:%M:%S UTC", std::gmtime(&now));
  plot::Page made;
  made.title = state_of(progress) + " - " + name;
  if (live) {
    made.head = "<meta http-equiv=\"refresh\" content=\"" + format_number(std::max(1.0, period_s), 3) + "\">\n";
  }
  made.body_attributes = "data-written=\"" + std::to_string(now) + "\"" + (live ? " data-live=\"1\"" : "");
  made.style = style;
  made.script = script;
  std::string& body = made.body;
  body = "<p id=\"old\">This page is no longer updated: the print, or vam-status, has ended.</p>\n";
  body += "<h1>" + page_text(name) + ": " + page_text(state_of(progress)) + "</h1>\n<p>as of " + utc + "</p>\n";
  body += figures_table(run) + "<div class=\"images\">\n<div>" + camera_figure(run);
  if (light != nullptr) body += screen_figure(run, *light, progress.angle_deg, lit);
  body += sensitivity_figure(run);
  body += "</div>\n" + (light != nullptr ? overhead_figure(run, *light, lit) : "");
  body += "</div>\n<h2>Calibration records</h2>\n" + records_table(progress);
  return plot::html(made);
}

}  // namespace vam::status_tool
