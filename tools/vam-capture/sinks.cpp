// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-capture/sinks.hpp"

#include <set>

#include "base/text/json.hpp"
#include "io/image/capture_folder.hpp"

namespace vam::capture_tool {

namespace {

Image fractions(const GreyImage& levels) {
  Image image(levels.width, levels.height);
  const auto full = static_cast<float>(levels.full());
  for (std::size_t i = 0; i < image.size(); ++i) image.values[i] = static_cast<float>(levels.values[i]) / full;
  return image;
}

model::ImageInfo about(const device::Shot& shot, double z_mm) {
  model::ImageInfo info;
  info.z_mm = z_mm;
  info.has_angle = shot.angle.has_value();
  info.angle_deg = shot.angle ? shot.angle->angle_deg : 0;
  info.has_time = true;
  info.time_s = shot.frame.time_s;
  info.time_sigma_s = shot.frame.time_sigma_s;
  info.has_number = true;
  info.number = static_cast<int>(shot.frame.number);
  info.incomplete = !shot.frame.complete;
  return info;
}

class StackStore final : public FrameStore {
 public:
  StackStore(const std::string& path, const model::StackInfo& info, const io::StackOptions& options)
      : info_(info), writer_(path, info, options) {}
  [[nodiscard]] bool wanted(long place) const override { return !kept_.contains(place); }
  void keep(device::Shot&& shot) override {
    kept_.insert(shot.place);
    writer_.write(fractions(shot.frame.levels), about(shot, info_.z_start_mm));
  }
  void commit() override { writer_.commit(); }

 private:
  model::StackInfo info_;
  io::StackWriter writer_;
  std::set<long> kept_;  // places, in ascending order
};

class StreamStore final : public FrameStore {
 public:
  StreamStore(const std::string& path, const model::StackInfo& info, const io::StackOptions& options)
      : path_(path), info_(info), options_(options) {
    info_.count = 1;
  }
  [[nodiscard]] bool wanted(long place) const override { return place >= next_; }
  void keep(device::Shot&& shot) override {
    next_ = shot.place + 1;
    io::StackWriter writer(path_, info_, {about(shot, info_.z_start_mm)}, options_);
    writer.write(fractions(shot.frame.levels));
    writer.commit();
  }

 private:
  std::string path_;
  model::StackInfo info_;
  io::StackOptions options_;
  long next_ = 0;
};

class FolderStore final : public FrameStore {
 public:
  FolderStore(const std::string& path, const Json& head) : folder_(path, head) {}
  [[nodiscard]] bool wanted(long place) const override { return !folder_.has(place); }
  void keep(device::Shot&& shot) override {
    io::CaptureRecord record;
    record.place = shot.place;
    record.number = shot.frame.number;
    record.t_monotonic_s = shot.frame.time_s;
    if (shot.frame.time_sigma_s > 0) record.time_sigma_s = shot.frame.time_sigma_s;
    record.device_s = shot.frame.device_s;
    if (shot.angle) {
      record.angle_deg = shot.angle->angle_deg;
      record.sigma_deg = shot.angle->sigma_deg;
    }
    record.complete = shot.frame.complete;
    folder_.keep(record, shot.frame.levels);
  }
  void dropped(long first, long last) override { folder_.dropped(first, last); }
  void close() override { folder_.end(); }

 private:
  io::CaptureFolder folder_;
};

}  // namespace

std::unique_ptr<FrameStore> open_stack(const std::string& path, const model::StackInfo& info,
                                       const io::StackOptions& options) {
  return std::make_unique<StackStore>(path, info, options);
}

std::unique_ptr<FrameStore> open_stream(const std::string& path, const model::StackInfo& info,
                                        const io::StackOptions& options) {
  return std::make_unique<StreamStore>(path, info, options);
}

std::unique_ptr<FrameStore> open_folder(const std::string& path, const Json& head) {
  return std::make_unique<FolderStore>(path, head);
}

}  // namespace vam::capture_tool
