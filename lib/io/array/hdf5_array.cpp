// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/hdf5_array.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/array/private/hdf5_tree.hpp"

namespace vam::io::arrays {

namespace {

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

/// A dataset that is read image by image.
struct Images {
  Images(std::string_view bytes, const ArrayOptions& options, std::uint64_t memory, const std::string& name)
      : file(opened_file(bytes, name)) {
    const std::string path = chosen_path(file.id(), options.name, name);
    subject = name + ": " + printable(path);
    dataset = Handle(hdf5().H5Oopen(file.id(), path.c_str(), H5P_DEFAULT));
    const Dataset about = describe(dataset.id(), path);
    if (!about.holds.empty()) fail(" holds " + about.holds + ", not numbers");
    try {
      set_shape(about.shape, head);
    } catch (const std::runtime_error& problem) {
      fail(std::string(" ") + problem.what());
    }
    rank = about.shape.size();
    shape = head.shape;
    std::copy(options.axes.begin(), options.axes.end(), axes.begin());
    head.shape = {shape[axes[0]], shape[axes[1]], shape[axes[2]]};
    if (about.bits.words != 0) take_words(about.bits);
    const Handle properties(hdf5().H5Dget_create_plist(dataset.id()));
    require_values(dataset.id(), properties.id(), subject);
    plan_depth(properties.id(), memory);
  }

  [[noreturn]] void fail(const std::string& why) const { throw Error{Fault::data, subject + why}; }

  /// Of a BitArray, which from here on stand for the dataset.
  void take_words(const BitArray& bits) {
    const Hdf5& h5 = hdf5();
    const std::uint64_t length = head.values();
    const std::vector<std::uint64_t> count{(length + 63) / 64};
    dataset = Handle(h5.H5Rdereference2(dataset.id(), H5P_DEFAULT, H5R_OBJECT, &bits.words));
    if (static_cast<std::uint64_t>(bits.length) != length || describe(dataset.id(), "").shape != count) {
      fail(" has another number of bits than its sizes; it is damaged");
    }
    words.resize(count[0]);
    if (h5.H5Dread(dataset.id(), *h5.native_word, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data()) < 0) damaged();
  }

  [[noreturn]] void damaged() const { fail(" is truncated or damaged" + hdf5_cause()); }

  /// A chunk is unpacked once where as many images as it is deep are read together.
  void plan_depth(hid_t properties, std::uint64_t memory) {
    std::array<hsize_t, 3> chunk{1, 1, 1};
    if (words.empty()) hdf5().H5Pget_chunk(properties, static_cast<int>(rank), chunk.data() + (3 - rank));
    const std::uint64_t image_bytes = shape[axes[1]] * shape[axes[2]] * sizeof(float);
    const std::uint64_t deep = std::max<std::uint64_t>(chunk[axes[0]], 1);
    const std::uint64_t most = memory / image_bytes;
    const std::uint64_t wanted = axes[0] == 0 ? std::max(enough / image_bytes, deep) : most;
    depth = std::clamp<std::uint64_t>(std::min(wanted, most), 1, shape[axes[0]]);
    if (depth > deep) depth -= depth % deep;
  }

  void read_block() {
    const Hdf5& h5 = hdf5();
    held = std::min(depth, head.shape[0] - done);
    first = done;
    std::array<hsize_t, 3> start{};
    std::array<hsize_t, 3> count{shape[0], shape[1], shape[2]};
    start[axes[0]] = first;
    count[axes[0]] = held;
    stride = {count[1] * count[2], count[2], 1};
    block.resize(count[0] * count[1] * count[2]);
    if (!words.empty()) return unpack_block(start, count);
    const std::size_t unused = 3 - rank;
    const Handle from(h5.H5Dget_space(dataset.id()));
    const Handle to(h5.H5Screate_simple(static_cast<int>(rank), count.data() + unused, nullptr));
    const herr_t chosen = h5.H5Sselect_hyperslab(from.id(), H5S_SELECT_SET, start.data() + unused, nullptr,
                                                 count.data() + unused, nullptr);
    if (chosen < 0 || h5.H5Dread(dataset.id(), *h5.native_float, to.id(), from.id(), H5P_DEFAULT, block.data()) < 0) {
      damaged();
    }
  }

  void unpack_block(const std::array<hsize_t, 3>& start, const std::array<hsize_t, 3>& count) {
    float* to = block.data();
    for (std::uint64_t k = start[0]; k < start[0] + count[0]; ++k) {
      for (std::uint64_t j = start[1]; j < start[1] + count[1]; ++j) {
        const std::uint64_t row = (k * shape[1] + j) * shape[2] + start[2];
        for (std::uint64_t i = row; i < row + count[2]; ++i) *to++ = static_cast<float>(words[i / 64] >> i % 64 & 1);
      }
    }
  }

  /// False after the last.
  bool next() {
    if (done == head.shape[0]) return false;
    if (done == first + held) read_block();
    image.clear();
    for (std::size_t row = 0; row < head.shape[1]; ++row) {
      const float* value = block.data() + (done - first) * stride[axes[0]] + row * stride[axes[1]];
      for (std::size_t c = 0; c < head.shape[2]; ++c) image.push_back(value[c * stride[axes[2]]]);
    }
    ++done;
    used = 0;
    return true;
  }

  std::size_t read(void* to, std::size_t size) {
    std::size_t got = 0;
    while (got < size && (used < image.size() * sizeof(float) || next())) {
      const std::size_t step = std::min(size - got, image.size() * sizeof(float) - used);
      std::memcpy(static_cast<char*>(to) + got, reinterpret_cast<const char*>(image.data()) + used, step);
      used += step;
      got += step;
    }
    return got;
  }

  Handle file;
  Handle dataset;
  std::string subject;
  Head head;
  std::size_t rank = 3;
  std::array<std::uint64_t, 3> shape{};  // of the dataset
  std::array<std::size_t, 3> axes{};     // which of them count the images, rows and columns
  std::vector<std::uint64_t> words;      // of a BitArray
  std::uint64_t depth = 1;               // images read together
  std::vector<float> block;              // `held` images from `first` on
  std::array<std::size_t, 3> stride{};   // of the axes in it
  std::uint64_t first = 0, held = 0, done = 0;
  std::vector<float> image;
  std::size_t used = 0;  // bytes of it
};

}  // namespace

void load_hdf5() { (void)hdf5(); }

Hdf5Images open_hdf5(std::string_view bytes, const ArrayOptions& options, std::uint64_t memory,
                     const std::string& name) {
  auto images = std::make_shared<Images>(bytes, options, memory, name);
  return {images->head, [images](void* to, std::size_t size) { return images->read(to, size); }};
}

}  // namespace vam::io::arrays
