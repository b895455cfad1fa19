// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 2000 -tc=damage sweep*
// Files that show that they are what was written: a flipped bit is an error, or changes nothing that is read. The
// judges are the values themselves, and OpenEXR's and OpenVDB's own readers and writers.
#include "io/stream/seal.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <xxhash.h>

#include <cstddef>
#include <cstring>
#include <map>

#include "base/text/printable.hpp"
#include "lib/io/exr_stacks.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using namespace vam::io;
using scratch::slurp;
using scratch::spill;
using scratch::status;

namespace {

void note(std::string& seen, const std::map<std::string, std::string>& facts) {
  for (const auto& [key, value] : facts) seen += key + "=" + value + "\n";
}

template <class Number>
void note(std::string& seen, const Number& number) {
  seen.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// All that a tool gets of a stack.
std::string seen_stack(const std::string& path) {
  StackReader reader(path);
  const auto& info = reader.info();
  std::string seen = info.units;
  for (const auto& line : info.history) seen += line + "\n";
  note(seen, info.extra);
  for (const double number : {info.pixel_mm, info.row_mm, info.z_start_mm, info.angle_start_deg, info.angle_step_deg}) {
    note(seen, number);
  }
  for (const int number : {static_cast<int>(info.kind), static_cast<int>(info.space), info.width, info.height}) {
    note(seen, number);
  }
  Image image;
  model::ImageInfo about;
  while (reader.next(image, about)) {
    seen.append(reinterpret_cast<const char*>(image.values.data()), image.size() * sizeof(float));
    for (const double number : {about.z_mm, about.angle_deg, about.time_s}) note(seen, number);
    note(seen, about.has_angle);
    note(seen, about.number);
  }
  return seen;
}

std::string seen_volumes(const std::string& path) {
  std::string seen;
  for (const SparseVolume& volume : read_volumes(path)) {
    seen += volume.name() + volume.units;
    for (const auto& line : volume.history) seen += line + "\n";
    note(seen, volume.metadata);
    const auto& grid = volume.grid();
    for (const int number : {grid.nx, grid.ny, grid.nz}) note(seen, number);
    for (const double number : {grid.voxel_mm, grid.origin_mm[0], grid.origin_mm[1], grid.origin_mm[2]}) {
      note(seen, number);
    }
    if (grid.size() > 10'000'000) return seen + "huge";
    const auto values = volumes::dense(volume);
    seen.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  }
  return seen;
}

// VAM_TRIALS bits of the file are flipped, one at a time. A flip that is not refused must leave everything as it was.
void no_flip_unseen(const std::string& path, const std::string& whole,
                    const std::function<std::string(const std::string& path)>& read) {
  const int trials = trials_or(200);
  spill(path, whole);
  const std::string wanted = read(path);
  std::mt19937 random(11);
  int refused = 0;
  int different = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string damaged = whole;
    const std::size_t bit = std::uniform_int_distribution<std::size_t>(0, 8 * whole.size() - 1)(random);
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    spill(path, damaged);
    std::string seen;
    const int ended = status([&] { seen = read(path); });
    CHECK((ended == 0 || ended == 65));
    refused += ended == 65 ? 1 : 0;
    if (ended != 0 || seen == wanted) continue;
    ++different;
    const std::size_t from = std::max<std::size_t>(bit / 8, 24) - 24;
    MESSAGE("unseen: bit " << bit % 8 << " of byte " << bit / 8 << ", in " << printable(whole.substr(from, 48)));
  }
  CHECK(different == 0);
  CHECK(refused > trials / 2);
  MESSAGE(trials << " flips: " << refused << " refused, " << trials - refused - different << " harmless");
}

model::StackInfo stack_of_tools(int width, int height, int count) {
  auto info = stacks::sinogram(width, height, count);
  info.extra = {{"vam:printer", "vial.radius_mm=12"}, {"vam:stretch_z", "1.037"}};
  return info;
}

// What oiiotool does with --compression: every part with its attributes, decoded and encoded again; and with --attrib,
// where an owner is given.
void recompress(const std::string& from, const std::string& to, Imf::Compression compression,
                const std::string& owner = "") {
  Imf::MultiPartInputFile in(from.c_str(), 0, false);
  std::vector<Imf::Header> headers;
  for (int part = 0; part < in.parts(); ++part) {
    headers.push_back(in.header(part));
    headers.back().compression() = compression;
    headers.back().erase("chunkCount");
    if (!owner.empty()) headers.back().insert("owner", Imf::StringAttribute(owner));
  }
  Imf::MultiPartOutputFile out(to.c_str(), headers.data(), in.parts());
  for (int part = 0; part < in.parts(); ++part) {
    const Image image = stacks::read_by_openexr(from, part);
    Imf::FrameBuffer pixels;
    pixels.insert("Y", Imf::Slice::Make(Imf::FLOAT, image.values.data(), headers[0].dataWindow()));
    Imf::OutputPart output(out, part);
    output.setFrameBuffer(pixels);
    output.writePixels(image.height);
  }
}

}  // namespace

