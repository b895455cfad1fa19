// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/npz.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::io::arrays {

namespace {

constexpr std::string_view ending = ".npy";

std::string chosen(const ZipArchive& archive, const std::string& name, const std::string& file) {
  std::vector<std::string> names;
  for (const std::string& all : archive.names()) {
    if (all.ends_with(ending)) names.push_back(all.substr(0, all.size() - ending.size()));
  }
  if (names.empty()) throw Error{Fault::data, file + ": is a zip archive without an array (.npy)"};
  if (name.empty() && names.size() == 1) return names.front();
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  constexpr std::size_t most = 8;
  std::vector<std::string> some;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) some.push_back(briefly(names[i]));
  const std::string has = "holds " + std::to_string(names.size()) + " arrays (" + join(some, ", ") + ")";
  throw Error{Fault::usage,
              file + ": " + has + (name.empty() ? "; name one by --array" : ", but none is called " + printable(name))};
}

}  // namespace

Bytes open_array(ZipArchive& archive, const std::string& name, const std::string& file, std::uint64_t& stated) {
  stated = archive.open(chosen(archive, name, file) + std::string(ending));
  return Bytes([&archive](void* to, std::size_t size) { return archive.read(to, size); });
}

void require_values(const Head& head, std::uint64_t stated) {
  const std::uint64_t promised = head.values() * static_cast<std::uint64_t>(head.bytes);
  if (promised <= stated) return;
  throw std::runtime_error("is cut off: its header promises " + std::to_string(promised) +
                           " bytes, but the archive has " + std::to_string(stated) +
                           "; the program that wrote it did not finish");
}

}  // namespace vam::io::arrays
