// SPDX-License-Identifier: GPL-3.0-or-later
// The manifest in a folder of camera frames.
#include <filesystem>
#include <fstream>

#include "fuzz/fuzz.hpp"
#include "io/image/capture_folder.hpp"

namespace {

struct Folder {
  Folder() {
    if (mkdtemp(path.data()) == nullptr) abort();
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string path = "/tmp/fuzz-manifest-XXXXXX";
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const Folder folder;
  std::ofstream(folder.path + "/manifest.jsonl", std::ios::binary) << fuzz::text_of(bytes, size);
  return fuzz::attempt([&] { (void)vam::io::read_manifest(folder.path); });
}
