// SPDX-License-Identifier: GPL-3.0-or-later
// An array, bare or the only one of an archive, image by image to its end, as the child reads it.
#include "io/array/private/array.hpp"

#include <algorithm>
#include <cstring>

#include "fuzz/fuzz.hpp"
#include "io/image/tiff_pages.hpp"

namespace {

using namespace vam;
using io::arrays::Bytes;

void read_all(io::arrays::Parser parser) {
  Image image;
  for (std::size_t k = 0; k < parser.size()[0]; ++k) parser.next(image);
}

void read_bare(const std::string& file) {
  std::size_t at = 0;
  const auto read = [&](void* to, std::size_t count) {
    const std::size_t step = std::min(count, file.size() - at);
    if (step > 0) std::memcpy(to, file.data() + at, step);
    at += step;
    return step;
  };
  Bytes bytes(read);
  double voxel_mm = 0;
  const auto head = file.starts_with(io::arrays::npy_magic) ? take_npy_head(bytes) : take_nrrd_head(bytes, voxel_mm);
  read_all({head, std::move(bytes), {2, 0, 1}});
}

void read_archive(const std::string& file) {
  io::ZipArchive archive(file, ".npz", false);
  std::uint64_t stated = 0;
  Bytes bytes = io::arrays::open_array(archive, "", "archive", stated);
  const auto head = take_npy_head(bytes);
  io::arrays::require_values(head, stated);
  read_all({head, std::move(bytes), {0, 1, 2}});
}

void read_pages(const std::string& file) {
  io::TiffPages about;
  const auto read = io::open_tiff_pages(file, about);
  std::string row(4096, ' ');
  while (read(row.data(), row.size()) == row.size()) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string file = fuzz::text_of(bytes, size);
  return fuzz::attempt_in_child([&] {
    if (file.starts_with("PK")) return read_archive(file);
    if (file.starts_with("II") || file.starts_with("MM")) return read_pages(file);
    read_bare(file);
  });
}
