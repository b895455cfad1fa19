#include "io/exr/stack_batches.hpp"

#include <utility>

namespace vam::io {

ReadAhead::ReadAhead(StackReader& reader, int batch) : reader_(reader), batch_(batch) { start(); }

ReadAhead::~ReadAhead() {
  if (ahead_.valid()) ahead_.wait();
}

void ReadAhead::start() {
  ahead_ = std::async(std::launch::async, [this] {
    std::vector<Image> images;
    Image image;
    model::ImageInfo about;
    while (static_cast<int>(images.size()) < batch_ && reader_.next(image, about)) images.push_back(std::move(image));
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
    std::vector<Image> results = work(images);
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [&out, done = std::move(results)] {
      for (const Image& image : done) out.write(image);
    });
  }
  if (writing.valid()) writing.get();
}

}  // namespace vam::io
