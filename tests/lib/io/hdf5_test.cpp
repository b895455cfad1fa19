// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files, written here by the library itself: what is in them is known without reading them by our own code.
#include <hdf5.h>

#include <limits>
#include <numeric>

#include "io/array/array_reader.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

using Shape = std::vector<hsize_t>;

/// A file to which datasets are added.
class Made {
 public:
  explicit Made(const std::string& path, hid_t creation = H5P_DEFAULT)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT)), links_(H5Pcreate(H5P_LINK_CREATE)) {
    H5Pset_create_intermediate_group(links_, 1);
  }
  ~Made() {
    H5Pclose(links_);
    H5Fclose(file_);
  }
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
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t dataset = H5Dcreate2(file_, path.c_str(), type, space, links_, properties, H5P_DEFAULT);
    REQUIRE(dataset >= 0);
    if (!values.empty()) {
      REQUIRE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    }
    H5Dclose(dataset);
    H5Sclose(space);
    H5Pclose(properties);
  }
  void text(const std::string& object, const char* name, const std::string& value) const {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, value.size());
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        H5Acreate_by_name(file_, object.c_str(), name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Awrite(attribute, type, value.data()) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
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
    const hsize_t count = words.size();
    const hid_t line = H5Screate_simple(1, &count, nullptr);
    const hid_t chunks =
        H5Dcreate2(file_, (path + "-chunks").c_str(), H5T_STD_U64LE, line, links_, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Dwrite(chunks, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data()) >= 0);
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
    const hid_t one = H5Screate(H5S_SCALAR);
    const hid_t dataset = H5Dcreate2(file_, path.c_str(), type, one, links_, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &record) >= 0);
    for (const hid_t space : {line, one}) H5Sclose(space);
    for (const hid_t closed : {chunks, dataset}) H5Dclose(closed);
    for (const hid_t closed : {three, type}) H5Tclose(closed);
  }
  void virtual_copy(const std::string& path, const Shape& shape, const std::string& other_file) const {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    REQUIRE(H5Pset_virtual(properties, space, other_file.c_str(), "/a", space) >= 0);
    const hid_t dataset = H5Dcreate2(file_, path.c_str(), H5T_IEEE_F32LE, space, links_, properties, H5P_DEFAULT);
    REQUIRE(dataset >= 0);
    H5Dclose(dataset);
    H5Sclose(space);
    H5Pclose(properties);
  }

 private:
  hid_t file_;
  hid_t links_;
};

/// 0, 1, 2, ...
std::vector<double> counted(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

struct Read {
  ArraySize size;
  StatedViews views;
  std::vector<float> values;
};

Read read(const std::string& path, const ArrayOptions& options = {}) {
  ArrayReader reader(path, options);
  Read all{reader.size(), reader.views(), {}};
  for (Image image; reader.next(image);) all.values.insert(all.values.end(), image.values.begin(), image.values.end());
  return all;
}

ArrayOptions projections(const std::string& name = "") { return {name, {0, 1, 2}, true, true}; }

std::string refusal(const std::string& path, Fault fault = Fault::data, const ArrayOptions& options = {}) {
  return error_of([&] { (void)read(path, options); }, fault);
}

bool is_counted(const Read& all) {
  for (std::size_t i = 0; i < all.values.size(); ++i) {
    if (all.values[i] != static_cast<float>(i)) return false;
  }
  return true;
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
      const Read all = read(path);
      CHECK(all.size.images == 5);
      CHECK(all.size.rows == 3);
      CHECK(all.size.columns == 4);
      CHECK(all.values.size() == 60);
      CHECK(is_counted(all));
    }
  }
  Made(folder / "plane.h5").add("/a", {5, 4}, H5T_STD_I16LE, counted(20));
  const Read plane = read(folder / "plane.h5", {"/a"});
  CHECK(plane.size.images == 1);
  CHECK(plane.size.rows == 5);
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
      const Read all = read(path, {"", axes});
      std::size_t at = 0;
      std::array<int, 3> of{};
      for (const auto [k, r] : indices(shape[axes[0]], shape[axes[1]])) {
        for (int c = 0; c < shape[axes[2]]; ++c, ++at) {
          of[axes[0]] = k, of[axes[1]] = r, of[axes[2]] = c;
          REQUIRE(all.values[at] == static_cast<float>((of[0] * 3 + of[1]) * 4 + of[2]));
        }
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
  for (std::int64_t k = 0; k < sizes[2]; ++k) {
    for (const auto [j, i] : indices(static_cast<int>(sizes[1]), static_cast<int>(sizes[0]))) {
      if (is_set(i, j, k)) words[static_cast<std::size_t>(l >> 6)] |= std::uint64_t{1} << (l & 63);
      ++l;
    }
  }
  const auto made = [&](const std::vector<std::uint64_t>& chunks, std::int64_t length,
                        const std::array<std::int64_t, 3>& stated) {
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, 512);
    Made(path, creation).bits("/target", chunks, length, stated);
    H5Pclose(creation);
  };
  made(words, 385, sizes);
  for (std::array<int, 3> axes{0, 1, 2}; const bool turned : {false, true}) {
    if (turned) axes = {2, 0, 1};
    const Read all = read(path, {"", axes});
    REQUIRE(all.values.size() == 385);
    CHECK(all.size.columns == (turned ? 7 : 5));
    std::size_t at = 0;
    for (int image = 0; image < all.size.images; ++image) {
      for (const auto [r, c] : indices(all.size.rows, all.size.columns)) {
        const bool expected = turned ? is_set(image, c, r) : is_set(c, r, image);
        REQUIRE(all.values[at++] == (expected ? 1 : 0));
      }
    }
  }
  made(words, 384, sizes);
  CHECK(has(refusal(path), "/target has another number of bits than its sizes"));
  made({words.begin(), words.begin() + 6}, 385, sizes);
  CHECK(has(refusal(path), "/target has another number of bits than its sizes"));
  made(words, 385, {5, -7, 11});
  CHECK(has(refusal(path), "values; up to 65536 along an axis"));
}

