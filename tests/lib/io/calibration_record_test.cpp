// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/calibration_record.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "base/text/json.hpp"
#include "base/text/utc.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

constexpr double now_s = 1795280280.25;  // 2026-11-21T16:58:00.250Z

Json edges(double column, double radius_mm) {
  return {{"status", "pass"},
          {"values", {{"axis_column", {{"value", column}, {"sigma", 0.01}}}, {"radius", {{"value", radius_mm}}}}}};
}

model::Calibration here(const scratch::Folder& folder) { return {folder / "records", "printer 1", "vial 7", 24}; }

}  // namespace

TEST_CASE("a record is immutable, and current is a link to the latest that did not fail") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  CHECK_FALSE(current_record(calibration, "edges"));
  const std::string first = write_record(calibration, "edges", edges(500, 12), now_s);
  CHECK(std::filesystem::path(first).filename() == "cal-printer-1-edges-20261121T165800.250Z.json");
  struct stat about {};
  REQUIRE(stat(first.c_str(), &about) == 0);
  CHECK((about.st_mode & 0777U) == 0444);
  CHECK(fault_of([&] { write_record(calibration, "edges", edges(1, 1), now_s); }) == Fault::no_output);
  write_record(calibration, "edges", edges(501, 12), now_s + 60);
  CHECK(current_record(calibration, "edges")->value("axis_column") == 501);
  Json failed = edges(900, 12);
  failed["status"] = "fail";
  write_record(calibration, "edges", failed, now_s + 120);
  CHECK(current_record(calibration, "edges")->value("axis_column") == 501);
  CHECK(current_record(calibration, "edges")->sigma("axis_column") == 0.01);
  int records = 0;
  for (const auto& entry : std::filesystem::directory_iterator(calibration.folder)) records += !entry.is_symlink();
  CHECK(records == 3);
}

TEST_CASE("the lag of a record counts") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  write_record(calibration, "lag", {{"status", "pass"}, {"values", {{"camera_lag", {{"value", 3.5}}}}}}, now_s);
  model::Printer printer;
  apply_records(printer, calibration, now_s);
  CHECK(printer.camera.lag_ms == 3.5);
  CHECK(printer.projector.latency_ms == 0);
}

TEST_CASE("a lag counts from the moment that the time stamps named then, and from no other") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  const Json of_start{{"camera", {{"serial", "1"}, {"stamp", "start"}}}};
  write_record(calibration, "lag",
               {{"status", "pass"}, {"devices", of_start}, {"values", {{"camera_lag", {{"value", 3.5}}}}}}, now_s);
  for (const char* stamp : {"auto", "start", "end"}) {
    model::Printer printer;
    printer.camera.stamp = stamp;
    const std::string refusal = message_of([&] { apply_records(printer, calibration, now_s); });
    CHECK(has(refusal, "at the start of the exposure, but camera.stamp is end; run") == (std::string(stamp) == "end"));
    CHECK((printer.camera.lag_ms == 3.5) == refusal.empty());
  }
}

