// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 2000 -tc=damage sweep*
// Every cut and many corruptions of every format that is parsed by foreign libraries or by hand: status 0 or 65, never
// a signal, never long, never much memory. VAM_TRIALS corruptions a format, 200 by default; ctest --preset long has
// 2000.
#include <sys/resource.h>

#include "io/mesh/file.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "lib/io/box_mesh.hpp"
#include "lib/io/cpu_time.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "lib/io/zip_writer.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using namespace vam::io;

namespace {

struct Sample {
  std::string format;
  std::string bytes;
  std::function<void(const std::string& path)> read;
};

double most_mib() {  // of this process and the largest child so far
  long most = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    most = std::max(most, used.ru_maxrss);
  }
  return static_cast<double>(most) / 1024;
}

model::TriangleSoup tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

const std::string points_text = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string faces_text = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

std::string package() {
  std::string model =
      "<model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
      "<resources><object id=\"1\">";
  model += samples::mesh_xml(tetrahedron());
  model +=
      "</object><object id=\"2\"><components><component objectid=\"1\"/><component "
      "objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object></resources>"
      "<build><item objectid=\"2\"/></build></model>";
  samples::Zip zip;
  zip.add("3D/3dmodel.model", model);
  return zip.done();
}

std::vector<Sample> all_samples(const scratch::Folder& folder) {
  const auto mesh = [](const std::string& path) { (void)read_mesh(path); };
  const auto volumes = [](const std::string& path) { (void)read_volumes(path); };
  write_stl(folder / "a.stl", tetrahedron());
  write_ply(folder / "a.ply", tetrahedron());
  const auto grid = model::centred_grid(30, 30, 30, 0.1);
  SparseVolume volume = volumes::filled("target", grid, volumes::ball(grid));
  write_volume(folder / "a.vdb", volume);
  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "pipe.vdb");
    write_volume("-", volume);
  }
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  return {
      {"binary STL", scratch::slurp(folder / "a.stl"), mesh},
      {"binary PLY", scratch::slurp(folder / "a.ply"), mesh},
      {"PLY", ply + points_text + faces_text, mesh},
      {"OFF", "OFF\n4 4 0\n" + points_text + faces_text, mesh},
      {"OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2//2 4/3/3\nf -3 -2 -1\nf 1 4 3\n", mesh},
      {"STL",
       "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid a\n",
       mesh},
      {"3MF", package(), mesh},
      {"VDB", scratch::slurp(folder / "a.vdb"), volumes},
      {"VDB of a pipe", scratch::slurp(folder / "pipe.vdb"), volumes},
      {"TOML", printer_toml(model::Printer()), [](const std::string& path) { (void)load_printer(path, {}); }},
      {"CSV", "grey,intensity\n0,0.1\n128,1.5\n255,4\n", [](const std::string& path) { (void)read_response(path, 8); }},
      {"JSON", "{\"schema\": \"vam-resin/1\", \"isovalue\": 0.5, \"circle_px\": {\"x\": [1, 2, {\"y\": 3}]}}",
       [](const std::string& path) { (void)gelation_isovalue(path); }},
  };
}

std::string corrupted(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  const std::array<std::int64_t, 8> lies{0, -1, -4000, 2'000'000'000, INT32_MIN, INT64_MAX, INT64_MIN, 1 << 24};
  const std::array<std::string, 6> words{"2000000000", "-1", "1e999", "nan", "[[[[[[[[", "<a b=\"c\">"};
  const std::size_t at = below(bytes.size());
  const std::size_t rest = bytes.size() - at;
  switch (below(7)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(below(256));
      break;
    case 2: {
      const std::int64_t lie = lies[below(lies.size())];
      std::memcpy(bytes.data() + at, &lie, std::min(rest, below(2) == 0 ? sizeof lie : std::size_t{4}));
      break;
    }
    case 3:
      bytes.erase(at, 1 + below(rest));
      break;
    case 4:
      bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(200)));
      break;
    case 5:
      bytes.insert(at, words[below(words.size())]);
      break;
    default:
      for (std::size_t n = 0; n < 20; ++n) bytes[below(bytes.size())] = static_cast<char>(below(256));
  }
  return bytes;
}

}  // namespace

TEST_CASE("damage sweep: every cut and many corruptions of every format end with 0 or 65, soon and in little memory") {
  const scratch::Folder folder;
  const int trials = trials_or(200);
  for (const Sample& sample : all_samples(folder)) {
    CAPTURE(sample.format);
    std::mt19937 random(7);
    const auto read = [&](const std::string& bytes) {
      scratch::spill(folder / "damaged", bytes);
      const double begun_s = cpu_s();
      std::string line;
      const int ended = scratch::status([&] { sample.read(folder / "damaged"); }, &line);
      CAPTURE(line);
      CHECK((ended == 0 || ended == 65));
      CHECK(line.find('\n') == std::string::npos);
      CHECK(cpu_s() - begun_s < 2);
      return ended;
    };
    CHECK(read(sample.bytes) == 0);
    const std::size_t step = 1 + sample.bytes.size() / static_cast<std::size_t>(trials);
    for (std::size_t size = 0; size < sample.bytes.size(); size += step) {
      CAPTURE(size);
      read(sample.bytes.substr(0, size));
    }
    for (int trial = 0; trial < trials; ++trial) {
      CAPTURE(trial);
      read(corrupted(sample.bytes, random));
    }
    CHECK(most_mib() < 512);
  }
}
