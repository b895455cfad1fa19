// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/printer_match.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/private/printer_fields.hpp"

namespace vam::io {

namespace {

using model::Printer;

/// What is compared, and by how much two values may differ: a calibration of the next day must not refuse a sinogram
/// that prints as well as before.
struct MatchedKey {
  const char* name;
  double (*value)(const Printer&);
  double within;     // in the key's unit
  double share = 0;  // of the larger value
  Matter matter = Matter::light;
};

// Infinitely far where it is telecentric, and then like any other: the keys of telecentricity tell these apart.
double lens_mm(const Printer& p) {
  const auto columns = columns_lens_mm(p.projector);
  return columns ? *columns : rows_lens_mm(p.projector).value_or(std::numeric_limits<double>::infinity());
}

// A quarter of a pixel stays within the box of one; half a per cent of the radius is what a new calibration of the vial
// may differ by [devices §8]; an index that is 0.002 off moves the writable radius, R / n, by 0.13 %.
constexpr MatchedKey keys[] = {
    {"projector.columns", [](const Printer& p) { return 1.0 * p.projector.columns; }, 0},
    {"projector.pixel_mm", [](const Printer& p) { return p.projector.pixel_mm; }, 0, 1e-3},
    {"projector.lens_distance_mm", lens_mm, 0, 5e-3},
    {"projector.telecentric_columns", [](const Printer& p) { return columns_lens_mm(p.projector) ? 0.0 : 1.0; }, 0},
    {"projector.telecentric_rows", [](const Printer& p) { return rows_lens_mm(p.projector) ? 0.0 : 1.0; }, 0},
    {"projector.axis_column", [](const Printer& p) { return p.projector.axis_column; }, 0.25},
    {"projector.half_angle_deg", [](const Printer& p) { return p.projector.half_angle_deg.value_or(0); }, 0.02, 0.05},
    {"projector.focus_mm", [](const Printer& p) { return p.projector.focus_mm.value_or(0); }, 0.2},
    {"vial.radius_mm", [](const Printer& p) { return p.vial.radius_mm; }, 0, 5e-3},
    {"vial.wall_mm", [](const Printer& p) { return p.vial.wall_mm; }, 0.05},
    {"vial.index_glass", [](const Printer& p) { return (p.vial.wall_mm > 0 ? p.vial : model::Vial{}).index_glass; },
     0.01},
    {"bath.index", [](const Printer& p) { return p.bath.index; }, 0.002},
    {"bath.window_mm", [](const Printer& p) { return p.bath.window_mm; }, 0, 0.02},
    {"resin.index", [](const Printer& p) { return p.resin.index; }, 0.002},
    {"resin.absorption_per_mm", [](const Printer& p) { return p.resin.absorption_per_mm; }, 0, 0.05},
    {"stage.direction", [](const Printer& p) { return 1.0 * p.stage.direction; }, 0},
    {"projector.fps",  // of frames that are interpolated
     [](const Printer& p) { return (p.stage.motion == "interpolated" ? p.projector : model::Projector{}).fps; }, 0, 0,
     Matter::any},
    {"stage.speed_deg_s", [](const Printer& p) { return p.stage.speed_deg_s; }, 0, 1e-6, Matter::dose},
    {"projector.max_intensity_mw_cm2", [](const Printer& p) { return p.projector.max_intensity_mw_cm2; }, 0, 1e-6,
     Matter::dose},
};

bool alike(const MatchedKey& key, double a, double b) {
  if (a == b) return true;
  constexpr double rounding = 1 + 1e-9;
  return std::abs(a - b) <= rounding * std::max(key.within, key.share * std::max(std::abs(a), std::abs(b)));
}

/// "a.b=1 c.d=\"two words\"" at its blanks; a text in quotes holds its own.
std::vector<std::string> settings_in(const std::string& text) {
  std::vector<std::string> settings(1);
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == '\0' && c == ' ') {
      settings.emplace_back();
      continue;
    }
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
    settings.back() += c;
    if (quote == '"' && c == '\\' && i + 1 < text.size()) settings.back() += text[++i];
  }
  return settings;
}

bool known(const std::string& setting) {
  const std::string name = setting.substr(0, setting.find('='));
  const auto all = printer_fields();
  return std::any_of(all.begin(), all.end(), [&](const PrinterField& field) { return dotted_name(field) == name; });
}

constexpr const char* motion = "stage.motion";

// Of keys without a rule above: no light or dose depends on them, or what follows from them has one, or the plan of the
// light counts (turns).
constexpr const char* not_compared[] = {"camera.",
                                        "optimize.",
                                        "calibration.",
                                        "projector.throw_ratio",
                                        "stage.device",
                                        "stage.turns",
                                        motion,
                                        "projector.telecentric",
                                        "resin.name",
                                        "resin.initiator_mmol_l",
                                        "resin.extinction_l_mol_cm",
                                        "projector.bits",
                                        "projector.orientation",
                                        "projector.max_led_current_percent",
                                        "projector.relay",
                                        "projector.latency_ms"};

bool is_compared(const std::string& name) {
  return std::ranges::none_of(keys, [&](const MatchedKey& key) { return key.name == name; }) &&
         std::ranges::none_of(not_compared, [&](const char* one) { return name.starts_with(one); });
}

/// To four digits; a file by its whole path.
std::string text_of(const PrinterField& field, Printer& printer) {
  const auto text = [&](const auto* value) -> std::string {
    if constexpr (requires { value->has_value(); }) {
      return *value ? format_number(**value, 4) : "not set";
    } else if constexpr (requires { value->empty(); }) {
      if (!field.words.empty()) return *value;
      return value->empty() ? "not set" : std::filesystem::absolute(*value).lexically_normal().string();
    } else {
      return format_number(*value, 4);
    }
  };
  return std::visit(text, field.slot(printer));
}

}  // namespace

Printer parse_settings(const std::string& text, const std::string& subject, const std::vector<std::string>& sets) {
  std::string toml;
  for (const std::string& setting : settings_in(text)) {
    if (known(setting)) toml += setting + "\n";
  }
  return parse_printer(toml, subject, sets);
}

std::vector<std::string> differences(Printer computed_for, Printer now, Matter up_to) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& name, const std::string& then, const std::string& here) {
    all.push_back(name + " " + then + ", now " + here);
  };
  for (const MatchedKey& key : keys) {
    const double then = key.value(computed_for), here = key.value(now);
    if (key.matter <= up_to && !alike(key, then, here)) add(key.name, format_number(then), format_number(here));
  }
  for (const PrinterField& field : printer_fields()) {
    const std::string name = dotted_name(field), then = text_of(field, computed_for), here = text_of(field, now);
    if (then != here && (name == motion || (up_to == Matter::any && is_compared(name)))) add(name, then, here);
  }
  return all;
}

}  // namespace vam::io
