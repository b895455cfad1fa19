// SPDX-License-Identifier: GPL-3.0-or-later
// Tolerances from calibration records.
#include "io/settings/recorded_tolerances.hpp"

#include <filesystem>

#include "base/text/json.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/csv_table.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

constexpr double now_s = 1795280280.25;

Json measured(double value, double sigma) { return {{"value", value}, {"sigma", sigma}}; }

void write(const model::Printer& printer, const char* scan, const Json& values) {
  write_record(printer.calibration, scan, {{"status", "pass"}, {"values", values}}, now_s);
}

double of(const model::Tolerances& tolerances, model::ToleranceKind what) {
  return tolerances[static_cast<std::size_t>(what)];
}

}  // namespace

TEST_CASE("tolerances are twice the recorded standard deviations, in their own units") {
  const scratch::Folder folder;
  model::Printer printer;
  printer.calibration.folder = folder / "records";
  printer.vial.radius_mm = 12;
  printer.stage.speed_deg_s = 20;
  write(printer, "edges", {{"axis_column", measured(510, 0.05)}, {"radius", measured(12, 0.006)}});
  write(printer, "latency", {{"latency", measured(40, 1.5)}});
  const model::Tolerances some = recorded_tolerances(printer);
  CHECK(of(some, model::ToleranceKind::axis) == doctest::Approx(0.1));
  CHECK(of(some, model::ToleranceKind::radius) == doctest::Approx(0.1));  // percent
  CHECK(of(some, model::ToleranceKind::angle) == doctest::Approx(0.06));
  for (const auto what : {model::ToleranceKind::index, model::ToleranceKind::lamp, model::ToleranceKind::psf})
    CHECK(of(some, what) == 0);
  write(printer, "beam", {{"axis_fwhm", measured(0.2, 0.01)}});
  CHECK(of(recorded_tolerances(printer), model::ToleranceKind::psf) ==
        doctest::Approx(0.01 / std::sqrt(2 * std::log(2.0))));
}

TEST_CASE("without records there are no tolerances, and an incomplete record is named") {
  const scratch::Folder folder;
  model::Printer printer;
  CHECK(fault_of([&] { (void)recorded_tolerances(printer); }) == Fault::usage);
  printer.calibration.folder = folder / "records";
  CHECK(fault_of([&] { (void)recorded_tolerances(printer); }) == Fault::data);
  write(printer, "edges", {{"axis_column", measured(510, 0.05)}, {"radius", {{"value", 12}}}});
  CHECK(fault_of([&] { (void)recorded_tolerances(printer); }) == Fault::data);
}

TEST_CASE("tolerances of a record that is gone, whose link dangles, are an error") {
  for (const std::string gone : {"edges", "latency", "beam"}) {
    const scratch::Folder folder;
    model::Printer printer;
    printer.calibration.folder = folder / "records";
    write(printer, "edges", {{"axis_column", measured(510, 0.05)}, {"radius", measured(12, 0.006)}});
    write(printer, "latency", {{"latency", measured(40, 1.5)}});
    write(printer, "beam", {{"axis_fwhm", measured(0.2, 0.01)}});
    (void)recorded_tolerances(printer);
    const auto link = std::filesystem::path(printer.calibration.folder) / ("current-" + gone + ".json");
    std::filesystem::remove(std::filesystem::canonical(link));
    CHECK(fault_of([&] { (void)recorded_tolerances(printer); }) == Fault::no_input);
    std::filesystem::remove(link);
    (void)recorded_tolerances(printer);
  }
}

TEST_CASE("the wobble of a record that is gone is an error, that of none nothing") {
  const scratch::Folder folder;
  model::Printer printer;
  CHECK_FALSE(wobble_in_force_mm(printer.calibration));
  printer.calibration.folder = folder / "records";
  CHECK_FALSE(wobble_in_force_mm(printer.calibration));
  write(printer, "edges", {{"wobble_mm", measured(0.5, 0.01)}});
  CHECK(wobble_in_force_mm(printer.calibration) == 0.5);
  const auto link = std::filesystem::path(printer.calibration.folder) / "current-edges.json";
  std::filesystem::remove(std::filesystem::canonical(link));
  CHECK(fault_of([&] { (void)wobble_in_force_mm(printer.calibration); }) == Fault::no_input);
}
