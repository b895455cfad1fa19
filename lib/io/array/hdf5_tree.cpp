// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/hdf5_tree.hpp"

#include <algorithm>
#include <set>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

namespace {

constexpr const char* exchange = "/exchange/data";
constexpr std::size_t most_text = 4096;

std::string parent_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

/// An object of this file.
Handle opened(hid_t file, const std::string& path) {
  return Handle(hdf5().H5Oopen(file, path.empty() ? "/" : path.c_str(), H5P_DEFAULT));
}

bool is_dataset(const Handle& object) { return object && hdf5().H5Iget_type(object.id()) == H5I_DATASET; }

/// An attribute that is one text; empty where there is none.
std::string text_of(const Handle& object, const char* name) {
  const Hdf5& h5 = hdf5();
  const Handle attribute(h5.H5Aopen(object.id(), name, H5P_DEFAULT));
  const Handle type(h5.H5Aget_type(attribute.id()));
  const Handle space(h5.H5Aget_space(attribute.id()));
  if (h5.H5Tget_class(type.id()) != H5T_STRING || h5.H5Sget_simple_extent_npoints(space.id()) != 1) return "";
  std::string text(most_text, '\0');
  if (h5.H5Tis_variable_str(type.id()) > 0) {
    char* where = nullptr;
    if (h5.H5Aread(attribute.id(), type.id(), &where) < 0 || where == nullptr) return "";
    text = where;
    h5.H5free_memory(where);
  } else if (h5.H5Tget_size(type.id()) >= most_text || h5.H5Aread(attribute.id(), type.id(), text.data()) < 0) {
    return "";
  }
  return trimmed(text.c_str());  // Fortran pads
}

/// Where a link leads that is not in this file: "/entry/data", "/data of the file b.h5".
std::string target_of(hid_t file, const std::string& path, const H5L_info_t& link) {
  std::vector<char> value(link.u.val_size + 1);
  const char* other = nullptr;
  const char* place = value.data();
  hdf5().H5Lget_val(file, path.c_str(), value.data(), link.u.val_size, H5P_DEFAULT);
  if (link.type != H5L_TYPE_EXTERNAL) return place;
  const bool known = hdf5().H5Lunpack_elink_val(value.data(), link.u.val_size, nullptr, &other, &place) >= 0;
  return known ? std::string(place) + " of the file " + other : "another file";
}

herr_t take_link(hid_t file, const char* name, const H5L_info_t* link, void* to) {
  constexpr std::size_t most_datasets = 4096;
  auto& found = *static_cast<std::vector<Dataset>*>(to);
  const std::string path = "/" + std::string(name);
  const Handle object = opened(file, path);
  H5O_info_t place{};
  Dataset about;
  if (is_dataset(object) && hdf5().H5Oget_info2(object.id(), &place, H5O_INFO_BASIC) >= 0) {
    about = describe(object.id(), path);
    about.address = place.addr;
  } else if (!object && link->type != H5L_TYPE_HARD) {
    about = {path, {}, "a link to " + target_of(file, path, *link) + ", which is not in the file"};
    about.is_lost = true;
  } else {
    return 0;
  }
  const Handle group = opened(file, parent_of(path));
  const std::string signal = text_of(group, "signal");
  about.is_signal =
      text_of(group, "NX_class") == "NXdata" && path == parent_of(path) + "/" + (signal.empty() ? "data" : signal);
  found.push_back(std::move(about));
  return found.size() < most_datasets ? 0 : 1;
}

std::string list_of(const std::vector<Dataset>& all) {
  constexpr std::size_t most = 8;
  std::vector<std::string> some;
  for (const Dataset& d : all) {
    some.push_back(printable(d.path) + " (" + (d.holds.empty() ? shape_text(d.shape) : printable(d.holds)) + ")");
  }
  if (all.size() > most) some.resize(most), some.push_back("and " + std::to_string(all.size() - most) + " more");
  return all.empty() ? "no datasets" : join(some, ", ");
}

/// Volumes at different places of the file, the first path of each.
std::vector<Dataset> volumes_of(const std::vector<Dataset>& all, bool signals) {
  std::vector<Dataset> some;
  std::set<haddr_t> addresses;
  for (const Dataset& d : all) {
    const bool wanted = d.holds.empty() && d.shape.size() == 3 && (d.is_signal || !signals);
    if (wanted && addresses.insert(d.address).second) some.push_back(d);
  }
  return some;
}

bool is_bits(hid_t type) {
  const Hdf5& h5 = hdf5();
  return h5.H5Tget_class(type) == H5T_COMPOUND && h5.H5Tget_size(type) == sizeof(BitArray) &&
         h5.H5Tget_nmembers(type) == 3 && h5.H5Tget_member_index(type, "chunks") == 0 &&
         h5.H5Tget_member_index(type, "len") == 1 && h5.H5Tget_member_index(type, "dims") == 2;
}

}  // namespace

