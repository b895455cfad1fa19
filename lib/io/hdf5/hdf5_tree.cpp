// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_tree.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/hdf5/hdf5_array.hpp"

namespace vam::io::hdf5 {

namespace {

constexpr int most_depth = 32;
constexpr std::size_t most_links = 4096;

std::string kind_of(hid_t type) {
  switch (api().H5Tget_class(type)) {
    case H5T_INTEGER:
    case H5T_FLOAT:
    case H5T_ENUM:  // truth values of h5py
      return "";
    case H5T_STRING:
      return "strings";
    case H5T_COMPOUND:
      return "records of several fields";
    case H5T_REFERENCE:
      return "references";
    case H5T_VLEN:
      return "lists";
    case H5T_ARRAY:
      return "arrays in each place";
    case H5T_OPAQUE:
      return "bytes without a meaning";
    case H5T_BITFIELD:
      return "bits";
    default:
      return "values of an unknown type";
  }
}

class Walk {
 public:
  void visit(hid_t group, const std::string& path, int depth) {
    const Api& h5 = api();
    H5G_info_t about{};
    if (depth > most_depth || h5.H5Gget_info(group, &about) < 0) return;
    const std::string signal = text_attribute(group, "signal");
    const bool shows = text_attribute(group, "NX_class") == "NXdata";
    for (hsize_t i = 0; i < about.nlinks && links_ < most_links; ++i, ++links_) {
      const std::string link = name_of(group, i);
      if (link.empty()) continue;
      const std::string at = path + "/" + link;
      const bool is_signal = shows && link == (signal.empty() ? "data" : signal);
      const Handle object = open_object(group, link);
      H5O_info_t place{};
      if (const std::string target = object ? "" : target_of(group, link); !target.empty()) {
        found.push_back({at, {}, "a link to " + target + ", which is not in the file", is_signal, 0, true});
      }
      if (!object || h5.H5Oget_info2(object.id(), &place, H5O_INFO_BASIC) < 0) continue;
      if (h5.H5Iget_type(object.id()) == H5I_DATASET) {
        Dataset dataset = describe(object.id(), at);
        dataset.is_signal = is_signal;
        dataset.address = place.addr;
        found.push_back(std::move(dataset));
      } else if (h5.H5Iget_type(object.id()) == H5I_GROUP && groups_.insert(place.addr).second) {
        visit(object.id(), at, depth + 1);
      }
    }
  }
  std::vector<Dataset> found;

 private:
  static std::string name_of(hid_t group, hsize_t index) {
    std::array<char, 1024> name{};
    const ssize_t size =
        api().H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, name.data(), name.size(), H5P_DEFAULT);
    return size > 0 && size < static_cast<ssize_t>(name.size()) ? name.data() : "";
  }
  std::set<haddr_t> groups_;  // links may lead back
  std::size_t links_ = 0;
};

std::string text_of(const Dataset& dataset) {
  const std::string shape = shape_text(dataset.shape);
  const std::string about = dataset.holds.empty() ? (shape.empty() ? "one number" : shape) : dataset.holds;
  return printable(dataset.path) + " (" + about + ")";
}

std::string list_of(const std::vector<Dataset>& all) {
  constexpr std::ptrdiff_t most = 8;
  std::vector<std::string> some;
  std::transform(all.begin(), all.begin() + std::min(most, std::ssize(all)), std::back_inserter(some), text_of);
  if (std::ssize(all) > most) some.push_back("and " + std::to_string(std::ssize(all) - most) + " more");
  return all.empty() ? "no datasets" : join(some, ", ");
}

/// Those that differ in more than their path, the first path of each.
template <class Wanted>
std::vector<Dataset> only(const std::vector<Dataset>& all, const Wanted& wanted) {
  std::vector<Dataset> some;
  std::set<std::uint64_t> addresses;
  for (const Dataset& dataset : all) {
    if (wanted(dataset) && addresses.insert(dataset.address).second) some.push_back(dataset);
  }
  return some;
}

/// Throws Fault::data where a link on the way to `path` leads nowhere.
void require_links(hid_t file, const std::string& path, const std::string& name) {
  for (std::size_t begin = 1; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const Handle group = open_object(file, path.substr(0, begin));
    const std::string at = path.substr(0, end);
    const std::string target =
        group && !open_object(file, at) ? target_of(group.id(), path.substr(begin, end - begin)) : "";
    if (!target.empty()) {
      throw Error{Fault::data, name + ": " + printable(at) + " is a link to " + printable(target) +
                                   ", which is not in the file; give a file that holds it"};
    }
    begin = end + 1;
  }
}

bool is_volume(const Dataset& dataset) { return dataset.holds.empty() && dataset.shape.size() == 3; }

}  // namespace

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

Dataset describe(hid_t dataset, const std::string& path) {
  const Api& h5 = api();
  const Handle type(h5.H5Dget_type(dataset));
  const Handle space(h5.H5Dget_space(dataset));
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  const int axes = h5.H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  return {path, {shape.begin(), shape.begin() + std::max(axes, 0)}, kind_of(type.id())};
}

std::vector<Dataset> datasets_of(hid_t file) {
  Walk walk;
  const Handle root = open_object(file, "/");
  if (root) walk.visit(root.id(), "", 0);
  return walk.found;
}

std::string chosen_path(hid_t file, const std::string& named, const std::string& name) {
  if (!named.empty()) {
    std::string path = named.starts_with('/') ? named : "/" + named;
    if (open_dataset(file, path)) return path;
    require_links(file, path, name);
    throw Error{Fault::usage,
                name + ": holds " + list_of(datasets_of(file)) + ", but no dataset is called " + printable(named)};
  }
  const std::vector<Dataset> all = datasets_of(file);
  const std::vector<Dataset> volumes = only(all, is_volume);
  const std::vector<Dataset> signals = only(all, [](const Dataset& d) { return is_volume(d) && d.is_signal; });
  const bool exchange =
      std::any_of(all.begin(), all.end(), [](const Dataset& d) { return is_volume(d) && d.path == "/exchange/data"; });
  if (exchange) return "/exchange/data";
  for (const Dataset& d : all) {  // what the file is there to show must not be replaced by what else it holds
    if (d.is_lost && (d.path == "/exchange/data" || (d.is_signal && signals.empty())))
      require_links(file, d.path, name);
  }
  if (signals.size() == 1) return signals.front().path;
  if (volumes.size() == 1) return volumes.front().path;
  if (all.empty()) {
    throw Error{Fault::data, name + ": has no dataset in " + std::to_string(most_depth) +
                                 " levels of groups with names below 1024 bytes; name one by --array"};
  }
  if (volumes.empty()) {
    throw Error{Fault::data, name + ": has no array of 3 dimensions, but " + list_of(all)};
  }
  throw Error{Fault::usage, name + ": holds " + std::to_string(volumes.size()) + " arrays of 3 dimensions (" +
                                list_of(volumes) + "); name one by --array"};
}

}  // namespace vam::io::hdf5