TEST_CASE("DXchange projections are read upwards, with their angles") {
  const scratch::Folder folder;
  const std::string path = folder / "scan.h5";
  {
    const Made made(path);
    made.add("/exchange/data", {2, 3, 4}, H5T_STD_U16LE, counted(24), {1, 3, 4});
    made.add("/exchange/data_white", {1, 3, 4}, H5T_STD_U16LE, counted(12));
    made.add("/exchange/theta", {2}, H5T_IEEE_F32LE, {0, 180});
  }
  const Read all = read(path, projections());
  CHECK(all.size.images == 3);
  CHECK(all.size.rows == 2);
  CHECK(all.views.top_first);
  CHECK(all.views.source == "/exchange/theta");
  CHECK(all.views.angles_deg == std::vector<double>{0, 180});
  // The lowest row of either projection, then the one above it.
  CHECK(std::vector<float>(all.values.begin(), all.values.begin() + 12) ==
        std::vector<float>{8, 9, 10, 11, 20, 21, 22, 23, 4, 5, 6, 7});
  const Read stated = read(path, {"", {1, 0, 2}, true, false});
  CHECK(!stated.views.top_first);
  CHECK(stated.views.angles_deg.size() == 2);
  CHECK(stated.values[0] == 0);
  const Read volume = read(path);
  CHECK(is_counted(volume));
  CHECK(volume.views.angles_deg.empty());
}

TEST_CASE("NXtomo projections are those of key 0, with angles in degrees or radians") {
  const scratch::Folder folder;
  const std::string path = folder / "scan.nxs";
  {
    const Made made(path);
    made.add("/entry1/tomo_entry/instrument/detector/data", {5, 2, 3}, H5T_STD_I32LE, counted(30));
    made.add("/entry1/tomo_entry/instrument/detector/image_key", {5}, H5T_STD_I32LE, {1, 0, 0, 2, 0});
    made.add("/entry1/tomo_entry/sample/rotation_angle", {5}, H5T_IEEE_F64LE,
             {0, 0, std::acos(-1.0) / 2, 0, std::acos(-1.0)});
    made.text("/entry1/tomo_entry/sample/rotation_angle", "units", "rad");
    made.link("/entry1/tomo_entry/data/data", "/entry1/tomo_entry/instrument/detector/data");
    made.text("/entry1/tomo_entry/data", "NX_class", "NXdata");
    made.add("/entry1/other", {2, 2, 2}, H5T_STD_I32LE, counted(8));
  }
  const Read all = read(path, projections());
  CHECK(all.size.images == 2);
  CHECK(all.size.rows == 3);
  CHECK(all.values == std::vector<float>{9, 10, 11, 15, 16, 17, 27, 28, 29, 6, 7, 8, 12, 13, 14, 24, 25, 26});
  REQUIRE(all.views.angles_deg.size() == 3);
  CHECK(all.views.angles_deg[1] == doctest::Approx(90));
  CHECK(all.views.angles_deg[2] == doctest::Approx(180));
  CHECK(read(path).size.images == 5);  // a volume has no keys
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

  Made(folder / "flat.h5").add("/flat", {3, 4}, H5T_STD_I32LE, counted(12));
  CHECK(has(refusal(folder / "flat.h5"), "has no array of 3 dimensions, but /flat (3 x 4)"));
  {
    const Made made(folder / "two.h5");
    made.add("/a", {1, 2, 2}, H5T_STD_I32LE, counted(4));
    made.add("/b", {1, 2, 3}, H5T_STD_I32LE, counted(6));
  }
  CHECK(has(refusal(folder / "two.h5", Fault::usage),
            "holds 2 arrays of 3 dimensions (/a (1 x 2 x 2), /b (1 x 2 x 3)); name one by --array"));
  Made(folder / "unwritten.h5").add("/a", {2, 3, 4}, H5T_STD_I32LE, {});
  CHECK(has(refusal(folder / "unwritten.h5"), "/a has no values"));
  Made(folder / "wide.h5").add("/a", {1, 1, 65537}, H5T_STD_I8LE, counted(65537));
  CHECK(has(refusal(folder / "wide.h5"), "has 1 x 1 x 65537 values"));
  Made(folder / "virtual.h5").virtual_copy("/b", {2, 3, 4}, folder / "a.h5");
  CHECK(has(refusal(folder / "virtual.h5"), "/b has its values in other files"));

  std::vector<double> values = counted(24);
  values[19] = std::numeric_limits<double>::quiet_NaN();
  Made(folder / "nan.h5").add("/a", {2, 3, 4}, H5T_IEEE_F64LE, values);
  CHECK(has(refusal(folder / "nan.h5"), "column 3, row 1 of image 1 is not a finite number"));
  values[19] = 1e300;
  Made(folder / "huge.h5").add("/a", {2, 3, 4}, H5T_IEEE_F64LE, values);
  CHECK(has(refusal(folder / "huge.h5"), "column 3, row 1 of image 1 is not a finite number"));
}

