// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/printer_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "io/settings/csv_table.hpp"
#include "io/settings/private/printer_fields.hpp"
#include "io/settings/sealed_text.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Error;
using vam::Fault;
using namespace vam::io;

namespace {

std::string refusal(const std::string& toml) {
  return error_of([&] { (void)parse_printer(toml, "p.toml"); }, Fault::data);
}

std::string set_refusal(const std::string& set) {
  return error_of([&] { (void)load_printer("", {set}); }, Fault::usage);
}

}  // namespace

TEST_CASE("the default printer prints and parses back to itself, text for text") {
  const std::string text = printer_toml({});
  CHECK(printer_toml(parse_printer(text, "default")) == text);
  CHECK(has(text, "radius_mm = 12.7"));
  CHECK(has(text, "# lens_distance_mm ="));
}

TEST_CASE("every field changed survives the round trip") {
  vam::model::Printer printer;
  for (const auto& field : vam::io::printer_fields()) {
    const auto slot = field.slot(printer);
    if (auto* const* text = std::get_if<std::string*>(&slot))
      **text = !field.schemes.empty() ? field.schemes.front() + ":a \"b\"\\\n"
               : field.words.empty()  ? "a \"b\"\\\n"
                                      : field.words.back();
    if (auto* const* flag = std::get_if<bool*>(&slot)) **flag = !**flag;
    if (auto* const* whole = std::get_if<int*>(&slot)) **whole = field.words.empty() ? **whole + 1 : 10;
    if (auto* const* number = std::get_if<double*>(&slot)) **number *= 1 + 1e-3 / 3;
    if (auto* const* maybe = std::get_if<std::optional<double>*>(&slot)) **maybe = std::min(1e3 / 7, field.high / 7);
  }
  printer.stage.direction = -1;
  printer.resin.absorption_per_mm = std::log(10) * 1e3 / 7 * 1e3 / 7 * 1e-4;  // of that initiator
  const auto back = parse_printer(printer_toml(printer), "changed");
  CHECK(printer_toml(back) == printer_toml(printer));
  CHECK(back.vial.radius_mm == printer.vial.radius_mm);
  CHECK(back.resin.name == printer.resin.name);
  CHECK(*back.projector.lens_distance_mm == 1e3 / 7);
  CHECK(back.projector.telecentric);
}

TEST_CASE("settings that are absent keep their defaults; whole numbers serve as decimals") {
  const auto printer = parse_printer("[vial]\nradius_mm = 10\n", "p.toml");
  CHECK(printer.vial.radius_mm == 10);
  CHECK(printer.projector.columns == 1024);
}

TEST_CASE("the axis is in the middle of the image as set, unless it is given") {
  const auto axis = [](const vam::model::Printer& printer) {
    return std::pair{printer.projector.axis_column, printer.projector.axis_row};
  };
  CHECK(axis(load_printer("", {})) == std::pair{511.5, 383.5});
  CHECK(axis(load_printer("", {"projector.columns=240", "projector.rows=41"})) == std::pair{119.5, 20.0});
  CHECK(axis(load_printer("", {"projector.axis_row=40", "projector.rows=41"})) == std::pair{511.5, 40.0});
  const auto file = parse_printer("[projector]\ncolumns = 240\naxis_row = 7\n", "p.toml");
  CHECK(axis(file) == std::pair{119.5, 7.0});
  CHECK(has(refusal("[projector]\naxis_row = nan\n"), "p.toml:2: projector.axis_row: nan is not between"));
  CHECK(printer_settings(file) == "projector.columns=240 projector.axis_column=119.5 projector.axis_row=7.0");
}

TEST_CASE("unknown keys name file, line and the nearest known key") {
  CHECK(refusal("[vial]\n\nradius_m = 12\n") == "p.toml:3: unknown key 'radius_m' in [vial]; did you mean radius_mm?");
  CHECK(
      has(refusal("[vail]\nradius_mm = 12\n"), "p.toml:1: unknown section 'vail'; the sections are projector, vial, "));
  CHECK(has(refusal("[viall]\nradius_mm = 12\n"), "p.toml:1: unknown section 'viall'; did you mean vial?"));
  CHECK(has(refusal("[vial]\ncolour = 12\n"),
            "unknown key 'colour' in [vial]; [vial] has radius_mm, wall_mm, index_glass"));
  CHECK(has(refusal("radius_mm = 12\n"), "did you mean vial.radius_mm?"));
  CHECK(has(refusal("[resin]\nradius_mm = 12\n"), "did you mean vial.radius_mm?"));
}

