// SPDX-License-Identifier: GPL-3.0-or-later
// Where frames go: an EXR frame stack, a stream of small ones, or a folder that a later capture resumes.
#pragma once

#include <memory>
#include <string>

#include "base/text/json_fwd.hpp"
#include "device/camera/capture.hpp"
#include "io/exr/stack.hpp"

namespace vam::capture_tool {

class FrameStore {
 public:
  FrameStore() = default;
  virtual ~FrameStore() = default;
  FrameStore(const FrameStore&) = delete;
  FrameStore& operator=(const FrameStore&) = delete;
  [[nodiscard]] virtual bool wanted(long place) const = 0;
  virtual void keep(device::Shot&& shot) = 0;
  /// The numbers of the frames beside the gap tell, too.
  virtual void dropped(long /*first*/, long /*last*/) {}
  /// After the last frame that came, whether all did or a signal ended the capture. Throws Fault::io.
  virtual void close() {}
  /// When all frames came. Throws Error: io, no_output.
  virtual void commit() {}
};

/// Pixels become fractions of full scale. info.count frames make one stack.
[[nodiscard]] std::unique_ptr<FrameStore> open_stack(const std::string& path, const model::StackInfo& info,
                                                     const io::StackOptions& options);

/// Every frame is a stack of its own on the stream, as soon as it is there: for vam-ost --live.
[[nodiscard]] std::unique_ptr<FrameStore> open_stream(const std::string& path, const model::StackInfo& info,
                                                      const io::StackOptions& options);

/// head is the first line of the manifest.
[[nodiscard]] std::unique_ptr<FrameStore> open_folder(const std::string& path, const Json& head);

}  // namespace vam::capture_tool
