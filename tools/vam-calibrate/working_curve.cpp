// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate working-curve: what of the dose scatters, and when, from volumes of a staircase of doses.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/stats/median.hpp"
#include "base/text/json.hpp"
#include "io/settings/sealed_text.hpp"
#include "metrology/cure/curing_curve.hpp"
#include "model/metadata.hpp"
#include "session/volumes.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

namespace fs = std::filesystem;

struct WorkingCurveOptions {
  std::string scatter;
  std::string dose;
  std::string record = "-";
  double lit_from_turn = 0;
  std::optional<double> lit_turns;
  std::optional<double> isovalue;
  int classes = 16;
};

void declare(cli::App& app, WorkingCurveOptions& options) {
  app.positional("SCATTER", options.scatter, "Folder of volumes of vam-ost --live, or one volume (VDB).").reads();
  app.option("--dose", "FILE.vdb", options.dose, "Dose of the staircase in mJ/cm3 (vam-dose).").reads().required();
  app.option("-o,--output", "FILE.json", options.record, "Record for --resin; - is standard output.");
  app.option("--lit-from", "TURNS", options.lit_from_turn, {-1e6, 1e6}, "Turns of the views before the light came on.");
  app.option("--lit-turns", "TURNS", options.lit_turns, cli::positive, "Turns with light.")
      .default_is("those of the dose, if it states them, for one volume; all for a folder");
  app.option("--isovalue", "VALUE", options.isovalue, cli::positive, "Gelation threshold I_p.")
      .default_is("half of the saturation");
  app.option("--classes", "N", options.classes, {4, 256}, "Classes of dose.");
}

/// The dose of one turn, and where it is in the print.
struct TurnDose {
  model::Volume volume;
  double stretch_z = 1;
  std::optional<double> turns;  // that the file holds
};

TurnDose read_dose(const std::string& path) {
  const io::SparseVolume sparse = session::read_dose(path);
  TurnDose dose{io::dense_volume(sparse), model::stretch_z(sparse.metadata),
                model::stated_number(sparse.metadata, "vam:print_turns")};
  if (!dose.turns) return dose;
  for (float& value : dose.volume.values) value /= static_cast<float>(*dose.turns);
  return dose;
}

// In the order of their names, which is that of the turns.
std::vector<std::string> volumes_of(const std::string& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("scatter-") && name.ends_with(".vdb")) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw Error{Fault::data, path + ": has no scatter-NNNN.vdb of vam-ost --live"};
  return files;
}

void run(const cli::App& /*app*/, WorkingCurveOptions& options) {
  const TurnDose dose = read_dose(options.dose);
  const std::vector<std::string> files = volumes_of(options.scatter);
  constexpr double for_ever = 1e9;
  const bool one = files.size() == 1;
  const double lit_turns = options.lit_turns.value_or(one ? dose.turns.value_or(1) : for_ever);
  std::vector<metrology::CuringReading> readings;
  std::vector<double> turn_s;
  for (const std::string& file : files) {
    const io::SparseVolume sparse = session::read_scatter(file);
    const auto turns = model::stated_number(sparse.metadata, "vam:turns");
    if (!turns && !one) throw Error{Fault::data, file + ": does not state its turns; use volumes of vam-ost --live"};
    turn_s.push_back(model::stated_number(sparse.metadata, "vam:turn_s").value_or(0));
    const double last = turns ? *turns - options.lit_from_turn : for_ever;
    if (last <= 0) continue;
    const auto of_turn = metrology::curing_readings(io::dense_volume(sparse), dose.volume, dose.stretch_z,
                                                    options.classes, last - 1, last);
    readings.insert(readings.end(), of_turn.begin(), of_turn.end());
  }
  Json figures = to_json(metrology::fit_curing_curve(readings, lit_turns, options.isovalue), stats::median(turn_s));
  figures["volumes"] = files.size();
  io::write_report(options.record, "vam-working-curve", figures);
}

}  // namespace

void add_working_curve(cli::App& app) {
  app.subcommand<WorkingCurveOptions>("working-curve",
                                      "scattering against dose and its delay, from a staircase of doses", declare, run);
}

}  // namespace vam::calibrate_tool