Dataset describe(hid_t dataset, const std::string& path) {
  constexpr const char* kinds[] = {"",
                                   "",
                                   "times",
                                   "strings",
                                   "bits",
                                   "bytes without a meaning",
                                   "records of several fields",
                                   "references",
                                   "",
                                   "lists",
                                   "arrays in each place"};
  const Hdf5& h5 = hdf5();
  const Handle type(h5.H5Dget_type(dataset));
  const Handle space(h5.H5Dget_space(dataset));
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  const int axes = h5.H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  const int kind = h5.H5Tget_class(type.id());
  Dataset about{path, {shape.begin(), shape.begin() + std::max(axes, 0)}, "values of an unknown type"};
  if (kind >= 0 && kind < static_cast<int>(std::size(kinds))) about.holds = kinds[kind];
  if (axes == 0 && is_bits(type.id()) &&
      h5.H5Dread(dataset, type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &about.bits) >= 0) {
    about.holds.clear();
    about.shape.assign(about.bits.sizes.rbegin(), about.bits.sizes.rend());
  }
  return about;
}

std::string chosen_path(hid_t file, const std::string& named, const std::string& name) {
  const std::string wanted = named.empty() ? exchange : named.starts_with('/') ? named : "/" + named;
  if (!named.empty() && is_dataset(opened(file, wanted))) return wanted;
  std::vector<Dataset> all;
  hdf5().H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, take_link, &all);
  const std::vector<Dataset> volumes = volumes_of(all, false);
  const std::vector<Dataset> signals = volumes_of(all, true);
  for (const Dataset& d : all) {
    if (named.empty() && d.path == exchange && d.holds.empty() && d.shape.size() == 3) return exchange;
  }
  for (const Dataset& d : all) {  // what the file is there to show must not be replaced by what else it holds
    const bool shown = named.empty() && d.is_signal && signals.empty();
    if (!d.is_lost || !(shown || (wanted + "/").starts_with(d.path + "/"))) continue;
    throw Error{Fault::data,
                name + ": " + printable(d.path) + " is " + printable(d.holds) + "; give a file that holds it"};
  }
  if (!named.empty()) {
    throw Error{Fault::usage, name + ": holds " + list_of(all) + ", but no dataset is called " + printable(named)};
  }
  if (signals.size() == 1) return signals.front().path;
  if (volumes.size() == 1) return volumes.front().path;
  if (volumes.empty()) throw Error{Fault::data, name + ": has no array of 3 dimensions, but " + list_of(all)};
  throw Error{Fault::usage, name + ": holds " + std::to_string(volumes.size()) + " arrays of 3 dimensions (" +
                                list_of(volumes) + "); name one by --array"};
}

Convention convention_of(hid_t file, const std::string& path) {
  const auto first_of = [&](const std::string& beside, const std::vector<std::string>& below) {
    std::vector<std::string> places{parent_of(path) + beside};
    for (std::string group = parent_of(path); !group.empty(); group = parent_of(group)) {
      for (const std::string& place : below) places.push_back(group + place);
    }
    for (const std::string& place : places) {
      if (is_dataset(opened(file, place))) return place;
    }
    return std::string();
  };
  if (parent_of(path).ends_with("/exchange")) return {true, first_of("/theta", {}), ""};
  Convention found;
  found.angles = first_of("/rotation_angle", {"/sample/rotation_angle", "/data/rotation_angle"});
  found.image_keys = first_of("/image_key", {"/instrument/detector/image_key", "/data/image_key"});
  found.known = !found.angles.empty() || !found.image_keys.empty();
  return found;
}

std::vector<double> numbers_of(hid_t file, const std::string& path, const std::string& name) {
  constexpr hssize_t most_views = 1 << 20;
  const Hdf5& h5 = hdf5();
  const std::string subject = name + ": " + printable(path);
  const Handle dataset = opened(file, path);
  const Handle space(h5.H5Dget_space(dataset.id()));
  const hssize_t count = h5.H5Sget_simple_extent_npoints(space.id());
  if (!describe(dataset.id(), path).holds.empty() || count < 0 || count > most_views) {
    throw Error{Fault::data, subject + " holds no numbers of projections"};
  }
  std::vector<double> values(static_cast<std::size_t>(count));
  if (count > 0 && h5.H5Dread(dataset.id(), *h5.native_double, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw Error{Fault::data, subject + " is truncated or damaged" + hdf5_cause()};
  }
  const std::string units = text_of(dataset, "units");
  const bool radians = units == "rad" || units == "radian" || units == "radians";
  if (!radians && !units.empty() && units != "°" && !units.starts_with("deg")) {
    throw Error{Fault::data,
                subject + " has the unit " + excerpt(units) + "; degrees and radians are read; give --view-step"};
  }
  for (double& value : values) value *= radians ? deg_per_rad : 1;
  return values;
}

}  // namespace vam::io::arrays
