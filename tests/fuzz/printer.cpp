// SPDX-License-Identifier: GPL-3.0-or-later
// A printer file, and the settings as they stand in the metadata of stacks.
#include "fuzz/fuzz.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/printer_match.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text = fuzz::text_of(bytes, size);
  fuzz::attempt([&] { (void)vam::io::parse_settings(text, "settings"); });
  return fuzz::attempt([&] {
    const vam::model::Printer printer = vam::io::parse_printer(text, "printer.toml");
    (void)vam::io::parse_printer(vam::io::printer_toml(printer), "its own");
    (void)vam::io::differences(printer, {}, vam::io::Matter::any);
  });
}
