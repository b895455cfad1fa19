// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/private/image_batch.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "io/image/private/decoders.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

// The largest image, as libtiff and GreyImage have it.
constexpr std::uint64_t most_unpacked = max_pixels * (sizeof(std::uint32_t) + sizeof(std::uint16_t));

struct File {
  std::string name;
  std::string bytes;
};

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

bool is_tiff(const std::string& bytes) {
  using namespace std::string_literals;
  return bytes.starts_with("II*\0"s) || bytes.starts_with("MM\0*"s);
}

File read_file(const std::string& path) {
  File file{input_name(path), read_all(path, Content::binary, std::uint64_t{1} << 30)};
  if (is_png(file.bytes) || is_tiff(file.bytes)) return file;
  throw Error{Fault::data, file.name + ": neither PNG nor TIFF; convert it first"};
}

// Those after the first that cannot be read are left to a batch that begins with them.
std::vector<File> read_files(std::span<const std::string> paths) {
  constexpr std::size_t most_files = 128;
  constexpr std::size_t most_bytes = std::size_t{1} << 26;
  std::vector<File> files{read_file(paths.front())};
  std::size_t bytes = files.front().bytes.size();
  for (std::size_t i = 1; i < std::min(paths.size(), most_files); ++i) {
    std::error_code unknown;
    const std::uintmax_t more = std::filesystem::file_size(paths[i], unknown);
    if (unknown || bytes + more > most_bytes) break;
    try {
      files.push_back(read_file(paths[i]));
    } catch (const Error&) {
      break;
    }
    bytes += files.back().bytes.size();
  }
  return files;
}

std::uint64_t size_of(const std::vector<File>& files) {
  std::uint64_t bytes = 0;
  for (const File& file : files) bytes += file.bytes.size();
  return bytes;
}

auto members(GreyImage& image) { return std::tie(image.width, image.height, image.bits, image.values); }

void send(GreyImage image, Sender& out) {
  out.put(members(image));
  out.flush();
}

// What a child sends is not believed.
bool plausible(const GreyImage& image) {
  return image.width > 0 && image.height > 0 && (image.bits == 8 || image.bits == 16) &&
         product(image.width, image.height) == image.values.size();
}

}  // namespace

struct ImageBatch::State {
  explicit State(const std::vector<File>& files)
      : name(files.front().name),
        count(count_of(files)),
        apart({files.front().name, size_of(files), -1, most_unpacked}, [&](Sender& out) {
          for (const File& file : files) {
            send(is_png(file.bytes) ? decode_png(file.bytes, file.name) : decode_tiff(file.bytes, file.name), out);
          }
        }) {}
  std::string name;
  int count;
  int taken = 0;
  SandboxedReader apart;
};

// The child has the bytes, too, so that they end here.
ImageBatch::ImageBatch(std::span<const std::string> paths) : state_(std::make_unique<State>(read_files(paths))) {}

ImageBatch::~ImageBatch() = default;

int ImageBatch::count() const { return state_->count; }

void require_png(const std::string& bytes, const std::string& name) {
  read_apart(
      {name, bytes.size(), -1, most_unpacked},
      [&](Sender& out) {
        (void)decode_png(bytes, name);
        out.put(true);
      },
      [](Receiver& in) { (void)in.get<bool>(); });
}

GreyImage ImageBatch::next() {
  GreyImage image;
  state_->apart.take([&](Receiver& in) { in.fill(members(image)); });
  if (!plausible(image)) throw Error{Fault::data, state_->name + ": is damaged (its parser failed)"};
  if (++state_->taken == state_->count) state_->apart.finish();
  return image;
}

}  // namespace vam::io