TEST_CASE("wrong types and impossible values name file and line") {
  CHECK(has(refusal("[projector]\ncolumns = 1024.5\n"), "p.toml:2: projector.columns must be a whole number"));
  for (const std::string digits : {"2147483648", "-2147483649", "9223372036854775807", "99999999999999999999"}) {
    for (const std::string after : {"", " # in each image", "\r"}) {
      CHECK(has(refusal("[vial]\n[ projector ] # DMD\n rows = " + digits + after + "\ncolumns = 64\n"),
                "p.toml:3: projector.rows: " + digits + " is not between 1 and 65536"));
    }
    CHECK(has(set_refusal("projector.rows=" + digits), ": " + digits + " is not between 1 and 65536"));
    CHECK(has(refusal("[projector]\nbits = " + digits + "\n"), "'" + digits + "' is not one of 1, 2, 4, 8, 10, 16"));
  }
  CHECK(has(refusal("[projector]\nlines = 99999999999999999999\n"), "p.toml:2: not TOML"));
  for (const char* key : {"[stage]\nspeed_deg_s", "[camera]\nfps", "[projector]\nfps"}) {
    CHECK(has(refusal(std::string(key) + " = 1e-300\n"), "1e-300 is not between 0.001 and 1000000"));
  }
  CHECK(has(refusal("[vial]\nradius_mm = \"12\"\n"), "must be a number, not text"));
  CHECK(has(refusal("[projector]\ntelecentric = 1\n"), "must be true or false"));
  CHECK(has(refusal("vial = 3\n"), "must be a section"));
  CHECK(has(refusal("[vial]\nradius_mm = -1\n"), "p.toml:2: vial.radius_mm: -1 is not between 0"));
  CHECK(has(refusal("[vial]\nradius_mm = nan\n"), "nan is not between"));
  for (const std::string beyond : {"1e30", "1e300", "inf"}) {  // one for which every product is finite, or none
    CHECK(has(refusal("[projector]\nmax_intensity_mw_cm2 = " + beyond + "\n"),
              " is not between 0 (excluded) and 1000000000"));
    CHECK(has(refusal("[resin]\ncritical_dose_mj_cm3 = " + beyond + "\n"),
              " is not between 0 (excluded) and 1000000000"));
  }
  CHECK(has(refusal("[projector]\nbits = 3\n"), "'3' is not one of 1, 2, 4, 8, 10, 16"));
  CHECK(has(refusal("[projector]\norientation = \"up\"\n"), "not one of normal"));
  CHECK(has(refusal("[vial\n"), "p.toml:1: not TOML"));
  CHECK(refusal(" BDV") == "p.toml: is a volume (OpenVDB), not a printer file");
  CHECK(has(refusal("[vial]\nwall_mm = 13\n"), "leaves no room"));
  CHECK(has(refusal("[projector]\nlens_distance_mm = 5\n"), "is not outside vial.radius_mm"));
  CHECK(has(refusal("[bath]\nwindow_mm = 5\n"), "cuts into"));
  CHECK(has(refusal("[vial]\nradius_mm = 12\n[camera]\ndistance_mm = 12\n"),
            "camera.distance_mm 12 mm is not outside vial.radius_mm 12 mm"));
  CHECK_NOTHROW(parse_printer("[vial]\nradius_mm = 12\n[camera]\ndistance_mm = 12.1\n", "p"));
  CHECK_NOTHROW(parse_printer("[camera]\ndistance_mm = 5\ntelecentric = true\n", "p"));
}