TEST_CASE("damage sweep: every flipped bit of a sealed stack is detected") {
  const scratch::Folder folder;
  for (const std::string compression : {"none", "rle", "zip", "piz", "pxr24"}) {
    for (const bool narrow : {false, true}) {
      CAPTURE(compression);
      stacks::write_stack(folder / "s.exr", stack_of_tools(19, 35, 3), {narrow, compression});
      no_flip_unseen(folder / "a.exr", slurp(folder / "s.exr"), seen_stack);
    }
  }
  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "pipe.exr");
    stacks::write_stack("-", stack_of_tools(19, 35, 3));
  }
  no_flip_unseen(folder / "a.exr", slurp(folder / "pipe.exr"), seen_stack);
}

TEST_CASE("damage sweep: every flipped bit of a sealed volume is detected") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(30, 26, 22, 0.1, 0.4);
  std::vector<SparseVolume> volumes;
  volumes.push_back(volumes::filled("target", grid, volumes::ball(grid)));
  volumes.push_back(volumes::filled("weight", grid, std::vector<float>(grid.size(), 2.5F)));
  volumes[0].history = {"vam-slice 0.1.0 part.stl"};
  volumes[0].metadata["vam:stretch_z"] = "1.037";
  for (const bool piped : {false, true}) {
    CAPTURE(piped);
    if (piped) {
      const scratch::Redirect to(STDOUT_FILENO, folder / "v.vdb");
      write_volumes("-", volumes);
    } else {
      write_volumes(folder / "v.vdb", volumes);
    }
    no_flip_unseen(folder / "a.vdb", slurp(folder / "v.vdb"), seen_volumes);
  }
}

TEST_CASE("a negative zero is read back as a zero, and the seal holds") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(30, 26, 22, 0.1, 0.4);
  std::vector<float> values = volumes::ball(grid);
  for (float& value : values) value = value == 0 ? -0.0F : value;
  SparseVolume volume = volumes::filled("dose", grid, values);
  write_volume(folder / "v.vdb", volume);
  CHECK(volumes::dense(read_volume(folder / "v.vdb", "dose")) == volumes::ball(grid));
}

TEST_CASE("a mismatch is one line with image or grid, both hashes and a remedy") {
  const scratch::Folder folder;
  stacks::write_stack(folder / "s.exr", stack_of_tools(19, 35, 3), {false, "none"});
  std::string bytes = slurp(folder / "s.exr");
  bytes[bytes.size() - 30] ^= 1;
  spill(folder / "s.exr", bytes);
  const std::string line = error_of([&] { (void)seen_stack(folder / "s.exr"); }, Fault::data);
  CHECK(has(line, "s.exr: image 2 changed after it was written (sealed "));
  CHECK(has(line, "create it again"));
}

TEST_CASE("a damaged offset table of a sealed stack is detected, though nobody here seeks by it") {
  const scratch::Folder folder;
  stacks::write_stack(folder / "s.exr", stack_of_tools(19, 35, 3), {false, "zip"});
  const std::string whole = slurp(folder / "s.exr");
  const std::string wanted = seen_stack(folder / "s.exr");
  constexpr std::size_t chunks = 3 * 3;  // of 16 rows
  const auto stated = [&](std::size_t at) {
    std::uint64_t offset = 0;
    std::memcpy(&offset, whole.data() + at, sizeof offset);
    return offset;
  };
  std::size_t table = 0;  // the first chunk follows it
  while (table + 8 * chunks < whole.size() && stated(table) != table + 8 * chunks) ++table;
  REQUIRE(table + 8 * chunks < whole.size());
  for (std::size_t entry = 0; entry < chunks; ++entry) {
    std::string damaged = whole;
    damaged[table + 8 * entry] ^= 1;
    spill(folder / "s.exr", damaged);
    CHECK(has(error_of([&] { (void)seen_stack(folder / "s.exr"); }, Fault::data),
              "its offset table is damaged, so that other programs cannot read it"));
  }
  spill(folder / "s.exr", whole);
  CHECK(seen_stack(folder / "s.exr") == wanted);
}

