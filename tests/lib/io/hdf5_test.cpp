// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files, written here by the library itself: what is in them is known without reading them by our own code.
#include <hdf5.h>

#include <limits>
#include <numeric>

#include "lib/io/array_samples.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using samples::read_array_file;
using samples::ReadArray;

namespace {

using Shape = std::vector<hsize_t>;

/// A file to which datasets are added. With it all that was opened in it is closed, and the library closes the rest.
class Made {
 public:
  explicit Made(const std::string& path, hsize_t user_block = 0) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_userblock(creation, user_block);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
    H5Pset_create_intermediate_group(links_, 1);
  }
  ~Made() { H5Fclose(file_); }
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;

  /// Values of doubles, stored as `type`; in chunks of `chunk` packed by shuffle and gzip, where it has any.
  void add(const std::string& path, const Shape& shape, hid_t type, const std::vector<double>& values,
           const Shape& chunk = {}) const {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    if (!chunk.empty()) {
      H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(properties);
      H5Pset_deflate(properties, 4);
    }
    put(path, type, space_of(shape), properties, H5T_NATIVE_DOUBLE, values.empty() ? nullptr : values.data());
  }
  void link(const std::string& from, const std::string& to) const {
    REQUIRE(H5Lcreate_soft(to.c_str(), file_, from.c_str(), links_, H5P_DEFAULT) >= 0);
  }
  void link_out(const std::string& from, const std::string& file, const std::string& to) const {
    REQUIRE(H5Lcreate_external(file.c_str(), to.c_str(), file_, from.c_str(), links_, H5P_DEFAULT) >= 0);
  }
  /// A Julia BitArray as JLD2 stores the fields of its struct (chunks::Vector{UInt64}, len::Int, dims::NTuple{3,Int}):
  /// one record with a reference, a number and a record of the numbers "1", "2" and "3".
  void bits(const std::string& path, const std::vector<std::uint64_t>& words, std::int64_t length,
            const std::array<std::int64_t, 3>& sizes) const {
    put(path + "-chunks", H5T_STD_U64LE, space_of({words.size()}), H5P_DEFAULT, H5T_NATIVE_UINT64, words.data());
    struct {
      hobj_ref_t chunks;
      std::int64_t length;
      std::array<std::int64_t, 3> sizes;
    } record{0, length, sizes};
    REQUIRE(H5Rcreate(&record.chunks, file_, (path + "-chunks").c_str(), H5R_OBJECT, -1) >= 0);
    const hid_t three = H5Tcreate(H5T_COMPOUND, 24);
    for (const char* name : {"1", "2", "3"})
      H5Tinsert(three, name, 8 * static_cast<std::size_t>(*name - '1'), H5T_STD_I64LE);
    const hid_t type = H5Tcreate(H5T_COMPOUND, 40);
    H5Tinsert(type, "chunks", 0, H5T_STD_REF_OBJ);
    H5Tinsert(type, "len", 8, H5T_STD_I64LE);
    H5Tinsert(type, "dims", 16, three);
    REQUIRE(H5Tcommit2(file_, (path + "-type").c_str(), type, links_, H5P_DEFAULT, H5P_DEFAULT) >= 0);
    put(path, type, H5Screate(H5S_SCALAR), H5P_DEFAULT, type, &record);
  }
  void virtual_copy(const std::string& path, const Shape& shape, const std::string& other_file) const {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t space = space_of(shape);
    REQUIRE(H5Pset_virtual(properties, space, other_file.c_str(), "/a", space) >= 0);
    put(path, H5T_IEEE_F32LE, space, properties, 0, nullptr);
  }

