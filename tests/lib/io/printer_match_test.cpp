// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/printer_match.hpp"

#include "io/settings/printer_file.hpp"
#include "testing.hpp"

using vam::Fault;
using namespace vam::io;

namespace {

std::string difference(const std::vector<std::string>& a, const std::vector<std::string>& b,
                       vam::io::Matter matter = vam::io::Matter::light) {
  std::string all;
  for (const auto& one : differences(load_printer("", a), load_printer("", b), matter)) all += one + "; ";
  return all;
}

}  // namespace

TEST_CASE("the text of vam:printer gives the printer again") {
  const auto printer = load_printer("", {"vial.radius_mm=6.1", "resin.name=\"two 'words' = \\\"x\\\" \\\\\"",
                                         "stage.device=gcs:/dev/a b", "projector.telecentric=true"});
  CHECK(printer_toml(parse_settings(printer_settings(printer), "s")) == printer_toml(printer));
  CHECK(printer_toml(parse_settings("default", "s")) == printer_toml({}));
  CHECK(parse_settings("projector.max_led_current=3 vial.radius_mm=7", "s").vial.radius_mm == 7);
  for (const char* wrong : {"vial.radius_mm=round", "vial.radius_mm=nan", "vial.radius_mm=-1", "projector.columns=1e9",
                            "projector.columns=1000000000", "resin.index=inf"}) {
    CAPTURE(wrong);
    CHECK(error_of([&] { (void)parse_settings(wrong, "s"); }, Fault::data).starts_with("s"));
  }
}

TEST_CASE("printers differ where light for one is wrong in the other") {
  CHECK(difference({}, {}).empty());
  CHECK(difference({"vial.radius_mm=12"}, {"vial.radius_mm=6"}) == "vial.radius_mm 12, now 6; ");
  CHECK(difference({"bath.index=1.33", "projector.axis_column=510"}, {}) ==
        "projector.axis_column 510, now 511.5; bath.index 1.33, now 1; ");
  CHECK(difference({"stage.direction=-1"}, {}) == "stage.direction -1, now 1; ");
  CHECK(difference({}, {"projector.throw_ratio=1.9"}) == "projector.lens_distance_mm 119.808, now 126.464; ");
  CHECK(difference({"projector.telecentric=true"}, {}) ==
        "projector.telecentric_columns 1, now 0; projector.telecentric_rows 1, now 0; ");
}

TEST_CASE("settings that a calibration changes, or that are applied at the print, count as no difference") {
  CHECK(difference({}, {"projector.axis_column=511.7", "vial.radius_mm=12.75", "resin.index=1.531"}).empty());
  CHECK(difference({}, {"projector.lens_distance_mm=119.808"}).empty());
  CHECK(difference({}, {"projector.response=a.csv", "projector.rows=900", "stage.speed_deg_s=20"}).empty());
  CHECK(difference({}, {"vial.index_glass=1.6"}).empty());  // without a wall there is no glass
}

TEST_CASE("what decides a print in any way is named") {
  using enum vam::io::Matter;
  CHECK(difference({}, {"stage.speed_deg_s=20", "stage.motion=stepped"}, dose) ==
        "stage.speed_deg_s 10, now 20; stage.motion held, now stepped; ");
  for (const char* one : {"resin.psf_mm 0, now 0.1", "resin.diffusion_mm2_s 0, now 0.001", "resin.dark_s 0, now 60",
                          "resin.critical_dose_mj_cm3 not set, now 50", "projector.min_intensity_mw_cm2 0, now 0.2",
                          "projector.response not set, now /r.csv", "projector.axis_row 383.5, now 390"}) {
    const std::string text = one;
    const std::string set = text.substr(0, text.find(' ')) + "=" + text.substr(text.rfind(' ') + 1);
    CHECK(difference({}, {set}, any) == text + "; ");
    CHECK(difference({}, {set}, dose).empty());
  }
  CHECK(difference({},
                   {"projector.orientation=flip-rows", "projector.fps=1", "stage.turns=5", "camera.fps=3",
                    "stage.device=sim:", "resin.psf_mm=0.0000"},
                   any)
            .empty());
}