TEST_CASE("OpenEXR keeps the seal through a compression without loss; with loss the change is noticed") {
  const scratch::Folder folder;
  stacks::write_stack(folder / "s.exr", stack_of_tools(64, 64, 2));
  const std::string wanted = seen_stack(folder / "s.exr");
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    recompress(folder / "s.exr", folder / "again.exr", compression);
    CHECK(seen_stack(folder / "again.exr") == wanted);
  }
  recompress(folder / "s.exr", folder / "owned.exr", Imf::NO_COMPRESSION, "a lab");  // an attribute of nobody's seal
  CHECK(status([&] { CHECK(has(seen_stack(folder / "owned.exr"), "owner=a lab\n")); }) == 0);
  recompress(folder / "s.exr", folder / "lossy.exr", Imf::DWAA_COMPRESSION);
  CHECK(has(error_of([&] { (void)seen_stack(folder / "lossy.exr"); }, Fault::data),
            "image 0 changed after it was written"));
  // B44 packs half floats alone.
  stacks::write_stack(folder / "half.exr", stack_of_tools(64, 64, 2), {true, "rle"});
  Imf::MultiPartInputFile in((folder / "half.exr").c_str(), 0, false);
  Imf::Header header = in.header(0);
  header.compression() = Imf::B44_COMPRESSION;
  header.erase("chunkCount");
  Imf::Header both[2] = {header, header};
  both[1].setName("z0001");
  both[1].insert("vam:index", in.header(1)["vam:index"]);
  {
    Imf::MultiPartOutputFile out((folder / "b44.exr").c_str(), both, 2);
    for (int part = 0; part < 2; ++part) {
      Image image = stacks::read_by_openexr(folder / "half.exr", part);
      std::vector<half> halves(image.values.begin(), image.values.end());
      Imf::FrameBuffer pixels;
      pixels.insert("Y", Imf::Slice::Make(Imf::HALF, halves.data(), header.dataWindow()));
      Imf::OutputPart output(out, part);
      output.setFrameBuffer(pixels);
      output.writePixels(64);
    }
  }
  CHECK(status([&] { (void)seen_stack(folder / "b44.exr"); }) == 65);
}

TEST_CASE("OpenVDB keeps the seal of a volume that it writes again, and the change of one voxel is noticed") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(30, 26, 22, 0.1, 0.4);
  SparseVolume volume = volumes::filled("target", grid, volumes::ball(grid));
  volume.history = {"vam-slice 0.1.0 part.stl"};
  write_volume(folder / "a.vdb", volume);
  const auto read = volumes::by_openvdb(folder / "a.vdb", "target");
  openvdb::io::File file(folder / "b.vdb");
  file.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({read});
  file.close();
  CHECK(seen_volumes(folder / "b.vdb") == seen_volumes(folder / "a.vdb"));
  read->tree().setValueOn({15, 10, 11}, 0.25F);
  volumes::write_by_openvdb(folder / "c.vdb", {read});
  CHECK(has(error_of([&] { (void)seen_volumes(folder / "c.vdb"); }, Fault::data),
            "c.vdb: grid 'target' changed after it was written (sealed "));
}

TEST_CASE("a grid that has lost both of its seals among sealed ones is noticed, but weights may have been added") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(6, 6, 6, 0.1, 0);
  for (const char* other : {"insert", "weight"}) {
    std::vector<SparseVolume> volumes;
    for (const char* name : {"target", other}) {
      volumes.push_back(volumes::filled(name, grid, std::vector<float>(grid.size(), 0.5F)));
    }
    write_volumes(folder / "v.vdb", volumes);
    std::string bytes = slurp(folder / "v.vdb");
    for (const std::string key : {"vam:seal", "vam:facts_seal"}) {  // those of the grid that comes last
      const auto at = bytes.rfind(key);
      REQUIRE(at != std::string::npos);
      bytes.replace(at, 3, "was");
    }
    spill(folder / "v.vdb", bytes);
    const bool added = std::string(other) == "weight";
    for (const bool fast : {false, true}) {
      std::string line;
      CHECK(status([&] { (void)check_volumes(folder / "v.vdb", fast); }, &line) == (added ? 0 : 65));
      CHECK((line.find("' is sealed, and grid '") == std::string::npos) == added);
    }
  }
}

