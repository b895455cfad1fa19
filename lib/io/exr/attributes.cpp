// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/attributes.hpp"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/seal.hpp"
#include "model/metadata.hpp"

namespace vam::io::exr {

namespace {

using model::ImageInfo;
using model::Kind;
using model::Space;
using model::StackInfo;

constexpr std::pair<Kind, const char*> kinds[] = {{Kind::sinogram, "sinogram"}, {Kind::frames, "frames"}};
constexpr std::pair<Space, const char*> spaces[] = {
    {Space::virtual_, "virtual"}, {Space::projector, "projector"}, {Space::camera, "camera"}};
constexpr const char* poses_name = "vam:poses";
constexpr const char* piece_name = "vam:piece";
constexpr double farthest_mm = 2000;  // from the lens's height

/// A number of the whole stack, and how large it may be beside a vial.
constexpr struct {
  const char* name;
  double StackInfo::*member;
  double most;
} numbers[] = {{"vam:pixel_mm", &StackInfo::pixel_mm, 100},
               {"vam:row_mm", &StackInfo::row_mm, 100},
               {"vam:z_mm", &StackInfo::z_start_mm, farthest_mm},
               {"vam:angle_start_deg", &StackInfo::angle_start_deg, 1e7},
               {"vam:angle_step_deg", &StackInfo::angle_step_deg, 360}};

template <class Named, class Value>
std::string name_in(const Named& named, Value value) {
  return std::find_if(std::begin(named), std::end(named), [&](const auto& one) { return one.first == value; })->second;
}

void set_text(Imf::Header& header, const char* name, const std::string& text) {
  header.insert(name, Imf::StringAttribute(text));
}
void set_number(Imf::Header& header, const char* name, double value) {
  header.insert(name, Imf::DoubleAttribute(value));
}
void set_integer(Imf::Header& header, const char* name, int value) { header.insert(name, Imf::IntAttribute(value)); }

// Other programs that pass a file on may store a number in another type.
std::optional<double> number(const Imf::Header& header, const char* name) {
  std::optional<double> value;
  if (const auto* wide = header.findTypedAttribute<Imf::DoubleAttribute>(name)) value = wide->value();
  if (const auto* narrow = header.findTypedAttribute<Imf::FloatAttribute>(name)) value = narrow->value();
  if (const auto* whole = header.findTypedAttribute<Imf::IntAttribute>(name)) value = whole->value();
  if (value && !std::isfinite(*value)) throw std::runtime_error(std::string(name) + " is not a finite number");
  return value;
}

std::vector<std::string> lines_of(const std::string& all) {
  std::vector<std::string> lines;
  std::istringstream stream(all);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// A copy is in the header of every image.
std::string checked_history(const std::string& text) {
  constexpr std::size_t most_bytes = 1 << 20;
  if (text.size() <= most_bytes) return text;
  throw std::runtime_error("vam:history has " + std::to_string(text.size()) + " bytes, more than 1 MiB");
}

model::Piece checked_piece(const std::string& text) {
  if (const auto piece = model::parse_piece(text)) return *piece;
  throw std::runtime_error(std::string(piece_name) + " is " + excerpt(text) + ", not like '64:128 of 160'");
}

}  // namespace

std::string kind_name(Kind kind) { return name_in(kinds, kind); }
std::string space_name(Space space) { return name_in(spaces, space); }

std::optional<std::string> text(const Imf::Header& header, const char* name) {
  const auto* found = header.findTypedAttribute<Imf::StringAttribute>(name);
  return found != nullptr ? std::optional(found->value()) : std::nullopt;
}

ImageInfo implied(const StackInfo& info, int index) {
  ImageInfo about;
  const bool sinogram = info.kind == Kind::sinogram;
  about.z_mm = info.z_start_mm + (sinogram ? index * info.row_mm : 0.0);
  about.angle_deg = info.angle_start_deg + (sinogram ? 0.0 : index * info.angle_step_deg);
  return about;
}

std::string part_name(const StackInfo& info, int index) {
  const int digits = std::max(4, static_cast<int>(std::to_string(info.count - 1).size()));
  char name[32];
  std::snprintf(name, sizeof name, "%c%0*d", info.kind == Kind::sinogram ? 'z' : 'a', digits, index);
  return name;
}

std::string implausible(const StackInfo& info) {
  constexpr double least_pitch_mm = 1e-6;
  for (const auto& [name, member, most] : numbers) {
    if (std::abs(info.*member) <= most) continue;
    return std::string(name) + " is " + format_number(info.*member) + ", beyond " + format_number(most);
  }
  for (const double pitch_mm : {info.pixel_mm, std::abs(info.row_mm)}) {
    if (pitch_mm == 0 || pitch_mm >= least_pitch_mm) continue;
    return "a pitch of " + format_number(pitch_mm) + " mm is less than " + format_number(least_pitch_mm);
  }
  return "";
}

void set_common(Imf::Header& header, const StackInfo& info) {
  for (const auto& [name, value] : info.extra) set_text(header, name.c_str(), value);
  set_text(header, "vam:kind", kind_name(info.kind));
  set_text(header, "vam:space", space_name(info.space));
  set_integer(header, "vam:count", info.count);
  for (const auto& one : numbers) set_number(header, one.name, info.*one.member);
  set_text(header, "vam:units", info.units);
  set_text(header, "vam:history", join(info.history, "\n"));
  if (!info.piece.whole()) set_text(header, piece_name, model::piece_text(info.piece));
}

void set_own(Imf::Header& header, const StackInfo& info, int index, const ImageInfo& about) {
  header.setName(part_name(info, index));
  if (index == 0 && !info.poses.empty()) set_text(header, poses_name, model::poses_text(info.poses));
  if (index > 0) header.erase(poses_name);  // long, and the same for all
  set_integer(header, "vam:index", index);
  set_number(header, "vam:z_mm", about.z_mm);
  if (about.has_angle) set_number(header, "vam:angle_deg", about.angle_deg);
  if (about.has_time) {
    set_number(header, "vam:time_s", about.time_s);
    set_number(header, "vam:time_sigma_s", about.time_sigma_s);
  }
  if (!about.has_number) return;
  set_integer(header, "vam:number", about.number);
  set_integer(header, "vam:incomplete", about.incomplete ? 1 : 0);
}

void require_version(const Imf::Header& header) {
  if (header.find(version_name) == header.end()) return;
  const auto value = number(header, version_name);
  const std::string stated = text(header, version_name).value_or(value ? format_number(*value, 12) : "");
  if (const std::string why = FormatKind("stack").objection(stated); !why.empty()) throw std::runtime_error(why);
}

StackInfo stack_info(const Imf::Header& header) {
  StackInfo info;
  const auto kind = text(header, "vam:kind");
  if (!kind) throw std::runtime_error("has no vam:kind, so it is not a stack that these tools wrote");
  const auto* same_kind =
      std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& one) { return one.second == *kind; });
  if (same_kind == std::end(kinds))
    throw std::runtime_error("vam:kind is " + excerpt(*kind) + ", not sinogram or frames");
  info.kind = same_kind->first;
  const auto space = text(header, "vam:space").value_or("");
  const auto* same_space =
      std::find_if(std::begin(spaces), std::end(spaces), [&](const auto& one) { return one.second == space; });
  if (same_space == std::end(spaces)) {
    throw std::runtime_error("vam:space is " + excerpt(space) + ", not virtual, projector or camera");
  }
  info.space = same_space->first;
  info.count = static_cast<int>(number(header, "vam:count").value_or(0));
  for (const auto& one : numbers) info.*one.member = number(header, one.name).value_or(0);
  if (info.pixel_mm <= 0) throw std::runtime_error("vam:pixel_mm is missing or not positive");
  if (const std::string why = implausible(info); !why.empty()) throw std::runtime_error(why);
  info.units = text(header, "vam:units").value_or(info.units);
  info.history = lines_of(checked_history(text(header, "vam:history").value_or("")));
  if (const auto poses = text(header, poses_name)) info.poses = model::parse_poses(*poses);
  if (const auto piece = text(header, piece_name)) info.piece = checked_piece(*piece);
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    const bool standard = name == "name" || name == "type" || name == "view";
    if (const auto value = text(header, it.name()); value && !is_own_fact(name) && !standard) info.extra[name] = *value;
  }
  if (const auto stretch = info.extra.find(model::stretch_name); stretch != info.extra.end()) {
    const std::string why = model::stretch_objection(stretch->second);
    if (!why.empty()) throw std::runtime_error(why);
  }
  return info;
}

