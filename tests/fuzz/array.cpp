// A NumPy array, bare or the only one of an archive, image by image to its end, as the child reads it.
#include <algorithm>
#include <cstring>

#include "fuzz/fuzz.hpp"
#include "io/array/private/npy_parser.hpp"
#include "io/array/private/npz.hpp"

namespace {

using namespace vam;

void read_all(io::npy::Parser parser) {
  Image image;
  for (std::size_t k = 0; k < parser.size()[0]; ++k) parser.next(image);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string file = fuzz::text_of(bytes, size);
  std::size_t at = 0;
  const auto bare = [&](void* to, std::size_t count) {
    const std::size_t step = std::min(count, file.size() - at);
    std::memcpy(to, file.data() + at, step);
    at += step;
    return step;
  };
  try {
    if (!file.starts_with("PK")) return fuzz::attempt([&] { read_all({bare, "array", {2, 0, 1}}); });
    return fuzz::attempt([&] {
      io::npy::PackedArray array(file, "", "archive");
      read_all({[&](void* to, std::size_t count) { return array.read(to, count); }, "array", {0, 1, 2}});
    });
  } catch (const std::bad_alloc&) {  // the child has bounds for that
    return 0;
  }
}
