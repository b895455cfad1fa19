#include "io/exr/stack_batches.hpp"

#include <memory>
#include <utility>

#include "base/index.hpp"

namespace vam::io {

ReadAhead::ReadAhead(StackReader& reader, int batch) : reader_(reader), batch_(batch) { start(); }

ReadAhead::~ReadAhead() {
  if (ahead_.valid()) ahead_.wait();
}

void ReadAhead::start() {
  ahead_ = std::async(std::launch::async | std::launch::deferred, [this] {
    std::vector<Image> images;
    Image image;
    model::ImageInfo about;
    while (count_of(images) < batch_ && reader_.next(image, about)) images.push_back(std::move(image));
    return images;
  });
}

std::vector<Image> ReadAhead::next() {
  if (!ahead_.valid()) return {};
  std::vector<Image> images = ahead_.get();
  if (!images.empty()) start();
  return images;
}

void transform(StackReader& in, StackWriter& out, int batch,
               const std::function<std::vector<Image>(const std::vector<Image>&)>& work) {
  ReadAhead reader(in, batch);
  std::future<void> writing;
  for (std::vector<Image> images = reader.next(); !images.empty(); images = reader.next()) {
    // Copied, not moved: where no thread is to be had, std::async takes it a second time.
    const auto results = std::make_shared<const std::vector<Image>>(work(images));
    const auto write = [&out, results] {
      for (const Image& image : *results) out.write(image);
    };
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async | std::launch::deferred, write);
  }
  if (writing.valid()) writing.get();
}

}  // namespace vam::io
