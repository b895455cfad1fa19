// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: libhdf5, loaded when the first such file is read: its 40 libraries would take most of the
// start of a tool that only may read arrays. Its headers say what the functions are; nothing is linked.
#pragma once

#include <string>
#include <utility>

#define H5_USE_110_API
#include <hdf5.h>

// Every function of libhdf5 that is called.
// clang-format off
#define VAM_HDF5_FUNCTIONS(X)                                                                                       \
  X(H5Dget_create_plist) X(H5Dget_space) X(H5Dget_space_status) X(H5Dget_type) X(H5Dread) X(H5Eset_auto2)           \
  X(H5Ewalk2) X(H5Fget_create_plist) X(H5Fopen) X(H5Idec_ref) X(H5Iget_type) X(H5Lget_val) X(H5Lunpack_elink_val)   \
  X(H5Lvisit) X(H5Oget_info2) X(H5Oopen) X(H5PLset_loading_state) X(H5Pcreate) X(H5Pget_chunk)                      \
  X(H5Pget_external_count) X(H5Pget_filter2) X(H5Pget_layout) X(H5Pget_nfilters) X(H5Pget_userblock)                \
  X(H5Pset_fapl_core) X(H5Pset_file_image) X(H5Pset_file_image_callbacks) X(H5Rdereference2) X(H5Screate_simple)    \
  X(H5Sget_simple_extent_dims) X(H5Sselect_hyperslab) X(H5Tget_class) X(H5Tget_member_index) X(H5Tget_nmembers)     \
  X(H5Tget_size) X(H5Zfilter_avail) X(H5open)
// clang-format on

namespace vam::io::arrays {

struct Hdf5 {
#define VAM_POINTER(name) decltype(&::name) name;  // NOLINT(bugprone-macro-parentheses): it is declared here
  VAM_HDF5_FUNCTIONS(VAM_POINTER)
#undef VAM_POINTER
  // Set by H5open().
  const hid_t* file_access;
  const hid_t* native_float;
  const hid_t* native_word;
};

/// The one of this process. Throws Fault::absent when the machine does not have the release that this was built with.
const Hdf5& hdf5();

/// A file, group, dataset, type or list of properties; false where it could not be opened.
class Handle {
 public:
  explicit Handle(hid_t id = -1) : id_(id) {}
  ~Handle() {
    if (id_ >= 0) hdf5().H5Idec_ref(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  explicit operator bool() const { return id_ >= 0; }
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
};

/// The innermost cause of the last call that failed, in the library's words, in brackets; empty where it gives none.
[[nodiscard]] std::string hdf5_cause();

}  // namespace vam::io::arrays