TEST_CASE("HDF5 links that lead nowhere are named, and nothing else is taken for what they stand for") {
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
  for (const char* shown : {"/exchange/data", "/entry/data"}) {
    const std::string two = folder / "two.h5";
    {
      const Made made(two);
      made.add("/preview", {2, 3, 4}, H5T_STD_I32LE, counted(24));
      made.add(std::string(shown) + "_dark", {3, 4}, H5T_STD_I32LE, counted(12));
      if (shown == std::string("/entry/data")) made.text("/entry", "NX_class", "NXdata");
      made.link(shown, "/nowhere");
    }
    CHECK(has(refusal(two), std::string(shown) + " is a link to /nowhere, which is not in the file"));
    CHECK(is_counted(read(two, {"/preview"})));
  }
}

TEST_CASE("HDF5 files end where their superblock says, behind a user block, too") {
  const scratch::Folder folder;
  const std::string path = folder / "a.h5";
  for (const hsize_t user_block : {0, 512}) {
    CAPTURE(user_block);
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, user_block);
    Made(path, creation).add("/a", {2, 3, 4}, H5T_STD_I32LE, counted(24));
    H5Pclose(creation);
    const std::string bytes = scratch::slurp(path);
    CHECK(is_counted(read(path)));
    CHECK(is_counted(read(folder.write("b.h5", std::string(512, 'u') + bytes))));  // as h5jam puts one before it
    for (const std::size_t more : {1, 4096}) {
      const std::string said = refusal(folder.write("c.h5", bytes + std::string(more, '\0')));
      CHECK(has(said, "has " + std::to_string(more) + " bytes behind the end that its HDF5 superblock states"));
    }
  }
}

TEST_CASE("NXtomo keys and units that contradict the projections are refused") {
  const scratch::Folder folder;
  const std::string path = folder / "a.nxs";
  const auto made = [&](const std::vector<double>& keys, const std::string& units) {
    const Made file(path);
    file.add("/entry/data/data", {2, 3, 4}, H5T_STD_I32LE, counted(24));
    file.add("/entry/data/image_key", {keys.size()}, H5T_STD_I32LE, keys);
    file.add("/entry/data/rotation_angle", {2}, H5T_IEEE_F64LE, {0, 1});
    file.text("/entry/data/rotation_angle", "units", units);
  };
  made({1, 2}, "degree");
  CHECK(has(refusal(path, Fault::data, projections()), "/entry/data/image_key marks no frame as a projection"));
  made({0, 0, 0}, "degree");
  CHECK(has(refusal(path, Fault::data, projections()), "has 3 keys of 2 frames"));
  made({0, 0}, "mrad");
  CHECK(has(refusal(path, Fault::data, projections()), "has the unit 'mrad'"));
  made({0, 0}, "degrees");
  CHECK(read(path, projections()).views.angles_deg == std::vector<double>{0, 1});
}

TEST_CASE("HDF5 groups that hold each other are walked once") {
  const scratch::Folder folder;
  {
    const Made made(folder / "loop.h5");
    made.add("/a/b/data", {2, 3, 4}, H5T_STD_I32LE, counted(24));
    made.link("/a/b/up", "/a");
    made.link("/a/nowhere", "/c");
  }
  CHECK(is_counted(read(folder / "loop.h5")));
  CHECK(has(refusal(folder / "loop.h5", Fault::usage, {"/x"}),
            "holds /a/b/data (2 x 3 x 4), "
            "/a/nowhere (a link to /c, which is not in the file), but no dataset"));
}

TEST_CASE("HDF5 files cut off or damaged anywhere are read, or refused in one line") {
  const scratch::Folder folder;
  Made(folder / "a.h5").add("/exchange/data", {2, 3, 4}, H5T_STD_I16LE, counted(24), {1, 2, 2});
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
    const int status = scratch::status([&] { (void)read(folder.write("damaged.h5", damaged)); }, &line);
    CHECK((status == 0 || status == 65));
    CHECK(line.find('\n') == std::string::npos);
    sound += status == 0 ? 1 : 0;
  }
  CHECK(sound > 0);
}
