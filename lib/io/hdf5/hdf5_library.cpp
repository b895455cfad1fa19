// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hdf5/private/hdf5_library.hpp"

#include "base/shared_library.hpp"

namespace vam::io::hdf5 {

namespace {

Api load() {
  const SharedLibrary library("HDF5", VAM_HDF5_LIBRARY, "libhdf5-103-1");
  Api found{};
#define VAM_FIND(name) library.find(found.name, #name);
  VAM_HDF5_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
  library.find(found.file_access, "H5P_CLS_FILE_ACCESS_ID_g");
  library.find(found.native_int, "H5T_NATIVE_INT_g");
  library.find(found.native_float, "H5T_NATIVE_FLOAT_g");
  library.find(found.native_double, "H5T_NATIVE_DOUBLE_g");
  return found;
}

}  // namespace

const Api& api() {
  static const Api loaded = load();
  return loaded;
}

}  // namespace vam::io::hdf5
