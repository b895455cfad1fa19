// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-capture/recording.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "io/exr/stack.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/image_file.hpp"

namespace vam::capture_tool {

namespace {

using device::CapturedFrame;

// Every frame of a folder of vam-capture, by its manifest.
device::CameraFeed folder_feed(const std::string& place) {
  auto manifest = std::make_shared<io::CaptureManifest>(io::open_capture(place));
  return [manifest, place, next = manifest->frames.begin()](CapturedFrame& frame) mutable {
    if (next == manifest->frames.end()) return false;
    const io::CaptureRecord& record = next->second;
    frame.levels = io::read_captured(place, record);
    frame.number = record.number;
    frame.time_s = record.t_monotonic_s;
    frame.time_sigma_s = record.time_sigma_s.value_or(0);
    frame.device_s = record.device_s;
    frame.complete = record.complete;
    frame.angle_deg = record.angle_deg;
    ++next;
    return true;
  };
}

device::CameraFeed image_feed(const std::string& place) {
  auto folder = std::make_shared<io::ImageFolder>(place);
  return [folder, next = 0](CapturedFrame& frame) mutable {
    if (next == folder->count()) return false;
    frame = {};
    frame.levels = folder->read(next);
    frame.number = next++;
    return true;
  };
}

bool are_levels(const Image& image, int full) {
  return std::all_of(image.values.begin(), image.values.end(), [&](float value) {
    const float level = value * static_cast<float>(full);
    return std::abs(level - std::round(level)) < 1e-3F;
  });
}

GreyImage to_levels(const Image& image, int bits, const std::string& what) {
  GreyImage levels(image.width, image.height, bits);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float value = image.values[i];
    if (value < 0 || value > 1) {
      throw Error{Fault::data, what + ": a pixel is outside 0 to 1 and thus not a fraction of full scale"};
    }
    levels.values[i] = static_cast<std::uint16_t>(std::lround(value * static_cast<float>(levels.full())));
  }
  return levels;
}

device::CameraFeed stack_feed(const std::string& place) {
  auto reader = std::make_shared<io::StackReader>(place, true);
  io::require(place, reader->info(), model::Kind::frames, model::Space::camera);
  return [reader, place, next = 0, bits = 0](CapturedFrame& frame) mutable {
    Image image;
    model::ImageInfo about;
    while (!reader->next(image, about)) {
      if (!reader->next_stack()) return false;
    }
    if (bits == 0) bits = are_levels(image, 255) ? 8 : 16;
    frame = {};
    frame.levels = to_levels(image, bits, place + ": frame " + std::to_string(next));
    frame.number = about.has_number ? about.number : next;
    frame.complete = !about.incomplete;
    if (about.has_time) frame.time_s = about.time_s;
    frame.time_sigma_s = about.time_sigma_s;
    if (about.has_angle || reader->info().angle_step_deg != 0) frame.angle_deg = about.angle_deg;
    ++next;
    return true;
  };
}

}  // namespace

device::CameraFeed open_recording(const std::string& place) {
  if (!std::filesystem::is_directory(place)) return stack_feed(place);
  return io::is_capture_folder(place) ? folder_feed(place) : image_feed(place);
}

}  // namespace vam::capture_tool
