// SPDX-License-Identifier: GPL-3.0-or-later
// What the volumes of a 3MF package are for, in the words of the core specification (1.4, chapter 4), of PrusaSlicer's
// Slic3r_PE_model.config and BambuStudio's model_settings.config (ModelVolume::type_from_string), and of Cura's
// settings of a mesh. A surface encloses nothing, what is "other" must not be built, and a cutting mesh prints no more
// than what it cuts.
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/model_part.hpp"

namespace vam::io {

namespace {

// Between blanks.
constexpr std::pair<Role, std::string_view> role_words[] = {
    {Role::added, " model ModelPart normal_part 0 "},
    {Role::taken_away, " NegativeVolume negative_part "},
    {Role::ignored,
     " support solidsupport ParameterModifier modifier_part 1 SupportEnforcer support_enforcer SupportBlocker "
     "support_blocker cura:infill_mesh cura:cutting_mesh cura:support_mesh cura:anti_overhang_mesh "}};

}  // namespace

Role role_of(std::string_view type) {
  for (const auto& [role, words] : role_words)
    if (words.find(" " + std::string(type) + " ") != words.npos) return role;
  return Role::refused;
}

std::vector<VolumeType> parse_volume_types(const ByteFeed& feed) {
  std::vector<VolumeType> volumes;
  unsigned object = 0;
  const auto begin = [&](const XmlElement& element) {
    if (element.name == "object") object = element.number<unsigned>("id");
    if (element.name == "volume" || element.name == "part") {
      VolumeType& volume = volumes.emplace_back();
      volume.object = object;
      volume.type = element.attribute("subtype").value_or("ModelPart");
      if (element.attribute("lastid").value_or("0") != "0") {
        volume.first = element.number<std::size_t>("firstid");
        volume.last = element.number<std::size_t>("lastid");
      } else if (element.attribute("id")) {
        volume.component = element.number<unsigned>("id");
      }
    } else if (element.name == "metadata" && !volumes.empty() && element.attribute("type").value_or("") == "volume") {
      const std::string_view key = element.attribute("key").value_or("");
      if (key == "volume_type" || key == "modifier") volumes.back().type = element.attribute("value").value_or("");
    }
  };
  parse_xml(feed, {begin, {}, {}});
  return volumes;
}

}  // namespace vam::io
