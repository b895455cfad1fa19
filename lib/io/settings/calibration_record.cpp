// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/calibration_record.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/private/printer_fields.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr FormatKind schema = "vam-calibration";
constexpr double clock_slack_s = 60;  // between the machines that measure and print

// Only what every file system and shell takes as it is.
std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool good =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    out += good ? c : '-';
  }
  return out.empty() ? "printer" : out;
}

std::string current_path(const model::Calibration& calibration, const std::string& scan) {
  return (fs::path(calibration.folder) / ("current-" + scan + ".json")).string();
}

void make_current(const model::Calibration& calibration, const std::string& scan, const std::string& path) {
  const std::string link = current_path(calibration, scan);
  const std::string unfinished = link + "." + std::to_string(getpid());
  std::error_code problem;
  fs::remove(unfinished, problem);
  fs::create_symlink(fs::path(path).filename(), unfinished, problem);
  if (!problem) fs::rename(unfinished, link, problem);
  if (problem) throw Error{Fault::no_output, link + ": cannot make the link (" + problem.message() + ")"};
}

std::string hours(double seconds) { return format_number(seconds / 3600, 3) + " h"; }

// A pipe would be waited for.
void require_file(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored) || fs::is_regular_file(path, ignored)) return;
  throw Error{Fault::data, path + ": is no regular file; run vam-calibrate"};
}

// A file that a record names lies beside it, and is what was written then: its hash stands in the record.
std::string beside(const CalibrationRecord& record, const char* file) {
  const std::string name = record.json->at("files").at(file);
  if (name.empty() || name == ".." || name.find('/') != std::string::npos) {
    throw Error{Fault::data, record.path + ": its file " + excerpt(name) + " is not beside it; run vam-calibrate"};
  }
  std::string path = (fs::path(record.path).parent_path() / name).string();
  require_file(path);
  const Json hashes = record.json->value("sha256", Json::object());
  const std::string recorded = hashes.value(name, "");
  if (const std::string read = recorded.empty() ? recorded : sha256_of(path); read != recorded) {
    throw Error{Fault::data, path + ": changed after it was measured (SHA-256 recorded " + recorded.substr(0, 8) +
                                 ", read " + read.substr(0, 8) + "); run vam-calibrate"};
  }
  return path;
}

// No standard deviation is wider than the range of the values themselves, as the printer file has it.
double most_sigma(const std::string& unit) {
  if (unit == "px") return 65536;
  if (unit == "deg") return 360;
  return unit == "ms" ? 1e4 : 1e6;
}

// Scans state their units; a record that was written by hand may have others.
double in_unit(const CalibrationRecord& record, const char* name, const char* unit) {
  const double value = record.value(name);
  const Json& entry = record.json->at("values").at(name);
  const auto refuse = [&](const std::string& why) {
    throw Error{Fault::data, record.path + ": " + name + " " + why + "; run vam-calibrate"};
  };
  if (entry.contains("unit") && entry["unit"] != unit) {
    refuse("is in " + briefly(entry["unit"].dump()) + ", not in " + unit);
  }
  const double sigma = number_at(entry, "sigma");
  if (!(sigma >= 0 && sigma <= most_sigma(unit))) {
    refuse("has a sigma of " + format_number(sigma) + " " + unit + ", not between 0 and " +
           format_number(most_sigma(unit)));
  }
  return value;
}

// A lag counts from the moment that the time stamps named when it was measured.
void take_over_lag(model::Printer& printer, const CalibrationRecord& record) {
  const Json camera = record.json->value("devices", Json::object()).value("camera", Json::object());
  const std::string then = camera.value("stamp", "arrival");
  const std::string now = printer.camera.stamp;
  if (then != "arrival" && now != "auto" && then != now) {
    throw Error{Fault::data, record.path + ": was measured with time stamps at the " + then +
                                 " of the exposure, but camera.stamp is " + now + "; run vam-calibrate lag"};
  }
  printer.camera.lag_ms = in_unit(record, "camera_lag", "ms");
}

/// A scan of vam-calibrate: what its record sets in the printer, and whether that is of one vial only.
struct ScanKind {
  const char* name;
  bool of_vial;
  void (*take_over)(model::Printer& printer, const CalibrationRecord& record);
};

