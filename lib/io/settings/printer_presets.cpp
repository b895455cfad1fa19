// SPDX-License-Identifier: GPL-3.0-or-later
// Printers, vials and resins by name: values that somebody published, each with its source, and what nobody did.
#include <set>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"

namespace vam::io {

namespace {

// As it is listed: kinds, what they have by name, and "key = value: source". What has no value is refused.
constexpr const char* presets = R"(printers
  ray21: the built-in printer, a projector CEL5500 at 460 nm
    projector.columns = 1024: RAY21
    projector.rows = 768: CEL5500, XGA
    projector.pixel_mm = 0.065: RAY21, measured
    projector.throw_ratio = 1.8: RAY21, by its maker
    projector.max_intensity_mw_cm2 = 3.8: RAY21, measured
    projector.fps = 16: RAY21
    stage.speed_deg_s = 10: RAY21
  opencal: OpenCAL on a Raspberry Pi 5; the projector lies on its side, so play videos turned by 90 degrees
    projector.columns = 1080: OpenCAL, generate_alignment_image.py
    projector.rows = 1920: OpenCAL, generate_alignment_image.py
    projector.pixel_mm = 0.0801: OpenCAL, generate_alignment_image.py: 86.47 mm / 1080, measured
    stage.speed_deg_s = 54: OpenCAL, config.json: 9 rpm
    projector.throw_ratio is not published: it is in the data sheet of your projector
    projector.max_intensity_mw_cm2 is not published: measure it
  epfl: a telecentric laser printer at 405 nm
    projector.columns = 768: Dr.TVAM configuration of the gear in arXiv 2507.13842
    projector.rows = 1024: Dr.TVAM configuration of the gear in arXiv 2507.13842
    projector.pixel_mm = 0.02054: Dr.TVAM configuration of the gear in arXiv 2507.13842
    projector.telecentric = true: arXiv 2507.13842
    projector.max_intensity_mw_cm2 is not published: measure it
    stage.speed_deg_s is not published: it is that of your stage
  desktop: a desktop projector of 1920 x 1080, Mi Smart Compact
    projector.columns = 1920: dday.it/redazione/34661, Full HD
    projector.rows = 1080: dday.it/redazione/34661, Full HD
    projector.throw_ratio = 1.2: dday.it/redazione/34661, fixed
    projector.pixel_mm is not published: project a line of 100 pixels to the axis, and measure it
    projector.max_intensity_mw_cm2 is not published: measure it
    stage.speed_deg_s is not published: it is that of your stage

vials
  vial-10: a round tube of 10 mm
    vial.radius_mm = 5: nominal
    vial.wall_mm is not published: measure it
  vial-16: a round vial of 16.6 mm
    vial.radius_mm = 8.3: SwissVAMyKnife.jl, real_world_application.md
    vial.wall_mm = 0.7: SwissVAMyKnife.jl, real_world_application.md
    vial.index_glass = 1.58: SwissVAMyKnife.jl, real_world_application.md
  vial-25: a scintillation vial of 20 ml, 25.4 mm
    vial.radius_mm = 12.7: RAY21, nominal; OST22 measured 24.8 mm across
    vial.wall_mm = 0: RAY21: the index of wall and resin differs by .01 to .02 only
    vial.index_glass = 1.52: RAY21
  cuvette: is square: its walls turn with it, and rays are those of a round vial; use a round one

resins
  bpagda: BPAGDA and PEGDA250 3:1 with camphorquinone, 460 nm
    resin.index = 1.55: OST22, measured at 460 nm; RAY21 computes 1.53 from 588 nm
    camera.index_resin = 1.53: OST22, measured at 624 nm
    resin.initiator_mmol_l = 7.8: RAY21
    resin.extinction_l_mol_cm = 35.0: RAY21: a penetration depth of 15.9 mm by 7.8 mmol/l
    resin.critical_dose_mj_cm3 is not published: vam-calibrate critical-dose measures it
  dudma: DUDMA and PEGDA700 8:2 with camphorquinone, 460 nm
    resin.index = 1.49: OST22, measured at 460 nm
    camera.index_resin = 1.48: OST22, measured at 624 nm
    resin.initiator_mmol_l = 7.8: OST22
    resin.extinction_l_mol_cm = 35.0: as of bpagda: the same initiator and projector
    resin.critical_dose_mj_cm3 is not published: vam-calibrate critical-dose measures it
  dpepa: dipentaerythritol pentaacrylate with TPO, 405 nm
    resin.index = 1.4849: SwissVAMyKnife.jl, real_world_application.md
    resin.absorption_per_mm = 0.05404: SwissVAMyKnife.jl, real_world_application.md: 0.2347 a cm, base 10
    resin.critical_dose_mj_cm3 is not published: vam-calibrate critical-dose measures it

RAY21 and OST22 are in the REFERENCES of vam-physics(7); github.com has computed-axial-lithography/OpenCAL,
EPFL-LAPD/SwissVAMyKnife.jl and EPFL-LAPD/Overprinting-with-Tomographic-Volumetric-Additive-Manufacturing.
)";

struct Preset {
  std::string kind, name, what;
  std::vector<std::string> lines;
};

std::vector<Preset> all_presets() {
  std::vector<Preset> all;
  std::string kind;
  for (const std::string& line : split(presets, '\n')) {
    if (line.starts_with("    ")) {
      all.back().lines.push_back(line.substr(4));
    } else if (line.starts_with("  ")) {
      all.push_back({kind, line.substr(2, line.find(':') - 2), line.substr(line.find(':') + 2), {}});
    } else {
      kind = line.substr(0, line.find_last_of('s'));
    }
  }
  return all;
}

/// Those of "opencal,vial-16"; none where one of the names is of no preset.
std::vector<Preset> presets_of(const std::string& names) {
  std::vector<Preset> found;
  for (const std::string& name : split(names, ',')) {
    const std::size_t before = found.size();
    for (Preset& preset : all_presets()) {
      if (preset.name == name) found.push_back(std::move(preset));
    }
    if (found.size() == before) return {};
  }
  return found;
}

}  // namespace

bool is_preset(const std::string& names) { return !presets_of(names).empty(); }

std::string preset_list() { return presets; }

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : all_presets()) names.push_back(preset.name);
  return names;
}

PresetSettings preset_settings(const std::string& names) {
  PresetSettings settings;
  std::set<std::string> kinds;
  for (const Preset& preset : presets_of(names)) {
    if (preset.lines.empty()) throw Error{Fault::usage, preset.name + ": " + preset.what};
    if (!kinds.insert(preset.kind).second)
      throw Error{Fault::usage, names + ": names a second " + preset.kind + "; give one of a kind"};
    settings.comment += "# " + preset.name + ": " + preset.what + "\n";
    for (const std::string& line : preset.lines) {
      const std::string key = line.substr(0, line.find(' '));
      const std::size_t equals = line.find(" = ");
      if (equals == key.size())
        settings.sets.push_back(key + "=" + line.substr(equals + 3, line.find(':') - equals - 3));
      if (equals != key.size()) settings.unpublished.push_back(key);
      settings.comment += "#   " + line + "\n";
    }
  }
  return settings;
}

}  // namespace vam::io
