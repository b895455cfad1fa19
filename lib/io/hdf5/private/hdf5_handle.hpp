// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the HDF5 files: what libhdf5 has opened, closed at the end; and why it did not.
#pragma once

#include <string>
#include <utility>

#include "io/hdf5/private/hdf5_library.hpp"

namespace vam::io::hdf5 {

/// A file, group, dataset, type or list of properties; false where it could not be opened.
class Handle {
 public:
  explicit Handle(hid_t id = -1) : id_(id) {}
  ~Handle() {
    if (id_ >= 0) api().H5Idec_ref(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  explicit operator bool() const { return id_ >= 0; }
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
};

/// The innermost cause of the last call that failed, in the library's words, in brackets; empty where it gives none.
[[nodiscard]] std::string cause();

/// An attribute that is one text; empty where there is none.
[[nodiscard]] std::string text_attribute(hid_t object, const char* name);

/// Where a link in a group leads: "/entry/data", "/data of the file b.h5"; empty where it is the object itself, or
/// none.
[[nodiscard]] std::string target_of(hid_t group, const std::string& link);

/// "/exchange/data", below a file or group: false where there is no such object in this file.
[[nodiscard]] Handle open_object(hid_t parent, const std::string& path);
/// The same; false also where it is no dataset.
[[nodiscard]] Handle open_dataset(hid_t parent, const std::string& path);

}  // namespace vam::io::hdf5