 private:
  static hid_t space_of(const Shape& shape) {
    return H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  }
  void put(const std::string& path, hid_t type, hid_t space, hid_t properties, hid_t given, const void* values) const {
    const hid_t dataset = H5Dcreate2(file_, path.c_str(), type, space, links_, properties, H5P_DEFAULT);
    REQUIRE(dataset >= 0);
    if (values != nullptr) REQUIRE(H5Dwrite(dataset, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  }

  hid_t links_ = H5Pcreate(H5P_LINK_CREATE);
  hid_t file_ = -1;
};

/// 0, 1, 2, ...
std::vector<double> counted(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

std::string refusal(const std::string& path, Fault fault = Fault::data, const ArrayOptions& options = {}) {
  return error_of([&] { (void)read_array_file(path, options); }, fault);
}

bool is_counted(const ReadArray& all) {
  const std::vector<double> counts = counted(all.values.size());
  return std::equal(all.values.begin(), all.values.end(), counts.begin());
}

hid_t half_float() {
  const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
  H5Tset_fields(half, 15, 10, 5, 0, 10);
  H5Tset_size(half, 2);
  H5Tset_ebias(half, 15);
  return half;
}

}  // namespace

TEST_CASE("HDF5 numbers of every type, contiguous and packed") {
  const scratch::Folder folder;
  const hid_t half = half_float();
  for (const hid_t type : {H5T_STD_I8LE, H5T_STD_U8BE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE, H5T_STD_U32BE,
                           H5T_STD_I64BE, H5T_STD_U64LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE, half, H5T_NATIVE_LDOUBLE}) {
    for (const Shape& chunk : {Shape{}, Shape{1, 2, 3}, Shape{2, 3, 4}, Shape{3, 3, 3}}) {
      const std::string path = folder / "a.h5";
      Made(path).add("/a", {5, 3, 4}, type, counted(60), chunk);
      const ReadArray all = read_array_file(path);
      CHECK(all.shape() == std::array{5, 3, 4});
      CHECK(all.values.size() == 60);
      CHECK(is_counted(all));
    }
  }
  Made(folder / "plane.h5").add("/a", {5, 4}, H5T_STD_I16LE, counted(20));
  const ReadArray plane = read_array_file(folder / "plane.h5", {"/a"});
  CHECK(plane.shape() == std::array{1, 5, 4});
  CHECK(is_counted(plane));
}

TEST_CASE("HDF5 axes in every order give the same as NumPy's transpose") {
  const scratch::Folder folder;
  const std::string path = folder / "a.h5";
  const std::array<int, 3> shape{5, 3, 4};
  std::array<int, 3> axes{0, 1, 2};
  for (const Shape& chunk : {Shape{}, Shape{2, 2, 2}}) {
    Made(path).add("/a", {5, 3, 4}, H5T_IEEE_F32LE, counted(60), chunk);
    do {
      const ReadArray all = read_array_file(path, {"", axes});
      std::size_t at = 0;
      std::array<int, 3> of{};
      for (const auto [k, r, c] : indices(shape[axes[0]], shape[axes[1]], shape[axes[2]])) {
        of[axes[0]] = k, of[axes[1]] = r, of[axes[2]] = c;
        REQUIRE(all.values[at++] == static_cast<float>((of[0] * 3 + of[1]) * 4 + of[2]));
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
}

TEST_CASE("A BitArray of Julia is read as JLD2 stores it, the first dimension the fastest, from the lowest bit up") {
  const scratch::Folder folder;
  const std::string path = folder / "target.jld2";
  const std::array<std::int64_t, 3> sizes{5, 7, 11};
  const auto is_set = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    return (7 * i + 5 * j * j + 3 * k) % 4 == 1;
  };
  std::vector<std::uint64_t> words(7);
  std::int64_t l = 0;  // Julia: linear index l + 1, chunk l >> 6 + 1, bit l & 63
  for (const auto [k, j, i] : indices(11, 7, 5)) {
    if (is_set(i, j, k)) words[static_cast<std::size_t>(l >> 6)] |= std::uint64_t{1} << (l & 63);
    ++l;
  }
  const auto made = [&](const std::vector<std::uint64_t>& chunks, std::int64_t length,
                        const std::array<std::int64_t, 3>& stated) {
    Made(path, 512).bits("/target", chunks, length, stated);
  };
  made(words, 385, sizes);
  for (std::array<int, 3> axes{0, 1, 2}; const bool turned : {false, true}) {
    if (turned) axes = {2, 0, 1};
    const ReadArray all = read_array_file(path, {"", axes});
    REQUIRE(all.values.size() == 385);
    CHECK(all.size.columns == (turned ? 7 : 5));
    std::size_t at = 0;
    for (const auto [image, r, c] : indices(all.size.images, all.size.rows, all.size.columns)) {
      const bool expected = turned ? is_set(image, c, r) : is_set(c, r, image);
      REQUIRE(all.values[at++] == (expected ? 1 : 0));
    }
  }
  made(words, 384, sizes);
  CHECK(has(refusal(path), "/target has another number of bits than its sizes"));
  made({words.begin(), words.begin() + 6}, 385, sizes);
  CHECK(has(refusal(path), "/target has another number of bits than its sizes"));
  made(words, 385, {5, -7, 11});
  CHECK(has(refusal(path), "values; up to 65536 along an axis"));
}

TEST_CASE("HDF5 files that are not read are refused with what they hold") {
  const scratch::Folder folder;
  const std::string path = folder / "a.h5";
  {
    const Made made(path);
    made.add("/flat", {3, 4}, H5T_STD_I32LE, counted(12));
    made.add("/deep", {1, 2, 3, 4}, H5T_STD_I32LE, counted(24));
    const hid_t text = H5Tcopy(H5T_C_S1);
    made.add("/text", {2, 2, 2}, text, {});
    const hid_t pair = H5Tcreate(H5T_COMPOUND, 8);
    H5Tinsert(pair, "re", 0, H5T_IEEE_F32LE);
    H5Tinsert(pair, "im", 4, H5T_IEEE_F32LE);
    made.add("/pairs", {2, 2, 2}, pair, {});
    made.add("/empty", {2, 0, 2}, H5T_STD_I32LE, {});
  }
  // The only one of 3 dimensions is empty.
  CHECK(has(refusal(path), "/empty is an empty array (2 x 0 x 2)"));
  CHECK(has(refusal(path, Fault::data, {"/deep"}), "/deep has 4 axes (1 x 2 x 3 x 4); arrays of 2 or 3 are read"));
  CHECK(has(refusal(path, Fault::data, {"text"}), "/text holds strings, not numbers"));
  CHECK(has(refusal(path, Fault::data, {"/pairs"}), "/pairs holds records of several fields"));
  CHECK(has(refusal(path, Fault::usage, {"/no"}), "/flat (3 x 4), /pairs (records"));
  CHECK(has(refusal(path, Fault::usage, {"/no"}), "but no dataset is called /no"));

  const auto alone = [&](const Shape& shape, hid_t type, const std::vector<double>& values) {
    Made(folder / "b.h5").add("/b", shape, type, values);
    return refusal(folder / "b.h5");
  };
  CHECK(has(alone({3, 4}, H5T_STD_I32LE, counted(12)), "has no array of 3 dimensions, but /b (3 x 4)"));
  CHECK(has(alone({2, 3, 4}, H5T_STD_I32LE, {}), "/b has no values"));
  CHECK(has(alone({1, 1, 65537}, H5T_STD_I8LE, counted(65537)), "has 1 x 1 x 65537 values"));
  std::vector<double> values = counted(24);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    values[19] = bad;
    CHECK(has(alone({2, 3, 4}, H5T_IEEE_F64LE, values), "column 3, row 1 of image 1 is not a finite number"));
  }
  {
    const Made made(folder / "two.h5");
    made.add("/a", {1, 2, 2}, H5T_STD_I32LE, counted(4));
    made.add("/b", {1, 2, 3}, H5T_STD_I32LE, counted(6));
  }
  CHECK(has(refusal(folder / "two.h5", Fault::usage),
            "holds 2 arrays of 3 dimensions (/a (1 x 2 x 2), /b (1 x 2 x 3)); name one by --array"));
  Made(folder / "virtual.h5").virtual_copy("/b", {2, 3, 4}, folder / "a.h5");
  CHECK(has(refusal(folder / "virtual.h5"), "/b has its values in other files"));
}

TEST_CASE("HDF5 links that lead nowhere are named") {
  const scratch::Folder folder;
  const std::string path = folder / "a.h5";
  {
    const Made made(path);
    made.link("/gone", "/nowhere/data");
    made.link_out("/far", "b.h5", "/data");
    made.link_out("/master", "b.h5", "/entry");
  }
  const std::string far = "/far is a link to /data of the file b.h5, which is not in the file";
  CHECK(has(refusal(path, Fault::data, {"/gone"}), "a.h5: /gone is a link to /nowhere/data, which is not in the file"));
  CHECK(has(refusal(path, Fault::data, {"far"}), far));
  CHECK(has(refusal(path, Fault::data, {"/master/data"}), "/master is a link to /entry of the file b.h5"));
  CHECK(has(refusal(path), "no array of 3 dimensions, but /far (a link to /data of the file b.h5, which is not in"));
}

TEST_CASE("HDF5 files end where their superblock says, behind a user block, too") {
  const scratch::Folder folder;
  const std::string path = folder / "a.h5";
  for (const hsize_t user_block : {0, 512}) {
    CAPTURE(user_block);
    Made(path, user_block).add("/a", {2, 3, 4}, H5T_STD_I32LE, counted(24));
    const std::string bytes = scratch::slurp(path);
    CHECK(is_counted(read_array_file(path)));
    CHECK(is_counted(
        read_array_file(folder.write("b.h5", std::string(512, 'u') + bytes))));  // as h5jam puts one before it
    for (const std::size_t more : {1, 4096}) {
      const std::string said = refusal(folder.write("c.h5", bytes + std::string(more, '\0')));
      CHECK(has(said, "has " + std::to_string(more) + " bytes behind the end that its HDF5 superblock states"));
    }
  }
}

TEST_CASE("HDF5 groups that hold each other are walked once, and one place of several paths is one array") {
  const scratch::Folder folder;
  {
    const Made made(folder / "loop.h5");
    made.add("/a/b/data", {2, 3, 4}, H5T_STD_I32LE, counted(24));
    made.link("/a/b/up", "/a");
    made.link("/a/nowhere", "/c");
    made.link("/again", "/a/b/data");
  }
  CHECK(is_counted(read_array_file(folder / "loop.h5")));
  CHECK(has(refusal(folder / "loop.h5", Fault::usage, {"/x"}),
            "holds /a/b/data (2 x 3 x 4), "
            "/a/nowhere (a link to /c, which is not in the file), /again (2 x 3 x 4), but no dataset"));
}

TEST_CASE("HDF5 files cut off or damaged anywhere are read, or refused in one line") {
  const scratch::Folder folder;
  Made(folder / "a.h5").add("/a/data", {2, 3, 4}, H5T_STD_I16LE, counted(24), {1, 2, 2});
  const std::string whole = scratch::slurp(folder / "a.h5");
  REQUIRE(whole.size() > 1000);
  for (std::size_t cut = 1; cut < whole.size(); cut += cut < 100 ? 9 : 97) {
    CHECK(!refusal(folder.write("cut.h5", whole.substr(0, cut))).empty());
  }
  int sound = 0;
  for (std::size_t at = 0; at < whole.size(); at += 41) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    std::string line;
    const int status = scratch::status([&] { (void)read_array_file(folder.write("damaged.h5", damaged)); }, &line);
    CHECK((status == 0 || status == 65));
    CHECK(line.find('\n') == std::string::npos);
    sound += status == 0 ? 1 : 0;
  }
  CHECK(sound > 0);
}