TEST_CASE("stale, foreign, future and damaged records are refused with one clear line") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  write_record(calibration, "edges", edges(500, 12), now_s);
  const auto refusal = [&](const model::Calibration& mine, double when_s) {
    model::Printer printer;
    return message_of([&] { apply_records(printer, mine, when_s); });
  };
  CHECK(refusal(calibration, now_s + 23.9 * 3600).empty());
  CHECK(has(refusal(calibration, now_s + 31 * 3600), "current-edges.json: is 31 h old and was valid for 24 h; run"));
  CHECK(has(refusal(calibration, now_s - 3600), "is 1 h ahead of this machine's clock"));
  auto other = calibration;
  other.instrument = "printer 2";
  CHECK(has(refusal(other, now_s), "belongs to instrument 'printer 1', but calibration.instrument is 'printer 2'"));
  other = calibration;
  other.vial = "vial 8";
  CHECK(has(refusal(other, now_s), "belongs to vial 'vial 7', but calibration.vial is 'vial 8'"));
  write_record(other, "latency", {{"status", "pass"}, {"values", {{"latency", {{"value", 8}}}}}}, now_s);
  other.vial = "vial 7";
  CHECK(refusal(other, now_s).empty());  // a latency is of no vial
  std::ofstream(folder / "records/current-beam.json") << "{}";
  CHECK(has(refusal(calibration, now_s), "current-beam.json: is not a vam-calibration/1 record"));
  std::ofstream(folder / "records/current-beam.json") << "not JSON";
  CHECK(has(refusal(calibration, now_s), "current-beam.json: is no"));
  std::filesystem::remove(folder / "records/current-beam.json");
  write_record(calibration, "axis", {{"status", "pass"}, {"values", Json::object()}}, now_s);
  CHECK(has(refusal(calibration, now_s), "incomplete record of axis"));
  auto none = calibration;
  none.folder.clear();
  CHECK(refusal(none, now_s).empty());
  CHECK(fault_of([&] { (void)write_record(none, "edges", edges(1, 1), now_s); }) == Fault::usage);
}

TEST_CASE("a value that a record does not have, or that is no number, is an error of the record") {
  const scratch::Folder folder;
  const Json values{{"latency", {{"value", 8}}}, {"lag", 3}, {"axis_column", {{"value", "500"}, {"sigma", 0.5}}}};
  const CalibrationRecord record =
      read_record(write_record(here(folder), "latency", {{"status", "pass"}, {"values", values}}, now_s));
  CHECK(record.value("latency") == 8);
  CHECK(record.sigma("axis_column") == 0.5);
  for (const char* name : {"radius", "lag", "axis_column"}) {
    CHECK(has(error_of([&] { (void)record.value(name); }, Fault::data), "incomplete record of latency"));
  }
  CHECK(fault_of([&] { (void)record.sigma("latency"); }) == Fault::data);
}

TEST_CASE("a record with an impossible value is refused, with the record, the number and its range") {
  const auto refused = [](double column, double radius_mm, const std::string& scan = "edges") {
    const scratch::Folder folder;
    const auto calibration = here(folder);
    write_record(calibration, scan, edges(column, radius_mm), utc_seconds());
    model::Printer printer;
    return message_of([&] { apply_records(printer, calibration, utc_seconds()); });
  };
  CHECK(refused(511, 12.7).empty());
  CHECK(
      has(refused(1e9, 12.7), "projector.axis_column: 1000000000 is not between -65536 and 131072; run vam-calibrate"));
  CHECK(has(refused(-40, 12.7), "projector.axis_column: -40 is not in the image of 1024 columns"));
  CHECK(has(refused(1024, 12.7), "not in the image"));
  const auto tilted = [](double tilt_deg) {
    const scratch::Folder folder;
    const Json values{{"axis_column", {{"value", 300}, {"unit", "px"}}},
                      {"tilt", {{"value", tilt_deg}, {"unit", "deg"}}}};
    write_record(here(folder), "axis", {{"status", "pass"}, {"values", values}}, utc_seconds());
    model::Printer printer;
    return message_of([&] { apply_records(printer, here(folder), utc_seconds()); });
  };
  CHECK(tilted(-9).empty());
  CHECK(has(tilted(80), "camera.tilt_deg: 80 is beyond 10 degrees; align the camera; run vam-calibrate"));
  CHECK(has(refused(511, -12.7), "vial.radius_mm: -12.7 is not between 0 (excluded)"));
}

