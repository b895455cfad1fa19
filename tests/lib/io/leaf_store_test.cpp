// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes beyond what is kept in memory: 39,304 leaves, of which 16,384 keep their values.
#include <cstdlib>

#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Error;
using vam::Fault;

namespace {

constexpr int edge = 34 * 8;

/// No block is of one value; slice k of "time" t.
std::vector<float> slices_of(int k0, int count, int t) {
  std::vector<float> slices(static_cast<std::size_t>(count) * edge * edge);
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const auto place = static_cast<std::size_t>(k0) * edge * edge + i;
    slices[i] = static_cast<float>((place * 2654435761U + static_cast<std::size_t>(t) * 40503U) % 65521U) / 65536.0F;
  }
  return slices;
}

bool holds(const vam::io::SparseVolume& volume, int k0, int count, int t) {
  std::vector<float> read(static_cast<std::size_t>(count) * edge * edge);
  volume.read_slices(k0, count, read.data());
  return read == slices_of(k0, count, t);
}

vam::io::SparseVolume filled() {
  vam::io::SparseVolume volume("dose", vam::model::centred_grid(edge, edge, edge, 0.1));
  for (int k = 0; k < edge; k += 16) volume.write_slices(k, 16, slices_of(k, 16, 0).data());
  return volume;
}

}  // namespace

TEST_CASE("a volume beyond the leaves that stay in memory is read, changed and written to the bit") {
  vam::io::SparseVolume volume = filled();
  for (int k = 0; k < edge; k += 68) CHECK(holds(volume, k, 3, 0));  // in memory and in the file, across blocks

  volume.write_slices(3, 2, slices_of(3, 2, 1).data());  // parts of blocks
  volume.write_slices(261, 6, slices_of(261, 6, 2).data());
  CHECK(holds(volume, 3, 2, 1));
  CHECK(holds(volume, 5, 3, 0));
  CHECK(holds(volume, 261, 6, 2));
  CHECK(holds(volume, 258, 3, 0));

  const std::vector<float> even(static_cast<std::size_t>(8) * edge * edge, 0.25F);  // leaves go, their places are free
  volume.write_slices(264, 8, even.data());
  volume.write_slices(264, 8, slices_of(264, 8, 3).data());
  CHECK(holds(volume, 264, 8, 3));

  scratch::Folder folder;
  const std::string path = folder / "dose.vdb";
  vam::io::write_volume(path, volume);
  const vam::io::SparseVolume again = vam::io::read_volume(path, "dose");
  CHECK(holds(again, 0, 3, 0));
  CHECK(holds(again, 3, 2, 1));
  CHECK(holds(again, 128, 16, 0));
  CHECK(holds(again, 264, 8, 3));
  CHECK_NOTHROW(vam::io::check_values(path, again));
  CHECK(vam::io::farthest_mm(again, 0.5F) == doctest::Approx(vam::io::farthest_mm(volume, 0.5F)));
}

TEST_CASE("a volume that fits needs no scratch file; without a folder for one the error states the remedy") {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  setenv("TMPDIR", "/nonexistent", 1);
  vam::io::SparseVolume small("dose", vam::model::centred_grid(edge, edge, 8, 0.1));
  CHECK_NOTHROW(small.write_slices(0, 8, slices_of(0, 8, 0).data()));
  const std::string message = error_of([] { (void)filled(); }, Fault::no_output);
  CHECK(has(message, "/nonexistent: cannot create a scratch file"));
  CHECK(has(message, "set TMPDIR"));
  if (before == nullptr) {
    unsetenv("TMPDIR");
  } else {
    setenv("TMPDIR", kept.c_str(), 1);
  }
}
