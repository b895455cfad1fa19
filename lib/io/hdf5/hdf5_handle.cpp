// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_handle.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "base/text/printable.hpp"

namespace vam::io::hdf5 {

namespace {

constexpr std::size_t most_text = 4096;

herr_t take_cause(unsigned depth, const H5E_error2_t* error, void* to) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(to) = error->desc;
  return 0;
}

}  // namespace

std::string cause() {
  std::string words;
  api().H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_cause, &words);
  return words.empty() ? "" : " (" + printable(words.substr(0, most_text)) + ")";
}

std::string text_attribute(hid_t object, const char* name) {
  const Api& h5 = api();
  if (h5.H5Aexists(object, name) <= 0) return "";
  const Handle attribute(h5.H5Aopen(object, name, H5P_DEFAULT));
  if (!attribute) return "";
  const Handle type(h5.H5Aget_type(attribute.id()));
  const Handle space(h5.H5Aget_space(attribute.id()));
  if (h5.H5Tget_class(type.id()) != H5T_STRING || h5.H5Sget_simple_extent_npoints(space.id()) != 1) return "";
  if (h5.H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    if (h5.H5Aread(attribute.id(), type.id(), &text) < 0 || text == nullptr) return "";
    std::string copy(text, strnlen(text, most_text));
    h5.H5free_memory(text);
    return copy;
  }
  const std::size_t size = h5.H5Tget_size(type.id());
  if (size == 0 || size > most_text) return "";
  std::vector<char> text(size + 1, '\0');
  if (h5.H5Aread(attribute.id(), type.id(), text.data()) < 0) return "";
  std::string copy(text.data());
  copy.erase(copy.find_last_not_of(' ') + 1);  // Fortran's padding
  return copy;
}

std::string target_of(hid_t group, const std::string& link) {
  std::array<char, most_text> value{};  // a path; or flags, of which there are none, a file and a path in it
  if (api().H5Lget_val(group, link.c_str(), value.data(), value.size() - 2, H5P_DEFAULT) < 0) return "";
  if (value[0] != 0) return value.data();
  const std::string file = value.data() + 1;
  return file.empty()
             ? ""
             : std::string(value.data() + std::min(file.size() + 2, value.size() - 1)) + " of the file " + file;
}

Handle open_object(hid_t parent, const std::string& path) {
  return Handle(api().H5Oopen(parent, path.c_str(), H5P_DEFAULT));
}

Handle open_dataset(hid_t parent, const std::string& path) {
  Handle object = open_object(parent, path);
  return object && api().H5Iget_type(object.id()) == H5I_DATASET ? std::move(object) : Handle();
}

}  // namespace vam::io::hdf5
