// SPDX-License-Identifier: GPL-3.0-or-later
// Tables: a response, poses, and any columns.
#include "fuzz/fuzz.hpp"
#include "io/settings/csv_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const fuzz::File file(fuzz::text_of(bytes, size));
  fuzz::attempt([&] { (void)vam::io::read_response(file.path, 8); });
  fuzz::attempt([&] { (void)vam::io::read_poses(file.path); });
  return fuzz::attempt([&] {
    const vam::io::CsvTable table = vam::io::read_csv(file.path, {"grey", "intensity"});
    for (std::size_t row = 0; row < table.rows.size(); ++row) (void)table.number(row, 1);
  });
}