void require_alike(const Imf::Header& header, const StackInfo& first, const StackInfo& own, int index) {
  const std::string image = "image " + std::to_string(index);
  const auto compare = [&](const char* name, const std::string& is, const std::string& was) {
    if (is == was) return;
    throw std::runtime_error(image + " has " + name + " " + is + ", but image 0 has " + was +
                             "; all of a stack have the same");
  };
  compare("vam:space", space_name(own.space), space_name(first.space));
  compare("vam:units", excerpt(own.units), excerpt(first.units));
  for (const auto& [name, member, most] : numbers) {
    if (member != &StackInfo::z_start_mm && own.*member != first.*member)
      compare(name, format_number(own.*member, 9), format_number(first.*member, 9));
  }
  const auto printer = [](const StackInfo& info) { return model::stated_text(info.extra, "vam:printer"); };
  for (const auto& [name, same] :
       {std::pair{"vam:history", own.history == first.history}, {"vam:printer", printer(own) == printer(first)}}) {
    if (same) continue;
    throw std::runtime_error(image + " has another " + name +
                             " than image 0; all of a stack are made by the same commands");
  }
  if (first.kind != Kind::sinogram) return;
  const auto stated = number(header, "vam:z_mm");
  const double z_mm = implied(first, index).z_mm;
  constexpr double within = 0.01;  // of a slice: a float of another program, and sums of a pitch
  if (stated && std::abs(*stated - z_mm) <= within * std::abs(first.row_mm)) return;
  if (!stated && index == 0) return;  // a stack of one, or the next will be missed
  throw std::runtime_error(image + (stated ? " has vam:z_mm " + format_number(*stated, 9) : " has no vam:z_mm") +
                           ", but its place is " + format_number(z_mm, 9) + ", " + std::to_string(index) +
                           " x vam:row_mm " + format_number(first.row_mm, 9) + " above image 0");
}