TEST_CASE("--set overrides, takes text with or without quotes, and is a usage error when wrong") {
  const auto printer = load_printer("", {"vial.radius_mm=10", "resin.name=acrylate 2", "stage.device=\"gcs:/dev/x\""});
  CHECK(printer.vial.radius_mm == 10);
  CHECK(printer.resin.name == "acrylate 2");
  CHECK(printer.stage.device == "gcs:/dev/x");
  CHECK(has(set_refusal("vial.radius_m=10"), "did you mean radius_mm?"));
  CHECK(has(set_refusal("vial.radius=10"), "did you mean radius_mm?"));
  CHECK(has(set_refusal("rsin.index=1.5"), "did you mean resin.index?"));
  CHECK(has(set_refusal("glass.index=1.5"), "did you mean bath.index?"));
  CHECK(has(set_refusal("vial.radius_mm"), "not section.key=value"));
  CHECK(has(set_refusal("vial.radius_mm=ten"), "is not a value"));
  CHECK(has(set_refusal("vial.radius_mm=1\nx=2"), "is not a value"));
  CHECK(has(set_refusal("vial.radius_mm=-4"), "-4 is not between"));
  CHECK(has(set_refusal("vial.wall_mm=40"), "leaves no room"));
}

TEST_CASE("settings apart from the default can be given to --set again") {
  CHECK(printer_settings(load_printer("", {})) == "default");
  const auto changed = load_printer("", {"vial.radius_mm=10", "resin.name=resin2"});
  CHECK(printer_settings(changed) == "vial.radius_mm=10.0 resin.name=\"resin2\"");
  CHECK(printer_toml(load_printer("", {"vial.radius_mm=10.0", "resin.name=\"resin2\""})) == printer_toml(changed));
}

TEST_CASE("the named file overrides $VAM_PRINTER; a response is relative to the file") {
  const scratch::Folder folder;
  const std::string named = folder.write("a.toml", "[vial]\nradius_mm = 11\n[projector]\nresponse = \"r.csv\"\n");
  const std::string exported = folder.write("b.toml", "[vial]\nradius_mm = 9\n");
  setenv("VAM_PRINTER", exported.c_str(), 1);
  CHECK(load_printer(named, {}).vial.radius_mm == 11);
  CHECK(load_printer("", {}).vial.radius_mm == 9);
  unsetenv("VAM_PRINTER");
  CHECK(load_printer(named, {}).projector.response == (folder.path / "r.csv").string());
  error_of([&] { (void)load_printer((folder.path / "none.toml").string(), {}); }, Fault::no_input);
  error_of([&] { (void)load_printer(folder.path.string(), {}); }, Fault::no_input);
}

TEST_CASE("a printer file of these tools that is cut anywhere is refused, or has lost nothing") {
  const std::string whole = printer_toml(load_printer("", {"vial.radius_mm=10", "camera.fps=7", "calibration.vial=v"}));
  const std::string settings = printer_toml(parse_printer(whole, "p"));
  CHECK(settings == whole);
  int refused = 0;
  for (std::size_t size = 1; size < whole.size(); ++size) {
    CAPTURE(size);
    std::string read;
    try {
      read = printer_toml(parse_printer(whole.substr(0, size), "p"));
    } catch (const Error& error) {
      CHECK(error.fault == Fault::data);
      ++refused;
      continue;
    }
    CHECK(read == settings);
  }
  CHECK(refused > static_cast<int>(whole.size()) - 10);
  CHECK(has(error_of([&] { (void)parse_printer(whole.substr(0, 700), "p"); }, Fault::data), "p: is cut off after 700"));
  // The mark of its beginning may stand below a person's remarks, or an editor's byte order mark.
  for (const char* above : {"# bench 3\n\n", "\xEF\xBB\xBF"}) {
    CHECK(printer_toml(parse_printer(above + whole, "p")) == settings);
    const std::string cut = above + whole.substr(0, whole.find("\n[camera]") + 1);
    CHECK(has(error_of([&] { (void)parse_printer(cut, "p"); }, Fault::data), "p: is cut off after"));
  }
  const scratch::Folder folder;
  CHECK(has(error_of([&] { (void)load_printer(folder.write("b.toml", ""), {}); }, Fault::data), "is empty"));
  (void)load_printer("/dev/null", {});
}

