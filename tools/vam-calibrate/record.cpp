// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/sha256.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

namespace fs = std::filesystem;

// A file as sha256sum prints it; of a folder the hash of what "sha256sum *" prints there.
std::string hash_of(const std::string& path) {
  if (!fs::is_directory(path)) return io::sha256_of(path);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Sha256 hash;
  for (const auto& file : files) {
    const std::string line = io::sha256_of(file) + "  " + file.filename().string() + "\n";
    hash.add(line.data(), line.size());
  }
  return hash.digest();
}

Json hashes(const ScanOptions& options) {
  Json json = Json::object();
  for (const auto& path :
       {options.from, options.reverse, options.angles, options.flips, options.dark, options.design}) {
    if (!path.empty() && path != "-") json[fs::path(path).filename().string()] = hash_of(path);
  }
  return json;
}

// {"camera": {"serial": ...}, "stage": {...}}: the output of the tools' identify.
Json read_devices(const std::string& path) {
  Json devices = parse_json(io::read_all(path));
  if (!devices.is_object()) throw Error{Fault::data, path + ": not a JSON object of devices"};
  for (const auto& [name, device] : devices.items()) {
    if (!device.is_object()) throw Error{Fault::data, path + ": '" + name + "' is not a JSON object"};
    if (!device.contains(name)) continue;
    Json own = device[name];  // beside it vam-capture reports its settings, of which the levels belong to the record
    for (const char* level : {"gain", "gamma", "black_level", "automatic_off"}) {
      if (own.is_object() && device.contains(level)) own[level] = device[level];
    }
    device = own;
  }
  return devices;
}

// Whether the frames, or a device, were simulated: as frames and identities say.
bool is_simulated(const std::string& frames, const Json& facts) {
  for (const auto& device : facts.value("devices", Json::object())) {
    if (device.contains("simulated")) return true;
  }
  if (io::is_capture_folder(frames)) {
    const Json head = Json::parse(io::read_manifest(frames).head);
    return head.value("camera", Json::object()).contains("simulated");
  }
  const auto type = io::known_file_type(frames);
  if (!type) return false;  // the mesh of a registration
  const bool volume = *type == io::FileType::volume;
  const auto history = volume ? io::read_volume(frames, "").history : io::ViewSource(frames, 1).history();
  return std::find(history.begin(), history.end(), "frames of a simulated camera") != history.end();
}

// Why a record was not made with these devices; empty when nothing speaks against it.
std::string stranger(const Json& record, const Json& devices) {
  const Json known = record.value("devices", Json::object());
  for (const auto& [name, device] : devices.items()) {
    const std::string now = text_at(device, "serial");
    const std::string then = known.contains(name) ? text_at(known[name], "serial", now) : now;
    if (then != now)
      return "was measured with the " + name + " " + then + ", but the one in use is " + now + "; run vam-calibrate";
  }
  return "";
}

// Why its values cannot be taken over; empty when they can, and are.
std::string refusal(model::Printer& printer, const io::CalibrationRecord& record) {
  try {
    io::apply_record(printer, record);
    return "";
  } catch (const Error& error) {
    const std::string why = error.what();
    return why.starts_with(record.path + ": ") ? why.substr(record.path.size() + 2) : why;
  }
}

// The files that belong to the record, each beside it.
void write_products(const Finding& finding, const std::string& record, Json& facts) {
  for (const auto& product : finding.products) {
    const std::string path = fs::path(record).replace_extension(product.ending).string();
    const std::string name = fs::path(path).filename().string();
    product.write(path);
    facts["files"][product.name] = name;
    facts["sha256"][name] = io::sha256_of(path);
  }
}

/// The file that a link in force names; of a folder that was copied with the links followed, the file itself.
std::string record_file(const std::string& current) {
  if (!fs::is_symlink(current)) return current;
  return (fs::path(current).parent_path() / fs::read_symlink(current)).string();
}

}  // namespace

Json measured_json(const stats::Measured& measured, const std::string& unit, const std::string& method) {
  return {{"value", measured.value}, {"unit", unit}, {"sigma", measured.sigma}, {"n", measured.n}, {"method", method}};
}

void Finding::value(const std::string& name, const stats::Measured& measured, const std::string& unit,
                    const std::string& method) {
  if (measured.n == 0) return;
  values_[name] = measured_json(measured, unit, method);
}