// In the order of precedence.
constexpr ScanKind scans[] = {
    {"edges", true,
     [](model::Printer& printer, const CalibrationRecord& record) {
       printer.projector.axis_column = in_unit(record, "axis_column", "px");
       printer.vial.radius_mm = in_unit(record, "radius", "mm");
     }},
    {"response", false,
     [](model::Printer& printer, const CalibrationRecord& record) {
       printer.projector.response = beside(record, "response");
     }},
    {"flat", false,
     [](model::Printer& printer, const CalibrationRecord& record) { printer.camera.flat = beside(record, "flat"); }},
    {"beam", false,
     [](model::Printer& printer, const CalibrationRecord& record) {
       if (!record.json->at("values").contains("half_angle")) return;
       printer.projector.half_angle_deg = in_unit(record, "half_angle", "deg");
       printer.projector.focus_mm = in_unit(record, "focus_in_air", "mm");
     }},
    {"axis", true,
     [](model::Printer& printer, const CalibrationRecord& record) {
       printer.camera.axis_column = in_unit(record, "axis_column", "px");
       if (record.json->at("values").contains("tilt")) printer.camera.tilt_deg = in_unit(record, "tilt", "deg");
     }},
    {"latency", false,
     [](model::Printer& printer, const CalibrationRecord& record) {
       printer.projector.latency_ms = in_unit(record, "latency", "ms");
     }},
    {"lag", false, take_over_lag},
    {"registration", false, [](model::Printer& printer, const CalibrationRecord& record) {
       printer.camera.azimuth_deg = in_unit(record, "azimuth", "deg");
       printer.camera.axis_row = in_unit(record, "axis_row", "px");
       if (record.json->at("values").contains("pixel")) printer.camera.pixel_mm = in_unit(record, "pixel", "mm");
     }}};

// What a record sets is held to the ranges of the printer file, and the axis to the image.
void require_possible(model::Printer printer, const CalibrationRecord& record) {
  settle(printer);
  const auto refuse = [&](const std::string& why) {
    throw Error{Fault::data, record.path + ": " + why + "; run vam-calibrate"};
  };
  for (const PrinterField& field : printer_fields()) {
    if (const std::string why = objection(field, field.slot(printer)); !why.empty()) {
      refuse(dotted_name(field) + ": " + why);
    }
  }
  constexpr double least_radius_mm = 0.1;
  if (record.json->at("scan") == "edges" && printer.vial.radius_mm < least_radius_mm) {
    refuse("vial.radius_mm: " + format_number(printer.vial.radius_mm) + " is no radius of a vial");
  }
  constexpr double most_tilt_deg = 10;  // beyond, it is no axis that was seen
  const double tilt_deg = printer.camera.tilt_deg.value_or(0);
  if (record.json->at("scan") == "axis" && std::abs(tilt_deg) > most_tilt_deg) {
    refuse("camera.tilt_deg: " + format_number(tilt_deg) + " is beyond " + format_number(most_tilt_deg) +
           " degrees; align the camera");
  }
  if (record.json->at("scan") == "edges" && !printer.projector.shows_axis()) {
    refuse("projector.axis_column: " + format_number(printer.projector.axis_column) + " is not in the image of " +
           std::to_string(printer.projector.columns) + " columns");
  }
}

}  // namespace

const std::vector<std::string>& calibration_scans() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ScanKind& scan : scans) all.emplace_back(scan.name);
    return all;
  }();
  return names;
}

std::string record_path(const model::Calibration& calibration, const std::string& scan, double utc_s,
                        const std::string& ending) {
  if (calibration.folder.empty()) {
    throw Error{Fault::usage, "no calibration.folder in the printer settings; set one"};
  }
  std::error_code problem;
  fs::create_directories(calibration.folder, problem);
  if (problem) {
    throw Error{Fault::no_output, calibration.folder + ": cannot make the folder (" + problem.message() + ")"};
  }
  std::string time;
  for (const char c : utc_text(utc_s)) {
    if (c != '-' && c != ':') time += c;
  }
  return (fs::path(calibration.folder) / ("cal-" + plain(calibration.instrument) + "-" + scan + "-" + time + ending))
      .string();
}

std::string write_record(const model::Calibration& calibration, const std::string& scan, const Json& facts,
                         double utc_s) {
  std::string path = record_path(calibration, scan, utc_s, ".json");
  if (fs::exists(path)) throw Error{Fault::no_output, path + ": exists; records are immutable"};
  Json record{{"schema", schema.schema()},
              {"scan", scan},
              {"utc", utc_text(utc_s)},
              {"valid_until", utc_text(utc_s + 3600 * calibration.valid_hours)},
              {"instrument", calibration.instrument},
              {"vial", calibration.vial}};
  record.update(facts);
  seal_json(record);
  write_text(path, record.dump(2) + "\n");
  if (chmod(path.c_str(), 0444) != 0) throw Error{Fault::no_output, path + ": cannot be made read-only"};
  if (record.value("status", "fail") != "fail") make_current(calibration, scan, path);
  return path;
}

namespace {

double number_of(const CalibrationRecord& record, const std::string& name, const char* key) {
  const Json& values = record.json->at("values");
  const Json entry = values.contains(name) ? values.at(name) : Json();
  if (entry.is_object() && entry.contains(key) && entry.at(key).is_number()) return entry.at(key);
  throw Error{Fault::data,
              record.path + ": incomplete record of " + record.json->value("scan", "") + "; run vam-calibrate"};
}

}  // namespace

double CalibrationRecord::value(const std::string& name) const { return number_of(*this, name, "value"); }
double CalibrationRecord::sigma(const std::string& name) const { return number_of(*this, name, "sigma"); }