TEST_CASE("a printer file by hand is warned of where its end looks cut off, but for a few settings") {
  using vam::io::sign_of_cut;
  const scratch::Folder folder;
  const auto said = [&](const std::string& text) {
    const scratch::Redirect to(STDERR_FILENO, folder / "said");
    (void)load_printer(folder.write("a.toml", text), {});
    return scratch::slurp(folder / "said");
  };
  CHECK(parse_printer("[vial]\nradius_mm = 11", "p").vial.radius_mm == 11);  // accepted all the same
  CHECK(has(said("[projector]\nfps = 7\n[vial]\nradius_mm = 1"),
            "a.toml: ends within a line, as if it was cut off, without [bath], [resin], [stage], [camera], [optimize], "
            "[calibration]; complete its last line\n"));
  const std::string three = "[projector]\nfps = 7\n[vial]\nradius_mm = 11\n[resin]\nindex = 1.5\n";
  const std::string ten = "[projector]\nfps = 7\nrows = 9\ncolumns = 9\nbits = 8\npixel_mm = 1\nthrow_ratio = 9\n" +
                          three.substr(three.find("[vial]")) + "psf_mm = 0\ndark_s = 0\n";
  CHECK(has(said(ten),
            "ends after [resin], as if it was cut off, without [bath], [stage], [camera], [optimize], [calibration]; "
            "add what is missing, or the last line '# end of the settings' if nothing is\n"));
  CHECK(said(three).empty());
  CHECK(has(said("[stage]\nturns = 2\n\n[camera]\n# fps = 2\n"), "ends with the heading [camera]"));
  CHECK(has(sign_of_cut(" [ projector ] # a\r\n" + ten.substr(ten.find("fps"))), "ends after [resin]"));
  CHECK(said("[vial]\nradius_mm = 11\n").empty());
  CHECK(said("[projector]\nfps = 7\n[vial]\nradius_mm = 11\n").empty());
  CHECK(said(ten + "# end of the settings\n").empty());
  CHECK(said(vam::io::sealed_text(ten)).empty());
  CHECK(sign_of_cut(ten + "[calibration]\nfolder = \"r\"\n").empty());
  CHECK(sign_of_cut("[stage]\nturns = 2\n[vial]\nradius_mm = 11\n[resin]\nindex = 1.5\n").empty());  // in no order
  CHECK(sign_of_cut("# nothing yet\n").empty());
  // Nine keys are a note, ten are the description of an instrument.
  std::string nine = "[projector]\n";
  for (int key = 0; key < 9; ++key) nine += "a = 1\n# b = 1\n";
  CHECK(sign_of_cut(nine).empty());
  CHECK(has(sign_of_cut(nine + "c = 1\n"), "ends after [projector]"));
}

TEST_CASE("a preset is a printer, a vial and a resin by name, complete but for what nobody published") {
  const scratch::Folder folder;
  std::string printed;
  const auto said = [&](const std::string& names, const std::vector<std::string>& sets) {
    const scratch::Redirect to(STDERR_FILENO, folder / "said");
    printed = printer_toml(load_printer(names, sets));
    return scratch::slurp(folder / "said");
  };
  CHECK(said("ray21,vial-25,bpagda", {}).empty());
  const auto printer = parse_printer(printed, "p");
  CHECK(1 / printer.resin.absorption_per_mm == doctest::Approx(15.9).epsilon(0.001));  // mm, as [RAY21] measured
  CHECK(printer.projector.pixel_mm == 0.065);
  CHECK(!printer.resin.critical_dose_mj_cm3);
  CHECK(has(said("vial-16,opencal", {"projector.throw_ratio=1.3"}), "projector.max_intensity_mw_cm2 is not published"));
  CHECK(has(printed, "axis_column = 539.5"));
  CHECK(has(said("vial-10", {}), "vial-10: vial.wall_mm is not published"));
  CHECK(has(said("desktop", {}), "projector.pixel_mm, projector.max_intensity_mw_cm2, stage.speed_deg_s are not"));
  CHECK(has(error_of([] { (void)load_printer("dudma,dpepa", {}); }, Fault::usage), "names a second resin"));
  CHECK(has(error_of([] { (void)load_printer("ray21,cuvette", {}); }, Fault::usage), "cuvette: is square"));
  CHECK(has(error_of([] { (void)load_printer("ray21,dudna", {}); }, Fault::no_input), "did you mean dudma?"));
  for (const std::string& name : vam::io::preset_names()) {
    if (name != "cuvette") (void)said(name, {});
  }
}

