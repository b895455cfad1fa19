#include "io/image/image_file.hpp"

#include "base/error.hpp"
#include "io/image/private/decoders.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

bool is_tiff(const std::string& bytes) {
  using namespace std::string_literals;
  return bytes.starts_with("II*\0"s) || bytes.starts_with("MM\0*"s);
}

}  // namespace

GreyImage read_image(const std::string& path) {
  const std::string bytes = read_all(path, Content::binary, std::uint64_t{1} << 30);
  const std::string name = input_name(path);
  if (is_png(bytes)) return decode_png(bytes, name);
  if (is_tiff(bytes)) return decode_tiff(bytes, name);
  throw Error{Fault::data, name + ": neither PNG nor TIFF; convert it first"};
}

}  // namespace vam::io