void require_pitch(const StackInfo& info) {
  if (info.kind != Kind::sinogram || info.count < 2 || info.row_mm > 0) return;
  throw std::runtime_error("its slice pitch, vam:row_mm, is " + format_number(info.row_mm) +
                           " mm or missing; it must be above 0");
}

ImageInfo image_info(const Imf::Header& header, const StackInfo& info, int index) {
  const int found = static_cast<int>(number(header, "vam:index").value_or(index));
  if (found != index) {
    throw std::runtime_error("part " + std::to_string(index) + " has vam:index " + std::to_string(found) +
                             "; parts are missing, or not in order");
  }
  if (text(header, "vam:kind").value_or("") != kind_name(info.kind)) {
    throw std::runtime_error("part " + std::to_string(index) + " is of another kind than part 0");
  }
  ImageInfo about = implied(info, index);
  about.z_mm = number(header, "vam:z_mm").value_or(about.z_mm);
  if (!(std::abs(about.z_mm) <= farthest_mm)) {
    throw std::runtime_error("vam:z_mm of image " + std::to_string(index) + " is " + format_number(about.z_mm) +
                             ", beyond " + format_number(farthest_mm));
  }
  if (const auto angle = number(header, "vam:angle_deg")) {
    about.angle_deg = *angle;
    about.has_angle = true;
  }
  if (const auto time = number(header, "vam:time_s")) {
    about.time_s = *time;
    about.has_time = true;
  }
  about.time_sigma_s = number(header, "vam:time_sigma_s").value_or(0);
  if (const auto taken = number(header, "vam:number")) {
    about.number = static_cast<int>(*taken);
    about.has_number = true;
    about.incomplete = number(header, "vam:incomplete").value_or(0) != 0;
  }
  return about;
}

}  // namespace vam::io::exr

bool vam::io::is_own_fact(const std::string& name) {
  constexpr std::array own{
      "vam:kind",   "vam:space",        "vam:units",     "vam:history",    "vam:count",           "vam:pixel_mm",
      "vam:row_mm", "vam:z_mm",         "vam:angle_deg", "vam:index",      "vam:angle_start_deg", "vam:angle_step_deg",
      "vam:time_s", "vam:time_sigma_s", "vam:number",    "vam:incomplete", exr::poses_name,       exr::piece_name};
  return is_seal_key(name) || std::find(own.begin(), own.end(), name) != own.end();
}
