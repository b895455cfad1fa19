// SPDX-License-Identifier: GPL-3.0-or-later
// Stacks in batches, with reading, computing and writing overlapped: the body of every tool that maps stack to stack.
#pragma once

#include <functional>
#include <future>
#include <vector>

#include "base/image.hpp"
#include "io/exr/stack.hpp"

namespace vam::io {

/// Reads the next batch of images on a thread of its own while the last one is worked on. Two batches are in memory.
class ReadAhead {
 public:
  ReadAhead(StackReader& reader, int batch);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  /// The next at most `batch` images; empty after the last. Throws what StackReader::next throws.
  [[nodiscard]] std::vector<Image> next();

 private:
  void start();
  StackReader& reader_;
  int batch_;
  std::future<std::vector<Image>> ahead_;
};

/// Writes batches of images on a thread of its own while the next one is made. finish() before the writer's commit.
class WriteBehind {
 public:
  explicit WriteBehind(StackWriter& writer) : writer_(writer) {}
  /// Waits for the batch before. Throws what StackWriter::write throws, of that batch.
  void put(std::vector<Image> images);
  void finish();

 private:
  StackWriter& writer_;
  std::future<void> writing_;
};

/// out = work(in) for all images, in order, `batch` at a time; memory for at most five batches. work returns as many
/// images as it got. The caller commits.
void transform(StackReader& in, StackWriter& out, int batch,
               const std::function<std::vector<Image>(const std::vector<Image>&)>& work);

}  // namespace vam::io