TEST_CASE("a record by hand is held to units, status and single keys") {
  const auto refused = [](const std::string& from, const std::string& to) {
    const scratch::Folder folder;
    const auto calibration = here(folder);
    const std::string path = write_record(calibration, "edges", edges(511.3, 12), utc_seconds());
    Json record = Json::parse(scratch::slurp(path));
    record.erase("seal");
    record["values"]["axis_column"]["unit"] = "px";
    record["values"]["radius"]["unit"] = "mm";
    std::string text = record.dump();
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    std::filesystem::remove(path);
    scratch::spill(path, text);
    model::Printer printer;
    return message_of([&] { apply_records(printer, calibration, utc_seconds()); });
  };
  CHECK(refused("", "").empty());
  CHECK(has(refused("\"px\"", "\"mm\""), "axis_column is in \"mm\", not in px; run vam-calibrate"));
  CHECK(has(refused("\"mm\"", "\"in\""), "radius is in \"in\", not in mm"));
  CHECK(has(refused("\"sigma\":0.01", "\"sigma\":-1"), "axis_column has a sigma of -1 px, not between 0 and 65536"));
  CHECK(has(refused("\"sigma\":0.01", "\"sigma\":1e300"), "axis_column has a sigma of 1e+300 px"));
  CHECK(has(refused("\"value\":12.0", "\"value\":1e-9"), "vial.radius_mm: 1e-09 is no radius of a vial"));
  CHECK(has(refused("\"pass\"", "\"PASS\""), "has the status 'PASS', not pass, warn or fail"));
  CHECK(has(refused("\"status\"", "\"state\""), "has the status ''"));
  CHECK(has(refused("\"value\":511.3", "\"value\":511.3,\"value\":591.3"), "has the key 'value' twice"));
}

TEST_CASE("a record, or a folder of them, that is gone is an error and no default") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  const auto refused = [&] {
    model::Printer printer;
    return error_of([&] { apply_records(printer, calibration, now_s); }, Fault::no_input);
  };
  CHECK(has(refused(), "records: no such folder of calibration records; make it"));
  std::filesystem::create_directory(calibration.folder);
  model::Printer printer;
  apply_records(printer, calibration, now_s);  // none was made yet
  const std::string path = write_record(calibration, "edges", edges(511.3, 12), now_s);
  std::filesystem::remove(path);
  CHECK(has(refused(), "current-edges.json: links to a record that is gone; restore it, or run vam-calibrate edges"));
  const auto link = std::filesystem::path(calibration.folder) / "current-edges.json";
  std::filesystem::remove(link);
  std::filesystem::create_symlink("current-edges.json", link);
  CHECK(has(refused(), "current-edges.json: cannot open: Too many levels of symbolic links"));
  std::filesystem::remove(link);
  REQUIRE(mkfifo(link.c_str(), 0600) == 0);
  CHECK(has(message_of([&] { apply_records(printer, calibration, now_s); }), "current-edges.json: is no regular file"));
}

TEST_CASE("records override the printer file and --set overrides records") {
  const scratch::Folder folder;
  std::ofstream(folder / "printer.toml") << "[projector]\naxis_column = 400\nlatency_ms = 3\n[vial]\nradius_mm = 11\n"
                                            "[calibration]\nfolder = \"records\"\ninstrument = \"printer 1\"\n"
                                            "vial = \"vial 7\"\n";
  const std::string file = folder / "printer.toml";
  const auto calibration = here(folder);
  CHECK(load_printer(file, {}, Records::ignore).projector.axis_column == 400);
  write_record(calibration, "edges", edges(501.25, 12.5), utc_seconds());
  const std::string table = record_path(calibration, "response", utc_seconds(), ".csv");
  write_record(calibration, "response",
               {{"status", "pass"},
                {"values", Json::object()},
                {"files", {{"response", std::filesystem::path(table).filename().string()}}}},
               utc_seconds());
  const auto printer = load_printer(file, {"vial.radius_mm=10"});
  CHECK(printer.projector.axis_column == 501.25);
  CHECK(printer.vial.radius_mm == 10);
  CHECK(printer.projector.latency_ms == 3);
  CHECK(printer.projector.response == table);
  CHECK(load_printer(file, {}, Records::ignore).projector.axis_column == 400);
  CHECK(load_printer(file, {"calibration.folder="}).projector.axis_column == 400);
  CHECK(has(message_of([&] { (void)load_printer(file, {"calibration.instrument=other"}); }), "belongs to instrument"));
}

