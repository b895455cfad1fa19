// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/hdf5_tree.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

namespace {

/// An object of this file.
Handle opened(hid_t file, const std::string& path) { return Handle(hdf5().H5Oopen(file, path.c_str(), H5P_DEFAULT)); }

bool is_dataset(const Handle& object) { return object && hdf5().H5Iget_type(object.id()) == H5I_DATASET; }

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
std::vector<Dataset> volumes_of(const std::vector<Dataset>& all) {
  std::vector<Dataset> some;
  std::set<haddr_t> addresses;
  for (const Dataset& d : all) {
    if (d.holds.empty() && d.shape.size() == 3 && addresses.insert(d.address).second) some.push_back(d);
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
  std::string wanted = named.starts_with('/') ? named : "/" + named;
  if (!named.empty() && is_dataset(opened(file, wanted))) return wanted;
  std::vector<Dataset> all;
  hdf5().H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, take_link, &all);
  for (const Dataset& d : all) {
    if (named.empty() || !d.is_lost || !(wanted + "/").starts_with(d.path + "/")) continue;
    throw Error{Fault::data,
                name + ": " + printable(d.path) + " is " + printable(d.holds) + "; give a file that holds it"};
  }
  if (!named.empty()) {
    throw Error{Fault::usage, name + ": holds " + list_of(all) + ", but no dataset is called " + printable(named)};
  }
  const std::vector<Dataset> volumes = volumes_of(all);
  if (volumes.size() == 1) return volumes.front().path;
  if (volumes.empty()) throw Error{Fault::data, name + ": has no array of 3 dimensions, but " + list_of(all)};
  throw Error{Fault::usage, name + ": holds " + std::to_string(volumes.size()) + " arrays of 3 dimensions (" +
                                list_of(volumes) + "); name one by --array"};
}

}  // namespace vam::io::arrays
