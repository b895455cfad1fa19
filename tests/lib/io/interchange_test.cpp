// SPDX-License-Identifier: GPL-3.0-or-later
// The programs that others use on these formats open what is written here.
#include <cstdlib>

#include "io/exr/stack.hpp"
#include "io/vdb/vdb.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

// Standard output of a shell command, or nothing where `program` is not installed, which is reported.
std::string output_of(const std::string& program, const std::string& command, const scratch::Folder& folder) {
  if (std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) != 0) {
    MESSAGE("skipped: " << program << " is not installed");
    return {};
  }
  CHECK(std::system((command + " >" + (folder / "output") + " 2>&1").c_str()) == 0);
  return scratch::slurp(folder / "output");
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("exrheader and exrmultipart read a stack, from a file and from a pipe") {
  const scratch::Folder folder;
  model::StackInfo info{.width = 7, .height = 5, .count = 3, .pixel_mm = 0.065};
  for (const bool piped : {false, true}) {
    {
      const scratch::Redirect to(STDOUT_FILENO, folder / "piped.exr");
      io::StackWriter writer(piped ? "-" : folder / "file.exr", info);
      for (int i = 0; i < info.count; ++i) writer.write(Image(7, 5, 0.5F));
      writer.commit();
    }
    const std::string path = folder / (piped ? "piped.exr" : "file.exr");
    const std::string header = output_of("exrheader", "exrheader " + path, folder);
    if (header.empty()) return;
    CHECK(holds(header, "name (type string): \"z0002\""));
    CHECK(holds(header, "vam:pixel_mm (type double): 0.065"));
    // It decodes every pixel of every part.
    output_of("exrmultipart", "exrmultipart -separate -i " + path + " -o " + (folder / "part"), folder);
    CHECK(std::filesystem::exists(folder / "part.3.exr"));
  }
}

TEST_CASE("vdb_print and pyopenvdb read a volume, from a file and from a pipe") {
  const scratch::Folder folder;
  io::SparseVolume volume("target", model::centred_grid(9, 9, 9, 0.5));
  std::vector<float> values(9 * 9 * 9, 0.0F);
  for (std::size_t i = 0; i < 100; ++i) values[i] = 0.25F;
  volume.write_slices(0, 9, values.data());
  volume.history = {"vam-slice part.stl"};
  for (const bool piped : {false, true}) {
    const std::string path = folder / (piped ? "piped.vdb" : "file.vdb");
    {
      const scratch::Redirect to(STDOUT_FILENO, folder / "piped.vdb");
      io::write_volume(piped ? "-" : path, volume);
    }
    const std::string printed = output_of("vdb_print", "vdb_print -m " + path, folder);
    if (!printed.empty()) {
      CHECK(holds(printed, "vam:history: vam-slice part.stl"));
      CHECK(holds(printed, "vam:shape: [9, 9, 9]"));
      CHECK(holds(printed, "class: fog volume"));
    }
    const std::string python =
        "/usr/bin/python3 -c 'import pyopenvdb as v; g = v.read(\"" + path +
        "\", \"target\"); print(g.activeVoxelCount(), g.getConstAccessor().getValue((0, 0, 1)))'";
    if (std::system("/usr/bin/python3 -c 'import pyopenvdb' 2>/dev/null") != 0) {
      MESSAGE("skipped: pyopenvdb is not installed");
      continue;
    }
    CHECK(holds(output_of("/usr/bin/python3", python, folder), "100 0.25"));
  }
}