CalibrationRecord read_record(const std::string& path) {
  CalibrationRecord record{
      path, std::make_shared<const Json>(parse_distinct(read_all(path, Content::text, most_record_bytes), path))};
  const Json& json = *record.json;
  const auto is_text = [&](const char* key) { return !json.contains(key) || json[key].is_string(); };
  const bool whole =
      is_of(json, schema) && json.contains("scan") && json.contains("values") && json["values"].is_object();
  const auto texts = {"scan", "utc", "valid_until", "instrument", "vial", "status"};
  if (!whole || !std::all_of(texts.begin(), texts.end(), is_text)) {
    throw Error{Fault::data, path + ": is not a " + schema.schema() + " record; run vam-calibrate"};
  }
  require_seal(json, path);
  return record;
}

namespace {

// The settings of a record that is gone must not fall back to those of the file in silence.
void require_reachable(const model::Calibration& calibration, const std::string& scan) {
  const std::string path = current_path(calibration, scan);
  struct stat about = {};
  if (stat(path.c_str(), &about) == 0) return;
  const int problem = errno;
  if ((problem == ENOENT || problem == ENOTDIR) && lstat(path.c_str(), &about) != 0) return;
  throw Error{Fault::no_input, path + ": " +
                                   (problem == ENOENT ? "links to a record that is gone"
                                                      : "cannot open: " + std::generic_category().message(problem)) +
                                   "; restore it, or run vam-calibrate " + scan};
}

}  // namespace

std::optional<CalibrationRecord> current_record(const model::Calibration& calibration, const std::string& scan) {
  const std::string path = current_path(calibration, scan);
  if (calibration.folder.empty()) return std::nullopt;
  require_reachable(calibration, scan);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  require_file(path);
  CalibrationRecord record = read_record(path);
  if (const std::string made = (*record.json)["scan"]; made != scan) {
    throw Error{Fault::data, path + ": is a record of " + made + ", not of " + scan + "; run vam-calibrate"};
  }
  return record;
}

std::string objection(const CalibrationRecord& record, const model::Calibration& calibration, double utc_s) {
  const Json& json = *record.json;
  const std::string instrument = json.value("instrument", "");
  if (instrument != calibration.instrument) {
    return "belongs to instrument " + excerpt(instrument) + ", but calibration.instrument is '" +
           calibration.instrument + "'; run vam-calibrate";
  }
  const std::string name = json.value("scan", "");
  const std::string vial = json.value("vial", "");
  const bool of_vial = std::any_of(std::begin(scans), std::end(scans),
                                   [&](const ScanKind& scan) { return scan.of_vial && name == scan.name; });
  if (of_vial && vial != calibration.vial) {
    return "belongs to vial " + excerpt(vial) + ", but calibration.vial is '" + calibration.vial +
           "'; run vam-calibrate";
  }
  const std::string status = json.value("status", "");
  if (status != "pass" && status != "warn" && status != "fail") {
    return "has the status " + excerpt(status) + ", not pass, warn or fail; run vam-calibrate";
  }
  if (status == "fail") return "is the record of a failed scan; run vam-calibrate";
  const double made_s = parse_utc(json.value("utc", ""), record.path);
  const double end_s = parse_utc(json.value("valid_until", ""), record.path);
  if (utc_s > end_s) {
    return "is " + hours(utc_s - made_s) + " old and was valid for " + hours(end_s - made_s) + "; run vam-calibrate";
  }
  if (utc_s < made_s - clock_slack_s) return "is " + hours(made_s - utc_s) + " ahead of this machine's clock; set it";
  return "";
}

void apply_record(model::Printer& printer, const CalibrationRecord& record) {
  const std::string name = record.json->at("scan");
  const auto* scan =
      std::find_if(std::begin(scans), std::end(scans), [&](const ScanKind& s) { return name == s.name; });
  try {
    if (scan != std::end(scans)) scan->take_over(printer, record);
  } catch (const Json::exception&) {
    throw Error{Fault::data, record.path + ": incomplete record of " + name + "; run vam-calibrate"};
  }
  require_possible(printer, record);
}

namespace {

void require_folder(const model::Calibration& calibration) {
  std::error_code ignored;
  if (calibration.folder.empty() || fs::exists(calibration.folder, ignored)) return;
  throw Error{Fault::no_input, calibration.folder +
                                   ": no such folder of calibration records; make it, run vam-calibrate, or disable "
                                   "records with an empty calibration.folder"};
}

}  // namespace

void apply_records(model::Printer& printer, const model::Calibration& calibration, double utc_s) {
  require_folder(calibration);
  for (const std::string& scan : calibration_scans()) {
    if (calibration.folder.empty()) break;
    const auto record = current_record(calibration, scan);
    if (!record) continue;
    if (const std::string why = objection(*record, calibration, utc_s); !why.empty()) {
      throw Error{Fault::data, record->path + ": " + why + ", or disable records with an empty calibration.folder"};
    }
    apply_record(printer, *record);
  }
}

}  // namespace vam::io
