// SPDX-License-Identifier: GPL-3.0-or-later
// Folders of numbered images, in the order of their numbers.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "io/image/image_file.hpp"
#include "io/image/private/image_batch.hpp"

namespace vam::io {

namespace {

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

}  // namespace vam::io