TEST_CASE("a changed digit in a record, or in its response table, is refused; its layout is free") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  const std::string path = write_record(calibration, "edges", edges(511.3, 12), now_s);
  const std::string whole = scratch::slurp(path);
  const auto refusal = [&](const std::string& text) {
    std::filesystem::remove(path);
    scratch::spill(path, text);
    return message_of([&] { (void)current_record(calibration, "edges"); });
  };
  CHECK(refusal(Json::parse(whole).dump()).empty());
  std::string changed = whole;
  changed.replace(changed.find("511.3"), 5, "591.3");
  CHECK(has(refusal(changed), "current-edges.json: changed after it was written (sealed "));
  CHECK(has(refusal(changed), "remove its key seal if the change was intentional"));
  Json bare = Json::parse(changed);
  bare.erase("seal");
  CHECK(refusal(bare.dump()).empty());  // as a record of before, or by hand
  bare["seal"] = 7;
  CHECK(has(refusal(bare.dump()), "seal unreadable"));
  std::string renamed = changed;
  renamed.replace(renamed.find("\"seal\""), 6, "\"sebl\"");
  CHECK(has(refusal(renamed), "seal unreadable"));
  CHECK(has(refusal(renamed), "remove its key sebl if"));

  const std::string table = (std::filesystem::path(calibration.folder) / "r.csv").string();
  scratch::spill(table, "grey,intensity\n0,0\n255,3.5\n");
  write_record(calibration, "response",
               {{"status", "pass"},
                {"values", Json::object()},
                {"files", {{"response", "r.csv"}}},
                {"sha256", {{"r.csv", sha256_of(table)}}}},
               now_s);
  model::Printer printer;
  std::filesystem::remove(std::filesystem::path(calibration.folder) / "current-edges.json");
  apply_records(printer, calibration, now_s);
  CHECK(printer.projector.response == table);
  scratch::spill(table, "grey,intensity\n0,0\n255,8.5\n");
  CHECK(has(message_of([&] { apply_records(printer, calibration, now_s); }), "r.csv: changed after it was measured"));
}

TEST_CASE("the flat field of a record lies beside it and is the one that was measured") {
  const scratch::Folder folder;
  const auto calibration = here(folder);
  const std::string flat = record_path(calibration, "flat", now_s, ".exr");
  const std::string name = std::filesystem::path(flat).filename().string();
  scratch::spill(flat, "as measured");
  const Json facts{{"status", "pass"},
                   {"values", Json::object()},
                   {"files", {{"flat", name}}},
                   {"sha256", {{name, sha256_of(flat)}}}};
  write_record(calibration, "flat", facts, now_s);
  const auto refusal = [&] {
    model::Printer printer;
    return message_of([&] { apply_records(printer, calibration, now_s + 9); });
  };
  model::Printer printer;
  apply_records(printer, calibration, now_s);
  CHECK(printer.camera.flat == flat);
  scratch::spill(flat, "another one");
  CHECK(has(refusal(), name + ": changed after it was measured (SHA-256 recorded "));
  double later_s = now_s;
  for (const std::string outside : {"../flat.exr", "/etc/hostname", "a/flat.exr", "..", ""}) {
    Json other = facts;
    other["files"]["flat"] = outside;
    write_record(calibration, "flat", other, later_s += 1);
    CHECK(has(refusal(), "current-flat.json: its file '" + outside + "' is not beside it; run vam-calibrate"));
  }
}

TEST_CASE("a wobble that is none is not in force") {
  const auto in_force = [](const Json& wobble) {
    const scratch::Folder folder;
    Json facts = edges(500, 12);
    facts["values"]["wobble_mm"] = wobble;
    write_record(here(folder), "edges", facts, now_s);
    return wobble_in_force_mm(here(folder));
  };
  CHECK(in_force({{"value", 0.5}, {"sigma", 0.1}}) == 0.5);
  for (const Json& none : {Json(3), Json("x"), Json({{"value", "0.5"}}), Json({{"value", 0.2}, {"sigma", 0.1}})}) {
    CHECK_FALSE(in_force(none));
  }
}
