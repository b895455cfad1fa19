// SPDX-License-Identifier: GPL-3.0-or-later
// A dataset of an HDF5 file by libhdf5, which is loaded when the first is read: its 40 libraries would take most of the
// start of a tool that only may read arrays. Its headers say what the functions are; nothing is linked.
#define H5_USE_110_API

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/shared_library.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/array/private/array.hpp"

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

namespace {

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
std::string hdf5_cause() {
  std::string words;
  const auto take = [](unsigned depth, const H5E_error2_t* error, void* to) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(to) = error->desc;
    return 0;
  };
  hdf5().H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &words);
  return words.empty() ? "" : " (" + printable(words) + ")";
}

/// A Julia BitArray of 3 dimensions as JLD2 stores it: one record, its words in a dataset of their own. Bit i, from the
/// lowest, of word w is value 64 w + i; the first dimension is the fastest.
struct BitArray {
  hobj_ref_t words = 0;
  std::int64_t length = 0;
  std::array<std::int64_t, 3> sizes{};  // the fastest first
};

struct Dataset {
  std::string path;
  std::vector<std::uint64_t> shape{};
  std::string holds{};   // "strings", "a link to /a, ...": where these are no numbers
  BitArray bits{};       // words: 0 where it is none
  bool is_lost = false;  // a link to what is not in the file
  haddr_t address = 0;   // one place in the file may have several paths
};

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

bool is_bits(hid_t type) {
  const Hdf5& h5 = hdf5();
  return h5.H5Tget_class(type) == H5T_COMPOUND && h5.H5Tget_size(type) == sizeof(BitArray) &&
         h5.H5Tget_nmembers(type) == 3 && h5.H5Tget_member_index(type, "chunks") == 0 &&
         h5.H5Tget_member_index(type, "len") == 1 && h5.H5Tget_member_index(type, "dims") == 2;
}

/// Shape and type of an open dataset.
Dataset describe(hid_t dataset, const std::string& path) {
  const Hdf5& h5 = hdf5();
  const Handle type(h5.H5Dget_type(dataset));
  const Handle space(h5.H5Dget_space(dataset));
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  const int axes = h5.H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  const int kind = h5.H5Tget_class(type.id());
  Dataset about{path, {shape.begin(), shape.begin() + std::max(axes, 0)}, "values of another kind"};
  if (kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM) about.holds.clear();
  if (kind == H5T_STRING) about.holds = "strings";
  if (kind == H5T_COMPOUND) about.holds = "records of several fields";
  if (axes == 0 && is_bits(type.id()) &&
      h5.H5Dread(dataset, type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &about.bits) >= 0) {
    about.holds.clear();
    about.shape.assign(about.bits.sizes.rbegin(), about.bits.sizes.rend());
  }
  return about;
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

/// The one meant: the named one; else the only one of 3 dimensions.
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

constexpr std::uint64_t enough = std::uint64_t{1} << 26;  // bytes read together where more would gain nothing

/// The end of the file that its superblock states, from the first byte on; the superblock is at `begin`.
std::uint64_t stated_end(std::string_view bytes, std::size_t begin) {
  const auto number = [&](std::size_t n) { return std::size_t{static_cast<unsigned char>(bytes[begin + n])}; };
  const bool old = number(8) < 2;
  const std::size_t width = number(old ? 13 : 9);
  const std::size_t at = begin + (old ? 24 + 4 * number(8) : 12);
  const auto address = [&](std::size_t n) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at + n * width, std::min(width, sizeof value));
    return value;
  };
  return begin + address(2) - address(0);
}

/// A file whose bytes are at hand, as the process that parses it may open none: they are neither copied nor written.
Handle opened_file(std::string_view bytes, const std::string& name) {
  const Hdf5& h5 = hdf5();
  h5.H5open();
  h5.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // nothing is said on stderr
  h5.H5PLset_loading_state(0);                     // no plugins
  const Handle access(h5.H5Pcreate(*h5.file_access));
  H5FD_file_image_callbacks_t lent{};
  lent.image_malloc = [](std::size_t, H5FD_file_image_op_t, void* there) { return there; };
  lent.image_memcpy = [](void* to, const void*, std::size_t, H5FD_file_image_op_t, void*) { return to; };
  lent.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  lent.udata_copy = [](void* there) { return there; };
  lent.udata_free = [](void*) -> herr_t { return 0; };
  lent.udata = const_cast<char*>(bytes.data());
  h5.H5Pset_fapl_core(access.id(), 1, false);
  h5.H5Pset_file_image_callbacks(access.id(), &lent);
  h5.H5Pset_file_image(access.id(), lent.udata, bytes.size());
  Handle file(h5.H5Fopen("bytes", 0, access.id()));
  if (!file) {
    throw Error{Fault::data, name + ": the HDF5 file is truncated, damaged or still being written" + hdf5_cause()};
  }
  const Handle creation(h5.H5Fget_create_plist(file.id()));
  hsize_t begin = 0;
  h5.H5Pget_userblock(creation.id(), &begin);
  const std::uint64_t end = stated_end(bytes, begin);
  if (bytes.size() <= end) return file;
  throw Error{Fault::data, name + ": has " + std::to_string(bytes.size() - end) +
                               " bytes behind the end that its HDF5 superblock states; it is damaged, or more was "
                               "appended"};
}

