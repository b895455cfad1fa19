// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/hdf5_library.hpp"

#include "base/shared_library.hpp"
#include "base/text/printable.hpp"

namespace vam::io::arrays {

const Hdf5& hdf5() {
  static const Hdf5 loaded = [] {
    const SharedLibrary library("HDF5", VAM_HDF5_LIBRARY, "libhdf5-103-1");
    Hdf5 found{};
#define VAM_FIND(name) library.find(found.name, #name);
    VAM_HDF5_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
    library.find(found.file_access, "H5P_CLS_FILE_ACCESS_ID_g");
    library.find(found.native_float, "H5T_NATIVE_FLOAT_g");
    library.find(found.native_word, "H5T_NATIVE_UINT64_g");
    return found;
  }();
  return loaded;
}

std::string hdf5_cause() {
  std::string words;
  const auto take = [](unsigned depth, const H5E_error2_t* error, void* to) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(to) = error->desc;
    return 0;
  };
  hdf5().H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &words);
  return words.empty() ? "" : " (" + printable(words) + ")";
}

}  // namespace vam::io::arrays