TEST_CASE("the heads of volumes in a file are read past damaged voxels, which the whole check finds") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(30, 26, 22, 0.1, 0.4);
  std::vector<SparseVolume> both;
  both.push_back(volumes::filled("target", grid, volumes::ball(grid)));
  both.push_back(SparseVolume("insert", grid));
  both[0].history = {"vam-slice 0.1.0 part.stl"};
  write_volumes(folder / "v.vdb", both);
  std::string bytes = slurp(folder / "v.vdb");
  bytes[bytes.size() / 2] ^= 1;
  spill(folder / "v.vdb", bytes);
  const auto heads = check_volumes(folder / "v.vdb", true);
  REQUIRE(heads.size() == 2);
  CHECK(heads[0].name == "target");
  CHECK(heads[0].history.front() == both[0].history.front());
  CHECK(heads[1].name == "insert");
  CHECK(status([&] { (void)check_volumes(folder / "v.vdb", false); }) == 65);
}

TEST_CASE("a trailer that is missing, of fewer images or behind damaged pixels ends a pipe with 65") {
  const scratch::Folder folder;
  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "pipe.exr");
    stacks::write_stack("-", stack_of_tools(9, 7, 3));
    stacks::write_stack("-", stack_of_tools(9, 7, 2));
  }
  StackReader reader(folder / "pipe.exr", true);
  Image image;
  model::ImageInfo about;
  CHECK(reader.seal().empty());
  while (reader.next(image, about)) CHECK(reader.is_sealed());
  CHECK(reader.seal().size() == 16);
  CHECK(reader.next_stack());
  while (reader.next(image, about)) CHECK(image.values.size() == 63);
  CHECK_FALSE(reader.next_stack());

  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "one.exr");
    stacks::write_stack("-", stack_of_tools(9, 7, 3));
  }
  const std::string one = slurp(folder / "one.exr");
  const std::size_t trailer = 8 + 4 * 16;
  const auto read = [&](const std::string& bytes) {
    spill(folder / "a.exr", bytes);
    std::string line;
    const int ended = status([&] { (void)seen_stack(folder / "a.exr"); }, &line);
    CHECK(line.find('\n') == std::string::npos);
    return ended;
  };
  CHECK(read(one) == 0);
  CHECK(read(one.substr(0, one.size() - trailer)) == 65);
  CHECK(read(one.substr(0, one.size() - 16)) == 65);
  std::string swapped = one;
  std::swap_ranges(swapped.end() - 64, swapped.end() - 48, swapped.end() - 48);
  CHECK(read(swapped) == 65);
}

TEST_CASE("the hash is XXH3 as published") {
  // XXH3_128bits of nothing with seed 0: 99aa06d3014798d86001c324468d497f (xxhash.com, sanity check).
  CHECK(seal_text(digest_of("", 0)) == "xxh3:99aa06d3014798d86001c324468d497f");
  Sealer pieces;
  pieces.add("ab", 2);
  pieces.add("c", 1);
  CHECK(pieces.digest() == digest_of("abc", 3));
  // Any instruction set gives what the library does, piece by piece.
  const std::string noise = slurp("/proc/self/exe").substr(0, 100'003);
  Sealer sealer;
  sealer.add(noise.data(), 1000);
  sealer.add(noise.data() + 1000, noise.size() - 1000);
  CHECK(sealer.digest() == digest_of(noise.data(), noise.size()));
  const XXH128_hash_t library = XXH3_128bits(noise.data(), noise.size());
  CHECK(sealer.digest() == Digest{library.high64, library.low64});
  Digest parsed;
  CHECK(parse_seal("xxh3:99aa06d3014798d86001c324468d497f", parsed));
  CHECK(parsed == digest_of("", 0));
  CHECK_FALSE(parse_seal("xxh3:99aa06d3014798d86001c324468d497", parsed));
  CHECK_FALSE(parse_seal("xxh3:99aa06d3014798d86001c324468d497g", parsed));
}

#ifdef __x86_64__
TEST_CASE("the hash leaves no vector registers in use, which would make code without AVX slow") {
  if (!__builtin_cpu_supports("xsavec")) return;  // processors since 2015 tell what is in use
  const auto in_use = [] {
    unsigned low = 0;
    unsigned high = 0;
    asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
    constexpr unsigned upper_halves = 4;
    return (low & upper_halves) != 0;
  };
  const std::vector<char> bytes(100'000, 'x');
  (void)digest_of(bytes.data(), bytes.size());
  CHECK_FALSE(in_use());
  Sealer sealer;
  sealer.add(bytes.data(), bytes.size());
  CHECK_FALSE(in_use());
  (void)sealer.digest();
  CHECK_FALSE(in_use());
}
#endif