/// Throws Fault::data for values that are in other files, packed by no known filter, or were never written, which
/// would be read as zeros.
void require_values(hid_t dataset, hid_t properties, const std::string& subject) {
  const Hdf5& h5 = hdf5();
  if (h5.H5Pget_layout(properties) == H5D_VIRTUAL || h5.H5Pget_external_count(properties) > 0) {
    throw Error{Fault::data, subject + " has its values in other files; copy them into one"};
  }
  for (int i = 0; i < h5.H5Pget_nfilters(properties); ++i) {
    unsigned ignored = 0;
    std::size_t values = 0;
    std::array<char, 64> title{};
    const H5Z_filter_t filter = h5.H5Pget_filter2(properties, static_cast<unsigned>(i), &ignored, &values, nullptr,
                                                  title.size() - 1, title.data(), &ignored);
    if (filter >= 0 && h5.H5Zfilter_avail(filter) > 0) continue;
    const std::string which = title[0] == '\0' ? "filter " + std::to_string(filter) : printable(title.data());
    throw Error{Fault::data, subject + " is packed by " + which +
                                 ", which is not read; save it unpacked, or packed by gzip, with the program that "
                                 "wrote it"};
  }
  H5D_space_status_t status{};
  if (h5.H5Dget_space_status(dataset, &status) >= 0 && status == H5D_SPACE_STATUS_NOT_ALLOCATED) {
    throw Error{Fault::data, subject + " has no values; the program that wrote it did not finish"};
  }
}

/// The values of a dataset in its own order, as floats.
struct Values {
  Values(std::string_view bytes, const std::string& wanted, const std::string& name) : file(opened_file(bytes, name)) {
    const std::string path = chosen_path(file.id(), wanted, name);
    subject = name + ": " + printable(path);
    dataset = Handle(hdf5().H5Oopen(file.id(), path.c_str(), H5P_DEFAULT));
    const Dataset about = describe(dataset.id(), path);
    if (!about.holds.empty()) fail(" holds " + about.holds + ", not numbers");
    try {
      set_shape(about.shape, head);
    } catch (const std::runtime_error& problem) {
      fail(std::string(" ") + problem.what());
    }
    shape = about.shape;
    if (about.bits.words != 0) take_words(about.bits);
    const Handle properties(hdf5().H5Dget_create_plist(dataset.id()));
    require_values(dataset.id(), properties.id(), subject);
    // A chunk is unpacked once where as many planes as it is deep are read together.
    std::vector<hsize_t> chunk(shape.size(), 1);
    if (words.empty()) hdf5().H5Pget_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data());
    const std::uint64_t plane_bytes = head.values() / shape[0] * sizeof(float);
    depth = std::min(std::max({enough / plane_bytes, std::uint64_t{chunk[0]}, std::uint64_t{1}}), shape[0]);
    if (depth > chunk[0]) depth -= depth % std::max<hsize_t>(chunk[0], 1);
  }

  [[noreturn]] void fail(const std::string& why) const { throw Error{Fault::data, subject + why}; }
  [[noreturn]] void damaged() const { fail(" is truncated or damaged" + hdf5_cause()); }

  /// Of a BitArray, which from here on stand for the dataset.
  void take_words(const BitArray& bits) {
    const Hdf5& h5 = hdf5();
    const std::vector<std::uint64_t> count{(head.values() + 63) / 64};
    dataset = Handle(h5.H5Rdereference2(dataset.id(), H5P_DEFAULT, H5R_OBJECT, &bits.words));
    if (static_cast<std::uint64_t>(bits.length) != head.values() || describe(dataset.id(), "").shape != count)
      fail(" has another number of bits than its sizes; it is damaged");
    words.resize(count[0]);
    if (h5.H5Dread(dataset.id(), *h5.native_word, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data()) < 0) damaged();
  }

  /// The next planes of the first axis; false after the last.
  bool next() {
    const Hdf5& h5 = hdf5();
    std::vector<hsize_t> start(shape.size()), count(shape.begin(), shape.end());
    start[0] = done;
    count[0] = std::min(depth, shape[0] - done);
    const std::uint64_t plane = head.values() / shape[0];
    block.resize(count[0] * plane);
    used = 0;
    done += count[0];
    if (block.empty()) return false;
    if (!words.empty()) {
      for (std::uint64_t i = 0, from = start[0] * plane; i < block.size(); ++i)
        block[i] = static_cast<float>(words[(from + i) / 64] >> (from + i) % 64 & 1);
      return true;
    }
    const Handle from(h5.H5Dget_space(dataset.id()));
    const Handle to(h5.H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr));
    const herr_t chosen =
        h5.H5Sselect_hyperslab(from.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    if (chosen < 0 || h5.H5Dread(dataset.id(), *h5.native_float, to.id(), from.id(), H5P_DEFAULT, block.data()) < 0)
      damaged();
    return true;
  }

  std::size_t read(void* to, std::size_t size) {
    std::size_t got = 0;
    while (got < size && (used < block.size() * sizeof(float) || next())) {
      const std::size_t step = std::min(size - got, block.size() * sizeof(float) - used);
      std::memcpy(static_cast<char*>(to) + got, reinterpret_cast<const char*>(block.data()) + used, step);
      used += step;
      got += step;
    }
    return got;
  }

  Handle file;
  Handle dataset;
  std::string subject;
  Head head;
  std::vector<std::uint64_t> shape;  // of the dataset
  std::vector<std::uint64_t> words;  // of a BitArray
  std::uint64_t depth = 1;           // planes read together
  std::uint64_t done = 0;            // of them
  std::vector<float> block;
  std::size_t used = 0;  // bytes of it
};

}  // namespace

void load_hdf5() { (void)hdf5(); }

Bytes open_hdf5(std::string_view bytes, const std::string& wanted, const std::string& name, Head& head) {
  auto values = std::make_shared<Values>(bytes, wanted, name);
  head = values->head;
  return Bytes([values](void* to, std::size_t size) { return values->read(to, size); });
}

}  // namespace vam::io::arrays
