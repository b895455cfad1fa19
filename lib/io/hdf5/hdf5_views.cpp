// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_views.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/hdf5/private/hdf5_tree.hpp"

namespace vam::io::hdf5 {

namespace {

constexpr hssize_t most_views = 1 << 20;

std::string parent_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

std::string first_there(hid_t file, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (open_dataset(file, path)) return path;
  }
  return "";
}

/// Beside the dataset, then below each group that holds it.
std::string find_near(hid_t file, const std::string& path, const std::string& beside,
                      const std::vector<std::string>& below) {
  std::vector<std::string> places{parent_of(path) + beside};
  for (std::string group = parent_of(path); !group.empty(); group = parent_of(group)) {
    for (const std::string& place : below) places.push_back(group + place);
  }
  return first_there(file, places);
}

template <class Value>
std::vector<Value> numbers(hid_t file, const std::string& path, hid_t type, const std::string& name) {
  const Api& h5 = api();
  const Handle dataset = open_dataset(file, path);
  const Handle space(h5.H5Dget_space(dataset.id()));
  const hssize_t count = h5.H5Sget_simple_extent_npoints(space.id());
  if (!describe(dataset.id(), path).holds.empty() || count < 0 || count > most_views) {
    throw Error{Fault::data, name + ": " + printable(path) + " holds no numbers of projections"};
  }
  std::vector<Value> values(static_cast<std::size_t>(count));
  if (count > 0 && h5.H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw Error{Fault::data, name + ": " + printable(path) + " is truncated or damaged" + cause()};
  }
  return values;
}

}  // namespace

Convention convention_of(hid_t file, const std::string& path) {
  Convention found;
  const bool exchange = parent_of(path).ends_with("/exchange");
  found.angles = exchange
                     ? first_there(file, {parent_of(path) + "/theta"})
                     : find_near(file, path, "/rotation_angle", {"/sample/rotation_angle", "/data/rotation_angle"});
  if (!exchange) {
    found.image_keys = find_near(file, path, "/image_key", {"/instrument/detector/image_key", "/data/image_key"});
  }
  found.known = exchange || !found.angles.empty() || !found.image_keys.empty();
  return found;
}

std::vector<double> angles_deg(hid_t file, const std::string& path, const std::string& name) {
  std::vector<double> angles = numbers<double>(file, path, *api().native_double, name);
  const std::string units = text_attribute(open_dataset(file, path).id(), "units");
  if (units.empty() || units == "°" || units.starts_with("deg")) return angles;
  if (units != "rad" && units != "radian" && units != "radians") {
    throw Error{Fault::data, name + ": " + printable(path) + " has the unit " + excerpt(units) +
                                 "; degrees and radians are read; give --view-step"};
  }
  for (double& angle : angles) angle *= deg_per_rad;
  return angles;
}

std::vector<std::size_t> projections(hid_t file, const std::string& path, std::size_t frames, const std::string& name) {
  const std::vector<int> keys = numbers<int>(file, path, *api().native_int, name);
  if (keys.size() != frames) {
    throw Error{Fault::data, name + ": " + printable(path) + " has " + std::to_string(keys.size()) + " keys of " +
                                 std::to_string(frames) + " frames; check --axes"};
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == 0) kept.push_back(i);
  }
  if (kept.empty()) throw Error{Fault::data, name + ": " + printable(path) + " marks no frame as a projection"};
  return kept;
}

}  // namespace vam::io::hdf5