TEST_CASE("concentration and extinction of the initiator state the absorption, or agree with it") {
  const auto mu = [](const std::vector<std::string>& sets) {
    return load_printer("dudma", sets).resin.absorption_per_mm;
  };
  CHECK(mu({"resin.initiator_mmol_l=10", "resin.extinction_l_mol_cm=46"}) ==
        doctest::Approx(0.10592));  // ln 10 x 0.46 / cm
  CHECK(mu({"resin.initiator_mmol_l=3.9"}) == doctest::Approx(0.5 * mu({})));
  CHECK(mu({"resin.absorption_per_mm=0.1"}) == 0.1);
  CHECK(has(refusal("[resin]\ninitiator_mmol_l = 5\n"), "set both, or neither"));
  CHECK(has(refusal("[resin]\nabsorption_per_mm = 0.1\ninitiator_mmol_l = 10\nextinction_l_mol_cm = 46\n"),
            "0.1 is not the 0.1059"));
  CHECK(has(set_refusal("resin.initiator_mmol_l=-1"), "is not between 0"));
}

TEST_CASE("files that would fill the memory or the stack are refused in one line") {
  CHECK(has(error_of([] { (void)load_printer("/dev/zero", {}); }, Fault::data), "/dev/zero: is longer than 256 KiB"));
  std::string dotted = "vial";
  for (int i = 0; i < 100'000; ++i) dotted += ".a";
  CHECK(has(error_of([&] { (void)parse_printer(dotted + " = 1\n", "p.toml"); }, Fault::data),
            "p.toml: has 100000 dots and brackets; the limit for a printer file is 4096"));
  CHECK(has(error_of([&] { (void)parse_printer("a = " + std::string(100'000, '['), "p.toml"); }, Fault::data), "dots"));
  const std::string inline_keys = "{" + dotted + " = 1}";
  CHECK(has(error_of([&] { (void)load_printer("", {"vial.radius_mm=" + inline_keys}); }, Fault::usage), "not a value"));
  // All that nesting may be, in one key.
  CHECK(has(error_of([&] { (void)parse_printer(dotted.substr(0, 8000) + " = 1\n", "p.toml"); }, Fault::data),
            "unknown key 'a' in [vial]"));
}

TEST_CASE("a response table is read by its header and refused with its line") {
  const scratch::Folder folder;
  const auto table =
      vam::io::read_response(folder.write("r.csv", "# lamp 3\ngrey,intensity\n0,0.1\n128, 1.5\r\n255,4\n"), 8);
  CHECK(table.grey == std::vector<double>{0, 128, 255});
  CHECK(table.intensity == std::vector<double>{0.1, 1.5, 4});
  const auto refused = [&](const std::string& csv) {
    const std::string file = folder.write("bad.csv", csv);
    return error_of([&] { (void)vam::io::read_response(file, 8); }, Fault::data);
  };
  CHECK(has(refused("grey,intensity\n0,0\n10,2\n20,1\n"), "bad.csv:4: intensity 1 at grey 20 is below 2"));
  CHECK(has(refused("grey,intensity\n0,0\n10,2\n10,3\n"), "bad.csv:4: grey 10 does not rise"));
  CHECK(has(refused("grey,intensity\n5,0\n10,2\n"), "must begin at grey 0"));
  CHECK(has(refused("grey,intensity\n0,0\n10\n"), "bad.csv:3: '10' is not two numbers"));
  CHECK(has(refused("grey,intensity\n0,0\n10,nan\n"), "is not two numbers"));
  for (const std::string head : {"intensity,grey", "grey,intensity,grey", "grey;intensity", "0,0"}) {
    CHECK(has(refused(head + "\n0,0\n255,1\n"), "bad.csv:1: '" + head + "' is not the header 'grey,intensity'"));
  }
  CHECK(vam::io::read_response(folder.write("r.csv", "\"grey\", \"intensity\"\r\n0,0\n255,1\n"), 8).grey.size() == 2);
  CHECK(has(refused("grey,intensity\n"), "at least two lines"));
  CHECK(has(refused("grey,intensity\n0,0\n255,1e308\n"), "bad.csv:3: intensity 1e+308 is more than 1e9"));
  CHECK(has(refused("grey,intensity\n0,0\n256,1\n"), "bad.csv: the greys end at 256; projector.bits 8 end at 255; "));
  CHECK(vam::io::read_response(folder.write("cut.csv", "grey,intensity\n0,0\n200,1\n"), 8).grey.back() == 200);
}
