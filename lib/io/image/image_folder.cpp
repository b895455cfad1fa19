// SPDX-License-Identifier: GPL-3.0-or-later
// Images are decoded in a child, folders of numbered ones in the order of their numbers, several by one child.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <system_error>
#include <tuple>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/pixels.hpp"
#include "base/system_error.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/decoders.hpp"
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

/// Reads the files and starts a child that decodes one after the other, ahead of who takes them.
class ImageBatch {
 public:
  /// Takes the first path and those after it that can be read, up to 128 files of together 64 MiB. Throws what
  /// read_all() throws of the first, and what SandboxedReader does.
  explicit ImageBatch(std::span<const std::string> paths) : ImageBatch(read_files(paths)) {}
  [[nodiscard]] int count() const { return count_; }
  /// The next one, `count` times. Errors of a batch of several name its first file, and the child's bounds are those of
  /// them all: read_image() tells which of them is damaged, and how.
  [[nodiscard]] GreyImage next() {
    GreyImage image;
    apart_.take([&](Receiver& in) { in.fill(members(image)); });
    if (!plausible(image)) throw Error{Fault::data, name_ + ": is damaged (its parser failed)"};
    if (++taken_ == count_) apart_.finish();
    return image;
  }

 private:
  // The child has the bytes, too, so that they end here.
  explicit ImageBatch(const std::vector<File>& files)
      : name_(files.front().name),
        count_(count_of(files)),
        apart_({name_, size_of(files), -1, most_unpacked}, [&](Sender& out) {
          for (const File& file : files) {
            send(is_png(file.bytes) ? decode_png(file.bytes, file.name) : decode_tiff(file.bytes, file.name), out);
          }
        }) {}

  std::string name_;
  int count_;
  int taken_ = 0;
  SandboxedReader apart_;
};

namespace fs = std::filesystem;

// The last run of digits in the name: "part-2_slice0017.png" is number 17.
long number_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) {
    throw Error{Fault::data, path.string() + ": the name has no number; number the images of a folder"};
  }
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  long number = 0;
  if (std::from_chars(stem.data() + first, stem.data() + last + 1, number).ec != std::errc{}) {
    throw Error{Fault::data, path.string() + ": the number in the name is too large"};
  }
  return number;
}

struct Numbered {
  long number;
  fs::path path;
};

long step_of(const std::vector<Numbered>& images) {
  long step = 0;
  for (std::size_t i = 1; i < images.size(); ++i) {
    const long gap = images[i].number - images[i - 1].number;
    if (gap == 0) {
      throw Error{Fault::data,
                  images[i].path.string() + ": has the same number as " + images[i - 1].path.filename().string()};
    }
    step = std::gcd(step, gap);
  }
  return std::max(1L, step);
}

// A missing layer would shorten the part unseen. The step between numbers may be other than 1, but must stay the same.
void require_no_gaps(const std::vector<Numbered>& images) {
  for (std::size_t i = 1; i < images.size(); ++i) {
    if (images[i].number - images[i - 1].number == images[1].number - images[0].number) continue;
    throw Error{Fault::data, images[i].path.string() + ": follows number " + std::to_string(images[i - 1].number) +
                                 ", but the previous images are " +
                                 std::to_string(images[1].number - images[0].number) + " apart; one is missing"};
  }
}

}  // namespace

bool is_image_file(const std::string& path, FolderOf of) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (of == FolderOf::exr) return extension == ".exr";
  return extension == ".png" || extension == ".tif" || extension == ".tiff";
}

bool is_exr_folder(const std::string& folder) {
  bool found = false;
  std::error_code problem;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
    if (is_image_file(entry->path(), FolderOf::grey)) return false;
    found = found || is_image_file(entry->path(), FolderOf::exr);
  }
  return found;
}

ImageFolder::ImageFolder(const std::string& folder, bool gaps, FolderOf of) {
  std::error_code problem;
  std::vector<Numbered> images;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
    if (is_image_file(entry->path(), of)) images.push_back({number_of(entry->path()), entry->path()});
  }
  if (problem) throw system_error(Fault::no_input, folder + ": cannot read the folder", problem.value());
  if (images.empty()) throw Error{Fault::data, folder + ": no PNG or TIFF image in the folder"};
  std::sort(images.begin(), images.end(), [](const Numbered& a, const Numbered& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  const long step = step_of(images);
  if (!gaps) require_no_gaps(images);
  first_number_ = images.front().number;
  for (const auto& image : images) {
    paths_.push_back(image.path.string());
    places_.push_back((image.number - images.front().number) / step);
  }
}

// Decoded ahead, by batches that grow while images are read one after the other: a child costs as much as the memory
// that it is forked with.
struct ImageFolder::Ahead {
  std::unique_ptr<ImageBatch> batch;
  int next = -1;  // image of the batch
  int left = 0;   // of it
  int size = 1;

  GreyImage read(std::span<const std::string> paths, int index) {
    const bool follows = index == next;
    next = index + 1;
    try {
      if (!follows || left == 0) {
        size = follows ? 4 * size : 1;
        const std::size_t rest = paths.size() - index;
        batch = std::make_unique<ImageBatch>(paths.subspan(index, std::min<std::size_t>(rest, size)));
        left = size = batch->count();
      }
      --left;
      return batch->next();
    } catch (const Error&) {
      batch.reset();
      left = 0;
      size = 1;
      return read_image(paths[index]);  // says which file it is, or reads it by bounds of its own
    }
  }
};

GreyImage ImageFolder::read(int index) {
  if (!ahead_) ahead_ = std::make_shared<Ahead>();
  GreyImage image = ahead_->read(paths_, index);
  if (width_ == 0) {
    width_ = image.width;
    height_ = image.height;
  }
  if (image.width != width_ || image.height != height_) {
    throw Error{Fault::data, path(index) + ": has " + std::to_string(image.width) + " x " +
                                 std::to_string(image.height) + " pixels, but those before have " +
                                 std::to_string(width_) + " x " + std::to_string(height_)};
  }
  return image;
}

Image fractions(const GreyImage& grey) {
  Image image(grey.width, grey.height);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.values[i] = static_cast<float>(grey.values[i]) / static_cast<float>(grey.full());
  }
  return image;
}

GreyImage read_image(const std::string& path) { return ImageBatch(std::span(&path, 1)).next(); }

void require_png(const std::string& bytes, const std::string& name) {
  read_apart(
      {name, bytes.size(), -1, most_unpacked},
      [&](Sender& out) {
        (void)decode_png(bytes, name);
        out.put(true);
      },
      [](Receiver& in) { (void)in.get<bool>(); });
}

}  // namespace vam::io
