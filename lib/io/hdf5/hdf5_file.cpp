// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <new>

#include "base/error.hpp"

namespace vam::io::hdf5 {

namespace {

/// A file of the library's, as its drivers begin with it.
struct Open {
  H5FD_t base;
  const Hdf5Bytes* bytes;
  haddr_t used;  // up to where the library addresses it
};

const Open& of(const H5FD_t* file) { return *reinterpret_cast<const Open*>(file); }
Open& of(H5FD_t* file) { return *reinterpret_cast<Open*>(file); }

struct Info {
  const Hdf5Bytes* bytes;
  const Open** opened;
};

H5FD_t* open_bytes(const char* /*name*/, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
  const auto* info = static_cast<const Info*>(api().H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  auto* open = new (std::nothrow) Open{{}, info->bytes, 0};
  *info->opened = open;
  return open == nullptr ? nullptr : &open->base;
}

herr_t close_bytes(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t* /*file*/, unsigned long* flags) {
  *flags = H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_ACCUMULATE_METADATA;
  return 0;
}

haddr_t get_used(const H5FD_t* file, H5FD_mem_t /*type*/) { return of(file).used; }
herr_t set_used(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t used) {
  of(file).used = used;
  return 0;
}
haddr_t get_end(const H5FD_t* file, H5FD_mem_t /*type*/) { return of(file).bytes->size; }

bool read_at(int descriptor, std::uint64_t at, char* to, std::size_t size) {
  if (lseek(descriptor, static_cast<off_t>(at), SEEK_SET) < 0) return false;
  while (size > 0) {
    const ssize_t got = read(descriptor, to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

herr_t read_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t at, std::size_t size, void* to) {
  const Hdf5Bytes& bytes = *of(file).bytes;
  if (at > bytes.size) return -1;
  const std::size_t there = std::min<std::uint64_t>(size, bytes.size - at);
  if (bytes.memory != nullptr) {
    std::memcpy(to, bytes.memory + at, there);
  } else if (!read_at(bytes.descriptor, at, static_cast<char*>(to), there)) {
    return -1;
  }
  std::memset(static_cast<char*>(to) + there, 0, size - there);  // as the library's own drivers do
  return 0;
}

herr_t refuse_to_write(H5FD_t* /*file*/, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t /*at*/, std::size_t /*size*/,
                       const void* /*from*/) {
  return -1;
}

const H5FD_class_t& driver() {
  static const H5FD_class_t made = [] {
    constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
    H5FD_class_t about{};
    about.name = "bytes";
    about.maxaddr = (haddr_t{1} << 62) - 1;
    about.fc_degree = H5F_CLOSE_WEAK;
    about.fapl_size = sizeof(Info);
    about.open = open_bytes;
    about.close = close_bytes;
    about.query = query;
    about.get_eoa = get_used;
    about.set_eoa = set_used;
    about.get_eof = get_end;
    about.read = read_bytes;
    about.write = refuse_to_write;
    std::copy(std::begin(map), std::end(map), std::begin(about.fl_map));
    return about;
  }();
  return made;
}

}  // namespace

Handle open_file(const Hdf5Bytes& bytes, const std::string& name) {
  const Api& h5 = api();
  if (h5.H5open() < 0) throw Error{Fault::bug, name + ": HDF5 does not start"};
  h5.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  h5.H5PLset_loading_state(0);
  static const hid_t registered = h5.H5FDregister(&driver());
  const Handle access(h5.H5Pcreate(*h5.file_access));
  const Open* opened = nullptr;
  const Info info{&bytes, &opened};
  if (registered < 0 || h5.H5Pset_driver(access.id(), registered, &info) < 0) {
    throw Error{Fault::bug, name + ": HDF5 does not start" + cause()};
  }
  constexpr unsigned read_only = 0;  // H5F_ACC_RDONLY is a call that is not linked
  Handle file(h5.H5Fopen(name.c_str(), read_only, access.id()));
  if (!file) {
    throw Error{Fault::data, name + ": the HDF5 file is truncated, damaged or still being written" + cause()};
  }
  // Which the library takes from the superblock, counted from the beginning of the file, a user block included.
  if (opened != nullptr && bytes.size > opened->used) {
    throw Error{Fault::data, name + ": has " + std::to_string(bytes.size - opened->used) +
                                 " bytes behind the end that its HDF5 superblock states; it is damaged, or more was "
                                 "appended"};
  }
  return file;
}

}  // namespace vam::io::hdf5
