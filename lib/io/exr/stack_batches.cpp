// SPDX-License-Identifier: GPL-3.0-or-later
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

void WriteBehind::put(std::vector<Image> images) {
  // Copied, not moved: where no thread is to be had, std::async takes it a second time.
  const auto held = std::make_shared<const std::vector<Image>>(std::move(images));
  const auto write = [&writer = writer_, held] {
    for (const Image& image : *held) writer.write(image);
  };
  finish();
  writing_ = std::async(std::launch::async | std::launch::deferred, write);
}

void WriteBehind::finish() {
  if (writing_.valid()) writing_.get();
}

void transform(StackReader& in, StackWriter& out, int batch,
               const std::function<std::vector<Image>(const std::vector<Image>&)>& work) {
  ReadAhead reader(in, batch);
  WriteBehind writer(out);
  for (std::vector<Image> images = reader.next(); !images.empty(); images = reader.next()) writer.put(work(images));
  writer.finish();
}

}  // namespace vam::io
