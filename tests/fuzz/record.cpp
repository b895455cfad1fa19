// SPDX-License-Identifier: GPL-3.0-or-later
// Records in JSON: calibrations, resins, and the logs of prints and captures.
#include "fuzz/fuzz.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/sealed_text.hpp"
#include "model/printer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::File file(fuzz::text_of(bytes, size));
  fuzz::attempt([&] { (void)vam::io::gelation_isovalue(file.path); });
  fuzz::attempt([&] { vam::io::FlipLog(file.path).read(); });
  fuzz::attempt([&] { (void)vam::io::read_wobble(file.path, {}, 1); });
  return fuzz::attempt([&] {
    const auto record = vam::io::read_record(file.path);
    for (const char* name : {"axis_column", "vial_radius"}) {
      fuzz::attempt([&] { (void)(record.value(name) + record.sigma(name)); });
    }
    (void)vam::io::objection(record, {}, 1.7e9);
  });
}
