// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF: the objects of a package, placed as its build says. What they expand to is counted before it is made.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/model_part.hpp"
#include "io/zip/zip_archive.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t max_points = std::uint64_t{1} << 26;
constexpr std::uint64_t point_bytes = 24;
constexpr std::uint64_t triangle_bytes = 68;                    // as a face of a soup and as a triangle
constexpr std::uint64_t room_bytes = std::uint64_t{160} << 20;  // of what the child may take: sandboxed_reader.hpp
constexpr std::uint64_t room_ratio = 48;
constexpr std::uint64_t most_unpacked = std::uint64_t{64} << 20;  // and as often what the archive has
constexpr std::uint64_t most_ratio = 64;
constexpr std::uint64_t plenty = std::uint64_t{1} << 40;  // sums end here, before they overflow
constexpr int max_depth = 64;

// Of an object with all its components.
struct Expanded {
  std::uint64_t triangles = 0;
  std::uint64_t points = 0;
  std::uint64_t instances = 1;
  bool open = true;  // it is being counted: met again, it contains itself
};

std::string without_slash(const std::string& path) { return path.starts_with('/') ? path.substr(1) : path; }

class Package {
 public:
  explicit Package(std::string_view bytes)
      : archive_(bytes, "3MF", true),
        room_(room_bytes + room_ratio * bytes.size()),
        left_(most_unpacked + most_ratio * bytes.size()) {
    if (archive_.has("_rels/.rels")) {
      root_ = without_slash(model_target([&](const auto& take) { read("_rels/.rels", take); }));
    }
    for (const std::string& name : archive_.names()) {
      if (root_.empty() && name.ends_with(".model")) root_ = name;
    }
    if (root_.empty()) throw MeshProblem{"not a 3MF file: the zip archive has no 3D model"};
    for (const char* settings : {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
      if (!archive_.has(settings) || !volumes_.empty()) continue;
      for (VolumeType& volume : parse_volume_types([&](const auto& take) { read(settings, take); }))
        volumes_[volume.object].push_back(std::move(volume));
    }
  }

  PolygonSoup placed() {
    Expanded all{0, 0, 0, false};
    const std::vector<Instance>& build = part(root_).build;
    if (build.empty()) throw MeshProblem{"its build has no item; there is nothing to print"};
    for (const Instance& item : build) add(all, expanded(root_, item, 0));
    require_room(all);
    soup_.points.reserve(all.points);
    soup_.faces.reserve(all.triangles);
    for (const Instance& item : build) place(root_, item, {}, Role::added);
    if (soup_.faces.empty() && ignored_) throw MeshProblem{"its build has supports only, and no part"};
    if (!taken_away_.empty() && build.size() > 1)
      throw MeshProblem{"has a negative volume, and more items than the one it is of; export it as a plain mesh"};
    soup_.taken_away = taken_away_.size();
    soup_.faces.insert(soup_.faces.end(), taken_away_.begin(), taken_away_.end());
    return std::move(soup_);
  }

 private:
  // Passes a file by, unpacked.
  void read(const std::string& name, const std::function<void(std::string_view)>& take) {
    archive_.open(name);
    std::vector<char> piece(std::size_t{1} << 16);
    while (const std::size_t got = archive_.read(piece.data(), piece.size())) {
      if (got > left_) {
        throw MeshProblem{"unpacks to more than 64 MiB and 64 times its size; it is damaged, or save it as STL"};
      }
      left_ -= got;
      take({piece.data(), got});
    }
  }

  void require_room(const Expanded& all) const {
    const std::string expands = "its components expand to " + number(all.instances) + " objects of " +
                                number(all.triangles) + " triangles and " + number(all.points) + " vertices; ";
    if (all.triangles > max_triangles || all.points > max_points || all.instances > max_instances) {
      throw MeshProblem{expands + "up to " + number(max_instances) + ", " + number(max_triangles) + " and " +
                        number(max_points) + " are read; save it as a plain mesh (STL)"};
    }
    const std::uint64_t needed = all.triangles * triangle_bytes + all.points * point_bytes;
    if (needed <= room_) return;
    throw MeshProblem{expands + "they need " + in_gib(static_cast<double>(needed)) +
                      " of memory, and those of a file of " + "its size may take " +
                      in_gib(static_cast<double>(room_)) + "; save it as a plain mesh (STL)"};
  }
  static std::string number(std::uint64_t count) { return count >= plenty ? "more than 10^12" : std::to_string(count); }

  const ModelPart& part(const std::string& name) {
    const auto known = parts_.find(name);
    if (known != parts_.end()) return known->second;
    return parts_[name] = parse_model_part([&](const auto& take) { read(name, take); });
  }
  static std::string part_name(const std::string& from, const Instance& instance) {
    return instance.part.empty() ? from : without_slash(instance.part);
  }
  const Object3mf& object(const std::string& name, unsigned id) {
    const ModelPart& owner = part(name);
    const auto found = owner.objects.find(id);
    if (found == owner.objects.end()) {
      throw MeshProblem{"refers to object " + std::to_string(id) + ", which " + name + " does not have; save it again"};
    }
    return found->second;
  }

  static void add(Expanded& sum, const Expanded& more) {
    sum.triangles = std::min(sum.triangles + more.triangles, plenty);
    sum.points = std::min(sum.points + more.points, plenty);
    sum.instances = std::min(sum.instances + more.instances, plenty);
  }

  const Expanded& expanded(const std::string& from, const Instance& instance, int depth) {
    const std::string name = part_name(from, instance);
    const std::string which = "object " + std::to_string(instance.object);
    const auto [place, fresh] = counted_.try_emplace({name, instance.object});
    Expanded& count = place->second;
    if (!fresh && count.open) throw MeshProblem{which + " is a component of itself; mend it, or save the mesh again"};
    if (!fresh) return count;
    if (depth > max_depth)
      throw MeshProblem{"its components are nested deeper than " + std::to_string(max_depth) +
                        "; save it as a plain mesh (STL)"};
    const Object3mf& made_of = object(name, instance.object);
    count.triangles = made_of.triangles.size();
    count.points = made_of.points.size();
    for (const Instance& component : made_of.components) add(count, expanded(name, component, depth + 1));
    count.open = false;
    return count;
  }

  // What a volume of this type is for within one of that role.
  static Role within(Role outer, const std::string& type, const std::string& which) {
    const Role own = role_of(type);
    if (outer == Role::ignored || own == Role::added) return outer;
    if (own != Role::refused) return own;
    throw MeshProblem{which + " is of type " + excerpt(type) + ", which is not printed; export it as a plain mesh"};
  }

  /// What the slicer has made of component n, by its place, or where not each is named by its object; none: by its
  /// type.
  std::optional<Role> stated(const std::vector<VolumeType>& parts, const std::vector<Instance>& components,
                             std::size_t n, Role outer, const std::string& which) const {
    std::optional<Role> role;
    const bool each = parts.size() == components.size() && parts[n].component == components[n].object;
    for (const VolumeType& part : each ? std::vector{parts[n]} : parts) {
      if (part.component != components[n].object) continue;
      const Role own = within(outer, part.type, which);
      if (role && *role != own) throw MeshProblem{which + " has a component of two types; export it as a plain mesh"};
      role = own;
    }
    return role;
  }

  void place(const std::string& from, const Instance& instance, const ComponentPlacement& outer, Role role,
             bool is_stated = false) {
    const std::string name = part_name(from, instance);
    const std::string which = "object " + std::to_string(instance.object);
    const Object3mf& made_of = object(name, instance.object);
    if (made_of.components.empty() && !is_stated) role = within(role, made_of.type, which);
    if (role != Role::ignored && !made_of.problem.empty())
      throw MeshProblem{which + " " + made_of.problem + "; export it as a plain mesh"};
    const ComponentPlacement placement = instance.placement.then(outer);
    const bool mirrored = placement.mirrors();  // 3MF core specification, 4.1: the outside stays outside
    const int first = count_of(soup_.points);
    const int last = count_of(made_of.points);
    for (const auto& point : made_of.points) soup_.points.push_back(placement(point));
    std::vector<Role> roles(made_of.triangles.size(), role);
    std::vector<VolumeType> parts;  // its components
    for (const VolumeType& volume : name == root_ ? volumes_[instance.object] : std::vector<VolumeType>{}) {
      if (volume.component != 0) parts.push_back(volume);
      if (volume.component != 0) continue;
      const Role own = within(role, volume.type, which);
      for (std::size_t t = volume.first; t <= volume.last && t < roles.size(); ++t) roles[t] = own;
    }
    for (std::size_t t = 0; t < roles.size(); ++t) {
      auto [a, b, c] = made_of.triangles[t];
      for (const int corner : {a, b, c}) {
        if (corner >= 0 && corner < last) continue;
        throw MeshProblem{which + " uses vertex " + std::to_string(corner) + " of " + std::to_string(last) +
                          " (counted from 0); mend it, or save the mesh again"};
      }
      if (mirrored) std::swap(b, c);
      ignored_ = ignored_ || roles[t] == Role::ignored;
      if (roles[t] == Role::added) soup_.faces.push_back({first + a, first + b, first + c});
      if (roles[t] == Role::taken_away) taken_away_.push_back({first + a, first + b, first + c});
    }
    for (std::size_t n = 0; n < made_of.components.size(); ++n) {
      const std::optional<Role> own = stated(parts, made_of.components, n, role, which);
      place(name, made_of.components[n], placement, own.value_or(role), own.has_value());
    }
  }

  ZipArchive archive_;
  std::uint64_t room_;  // bytes for what the components expand to
  std::uint64_t left_;  // bytes that may yet be unpacked
  std::string root_;
  std::map<std::string, ModelPart> parts_;
  std::map<std::pair<std::string, unsigned>, Expanded> counted_;
  std::map<unsigned, std::vector<VolumeType>> volumes_;  // of slicers, by objects of the root part
  bool ignored_ = false;                                 // something was
  std::vector<std::vector<int>> taken_away_;             // faces
  PolygonSoup soup_;
};

}  // namespace

Vector3 ComponentPlacement::operator()(const Vector3& p) const {
  return rows[3] + p[0] * rows[0] + p[1] * rows[1] + p[2] * rows[2];
}

ComponentPlacement ComponentPlacement::then(const ComponentPlacement& outer) const {
  ComponentPlacement turn = outer;
  turn.rows[3] = {};
  return {{turn(rows[0]), turn(rows[1]), turn(rows[2]), outer(rows[3])}};
}

bool ComponentPlacement::mirrors() const { return dot(rows[0], cross(rows[1], rows[2])) < 0; }

PolygonSoup parse_3mf(const std::string& bytes) { return Package(bytes).placed(); }

}  // namespace vam::io
