// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <fstream>
#include <thread>

#include "lib/io/exr_stacks.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::stacks;

namespace {

double resident_mib() {
  std::ifstream statm("/proc/self/statm");
  long pages = 0;
  statm >> pages >> pages;
  return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace

TEST_CASE("five thousand parts go through a pipe, into a file and out of it in constant memory") {
#ifdef __SANITIZE_ADDRESS__
  MESSAGE("skipped: the sanitizer keeps freed memory");
  return;
#endif
  const scratch::Folder folder;
  const auto info = sinogram(80, 64, 5000);  // 98 MiB of pixels
  // Headers and offset tables: about 2 kB a part on each side. Of the pixels only a few images may be held at a time.
#ifdef __SANITIZE_THREAD__
  constexpr double allowed_mib = 4 * 40;  // every byte has shadows
#else
  constexpr double allowed_mib = 40;
#endif
  const Image image = pattern(80, 64, 1);
  const double before = resident_mib();
  double peak = before;
  const auto write = [&](const std::string& path, bool sample) {
    StackWriter writer(path, info, {false, "zip"});
    for (int i = 0; i < info.count; ++i) {
      writer.write(image);
      if (sample && i % 250 == 0) peak = std::max(peak, resident_mib());
    }
    writer.commit();
  };
  const auto read = [&](const std::string& path) {
    StackReader reader(path);
    Image got;
    model::ImageInfo about;
    int count = 0;
    for (; reader.next(got, about); ++count) {
      if (count % 250 == 0) peak = std::max(peak, resident_mib());
    }
    CHECK(count == 5000);
    CHECK(got.values == image.values);
  };
  const Fifo fifo(folder / "pipe");
  std::thread writer([&] { write(fifo.path, false); });
  read(fifo.path);
  writer.join();
  CHECK(peak - before < allowed_mib);
  write(folder / "s.exr", true);
  CHECK(peak - before < allowed_mib);
  read(folder / "s.exr");
  CHECK(peak - before < allowed_mib);
  MESSAGE("5,000 parts: " << peak - before << " MiB");
}