void Finding::require_sigma(const std::string& of, double sigma, double most, const std::string& unit,
                            const std::string& remedy) {
  if (sigma <= most) return;
  fail_because("the standard deviation of the " + of + " is " + format_number(sigma, 3) + " " + unit + ", above " +
               format_number(most) + (remedy.empty() ? "" : "; " + remedy));
}

void Finding::warn_because(const std::string& reason) { warnings_.push_back(reason); }
void Finding::fail_because(const std::string& reason) { failures_.push_back(reason); }

void keep(const cli::App& app, const ScanOptions& options, const model::Printer& printer, Finding finding) {
  const std::string& scan = options.command;
  Json facts{{"scan", scan}, {"tool", app.history()}, {"values", finding.values_}};
  facts.update(finding.facts);
  if (!options.devices.empty()) facts["devices"] = read_devices(options.devices);
  if (is_simulated(options.from, facts)) facts["simulated"] = true;
  facts["sha256"] = hashes(options);
  const double now_s = utc_seconds();
  const bool kept = !printer.calibration.folder.empty();
  if (kept) {
    const std::string path = io::record_path(printer.calibration, scan, now_s, ".json");
    write_products(finding, path, facts);
    model::Printer with = printer;
    const std::string why = refusal(with, {path, std::make_shared<const Json>(facts)});
    if (finding.failures_.empty() && !why.empty()) finding.fail_because(why.substr(0, why.rfind("; ")));
  }
  std::vector<std::string> reasons = finding.failures_;
  reasons.insert(reasons.end(), finding.warnings_.begin(), finding.warnings_.end());
  facts["reasons"] = reasons;
  facts["status"] = !finding.failures_.empty() ? "fail" : reasons.empty() ? "pass" : "warn";
  if (kept) {
    io::write_record(printer.calibration, scan, facts, now_s);
  } else {
    io::write_text("-", facts.dump(2) + "\n");
  }
  if (!finding.failures_.empty()) {
    throw Error{Fault::judged, scan + ": " + join(finding.failures_, "; ") + "; not put in force"};
  }
  for (const auto& reason : finding.warnings_) warn(scan + ": " + reason);
}

void check_records(const ScanOptions& options) {
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  const model::Calibration calibration = printer.calibration;
  if (calibration.folder.empty())
    throw Error{Fault::usage,
                "no calibration.folder in the printer settings; name one, e.g. --set calibration.folder=DIR"};
  const auto& scans = io::calibration_scans();
  std::vector<std::string> needed;
  for (const auto& list : options.needed) {
    for (auto& scan : split(list, ',')) needed.push_back(trimmed(scan));
  }
  for (const auto& name : needed) {
    if (std::find(scans.begin(), scans.end(), name) == scans.end()) {
      throw Error{Fault::usage, "--need " + name + ": expected one of " + join(scans, ", ")};
    }
  }
  if (needed.empty() && !fs::is_directory(calibration.folder)) {
    throw Error{Fault::no_input, calibration.folder + ": no such folder of calibration records (calibration.folder)"};
  }
  const Json devices = options.devices.empty() ? Json::object() : read_devices(options.devices);
  Json report = Json::object();
  std::string first;
  for (const auto& scan : scans) {
    const bool required = std::find(needed.begin(), needed.end(), scan) != needed.end();
    const auto record = io::current_record(calibration, scan);
    std::string why;
    if (record) {
      why = io::objection(*record, calibration, utc_seconds());
      if (why.empty()) why = stranger(*record->json, devices);
      if (why.empty()) why = refusal(printer, *record);
      const std::string path = record_file(record->path);
      report[scan] = {{"record", path},
                      {"sha256", io::sha256_of(path)},
                      {"utc", record->json->value("utc", "")},
                      {"valid_until", record->json->value("valid_until", "")},
                      {"status", record->json->value("status", "")},
                      {"usable", why.empty()}};
      if (!why.empty()) why = record->path + ": " + why;
    } else if (required) {
      why = calibration.folder + ": has no record of " + scan + "; run vam-calibrate";
    }
    if (first.empty() && !why.empty()) first = why;
  }
  io::write_text("-", report.dump(2) + "\n");
  if (!first.empty()) throw Error{Fault::data, first};
}

}  // namespace vam::calibrate_tool
