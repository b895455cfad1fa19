// Video4Linux2 by its own calls: streaming with memory-mapped buffers.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/private/frame_count.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/camera/private/read_back.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

class KernelV4l2 final : public V4l2Driver {
 public:
  ~KernelV4l2() override { KernelV4l2::close(); }
  int open(const char* path) override { return fd_ = ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC); }
  int control(unsigned long request, void* argument) override {
    int result = 0;
    do {
      result = ioctl(fd_, request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
  }
  void* map(std::size_t size, std::size_t offset) override {
    return mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(offset));
  }
  void unmap(void* start, std::size_t size) override { munmap(start, size); }
  int wait(double seconds) override {
    std::array<pollfd, 2> ready{pollfd{fd_, POLLIN, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
    if (poll(ready.data(), ready.size(), ceil_int(1e3 * seconds)) <= 0) return 0;
    if ((ready[0].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return -1;
    return (ready[0].revents & POLLIN) != 0 ? 1 : 0;
  }
  void close() override {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_ = -1;
};

struct Format {
  std::uint32_t code;
  const char* name;
  PixelLayout layout;
  int bits;
};
constexpr std::array formats{
    Format{V4L2_PIX_FMT_GREY, "GREY", PixelLayout::bytes, 8}, Format{V4L2_PIX_FMT_Y16, "Y16", PixelLayout::words, 16},
    Format{V4L2_PIX_FMT_Y12, "Y12", PixelLayout::words, 12}, Format{V4L2_PIX_FMT_Y10, "Y10", PixelLayout::words, 10},
    Format{V4L2_PIX_FMT_YUYV, "YUYV", PixelLayout::even_bytes, 8}};

struct Mapping {
  void* start = nullptr;
  std::size_t size = 0;
};

template <class Struct>
Struct cleared() {
  Struct value;
  std::memset(&value, 0, sizeof value);
  return value;
}

class V4l2Camera final : public Camera {
 public:
  V4l2Camera(const Address& address, const CameraSettings& settings, std::unique_ptr<V4l2Driver> driver, Clock& clock)
      : path_(address.place), settings_(settings), driver_(std::move(driver)), clock_(clock) {
    if (driver_->open(path_.c_str()) < 0) {
      const bool busy = errno == EBUSY;
      throw Error{busy ? Fault::busy : Fault::absent, path_ + ": cannot open: " + std::strerror(errno)};
    }
    check_capture();
    choose_format();
    set_levels();
    set_exposure();
    set_rate();
    map_buffers(address.integer("buffers", 2, 64).value_or(10));
  }

  ~V4l2Camera() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (streaming_) driver_->control(VIDIOC_STREAMOFF, &type);
    for (const auto& mapping : mappings_) driver_->unmap(mapping.start, mapping.size);
    driver_->close();
  }

  Json identify() override { return about_; }
  CameraMode mode() const override { return mode_; }
  void trigger() override { throw Error{Fault::usage, path_ + ": V4L2 has no software trigger"}; }

  void start() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    ask(VIDIOC_STREAMON, &type, "does not start (VIDIOC_STREAMON)");
    streaming_ = true;
  }

  std::optional<CapturedFrame> next() override {
    const double limit_s = clock_.now_s() + settings_.patience_s(mode_.fps > 0 ? 1 / mode_.fps : 1);
    for (;;) {
      check_interrupted();
      const double left_s = limit_s - clock_.now_s();
      if (left_s <= 0) {
        throw Error{Fault::busy, path_ + ": no frame within " +
                                     format_number(settings_.patience_s(mode_.fps > 0 ? 1 / mode_.fps : 1), 3) +
                                     " s; check the trigger and other streams"};
      }
      const int ready = driver_->wait(std::min(left_s, 0.2));
      if (ready < 0) throw gone();
      if (ready == 0) continue;
      auto buffer = capture_buffer();
      if (driver_->control(VIDIOC_DQBUF, &buffer) == 0) return take(buffer);
      if (errno != EAGAIN) throw gone();
    }
  }

 private:
  [[nodiscard]] Error gone() const {
    return {Fault::absent, path_ + ": the camera is disconnected (" + std::strerror(errno) + ")"};
  }

  void ask(unsigned long request, void* argument, const std::string& what) {
    if (driver_->control(request, argument) == 0) return;
    if (errno == ENODEV) throw gone();
    const Fault fault = errno == EBUSY ? Fault::busy : Fault::protocol;
    throw Error{fault, path_ + ": " + what + " (" + std::strerror(errno) + ")"};
  }

  static v4l2_buffer capture_buffer() {
    auto buffer = cleared<v4l2_buffer>();
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
  }

  void check_capture() {
    auto what = cleared<v4l2_capability>();
    ask(VIDIOC_QUERYCAP, &what, "is no video device (VIDIOC_QUERYCAP)");
    const std::uint32_t able = (what.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? what.device_caps : what.capabilities;
    if ((able & V4L2_CAP_VIDEO_CAPTURE) == 0 || (able & V4L2_CAP_STREAMING) == 0) {
      throw Error{Fault::usage, path_ + ": cannot stream images; a camera has several nodes, try the next"};
    }
    const auto text = [](const __u8* bytes) { return std::string(reinterpret_cast<const char*>(bytes)); };
    about_ = {{"maker", text(what.driver)}, {"model", text(what.card)}, {"serial", text(what.bus_info)}};
    if (settings_.stamp != "auto") about_["stamp"] = settings_.stamp;  // else each frame tells
    about_["firmware"] = std::to_string(what.version >> 16 & 255) + "." + std::to_string(what.version >> 8 & 255);
  }

  void choose_format() {
    std::vector<std::string> offered;
    for (std::uint32_t index = 0;; ++index) {
      auto found = cleared<v4l2_fmtdesc>();
      found.index = index;
      found.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
      if (driver_->control(VIDIOC_ENUM_FMT, &found) != 0) break;
      const auto* known =
          std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.code == found.pixelformat; });
      if (known != formats.end()) offered.emplace_back(known->name);
    }
    const auto has = [&](const std::string& name) {
      return std::find(offered.begin(), offered.end(), name) != offered.end();
    };
    const auto* chosen = std::find_if(formats.begin(), formats.end(), [&](const Format& f) {
      return settings_.format.empty() ? has(f.name) : f.name == settings_.format && has(f.name);
    });
    if (chosen == formats.end()) {
      throw Error{Fault::usage, path_ + ": no pixel format " +
                                    (settings_.format.empty() ? "for grey" : settings_.format) + "; it has " +
                                    (offered.empty() ? "no supported one" : join(offered, ", "))};
    }
    format_ = *chosen;
    auto size = cleared<v4l2_format>();
    size.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    ask(VIDIOC_G_FMT, &size, "does not report its format (VIDIOC_G_FMT)");
    size.fmt.pix.pixelformat = format_.code;
    ask(VIDIOC_S_FMT, &size, "rejects the format (VIDIOC_S_FMT)");
    if (size.fmt.pix.pixelformat != format_.code) {
      throw Error{Fault::protocol, path_ + ": pixel format set to another value than " + format_.name};
    }
    mode_.columns = static_cast<int>(size.fmt.pix.width);
    mode_.rows = static_cast<int>(size.fmt.pix.height);
    mode_.bits = format_.bits;
    stride_ = size.fmt.pix.bytesperline;
  }

  // Empty: the camera has no such control.
  std::optional<int> level(std::uint32_t id, std::optional<double> wanted, const std::string& what) {
    auto value = cleared<v4l2_control>();
    value.id = id;
    if (driver_->control(VIDIOC_G_CTRL, &value) != 0) {
      if (!wanted) return std::nullopt;
      throw Error{Fault::usage, path_ + ": has no setting for " + what + "; omit it"};
    }
    if (!wanted) return value.value;
    value.value = round_int(*wanted);
    ask(VIDIOC_S_CTRL, &value, "rejects the " + what + " (VIDIOC_S_CTRL)");
    ask(VIDIOC_G_CTRL, &value, "does not report the " + what + " (VIDIOC_G_CTRL)");
    check(what, *wanted, value.value, 0.5);
    return value.value;
  }

  // Automatics first: with one of them on a value holds until the next frame.
  void set_levels() {
    struct Automatic {
      std::uint32_t id;
      const char* name;
    };
    constexpr std::array automatics{Automatic{V4L2_CID_AUTOGAIN, "gain"},
                                    Automatic{V4L2_CID_AUTOBRIGHTNESS, "brightness"},
                                    Automatic{V4L2_CID_AUTO_WHITE_BALANCE, "white balance"},
                                    Automatic{V4L2_CID_EXPOSURE_AUTO_PRIORITY, "exposure priority"},
                                    Automatic{V4L2_CID_BACKLIGHT_COMPENSATION, "backlight compensation"}};
    for (const auto& [id, name] : automatics) {
      if (!level(id, std::nullopt, name)) continue;
      level(id, 0, std::string("automatic ") + name);
      mode_.automatic_off.emplace_back(name);
    }
    constexpr double hundredths = 100;  // USB Video Class 1.5, 4.2.2.3.12: 100 is linear
    const bool has_gamma = settings_.gamma != 1 || level(V4L2_CID_GAMMA, std::nullopt, "gamma");
    const auto gamma =
        has_gamma ? level(V4L2_CID_GAMMA, hundredths * settings_.gamma, "gamma in hundredths") : std::nullopt;
    if (gamma) mode_.gamma = *gamma / hundredths;
    mode_.gain = level(V4L2_CID_GAIN, settings_.gain, "gain");
    mode_.black_level = level(V4L2_CID_BRIGHTNESS, settings_.black_level, "black level (brightness)");
  }

  // Read back: a control that the camera rounds by more than a hundredth is not what was asked for.
  void set_exposure() {
    auto value = cleared<v4l2_control>();
    value.id = V4L2_CID_EXPOSURE_ABSOLUTE;  // 100 us
    if (settings_.exposure_us) {
      auto manual = cleared<v4l2_control>();
      manual.id = V4L2_CID_EXPOSURE_AUTO;
      manual.value = V4L2_EXPOSURE_MANUAL;
      driver_->control(VIDIOC_S_CTRL, &manual);  // a camera without automatics does not have it
      value.value = round_int(*settings_.exposure_us / 100);
      ask(VIDIOC_S_CTRL, &value, "rejects the exposure (VIDIOC_S_CTRL)");
    }
    if (driver_->control(VIDIOC_G_CTRL, &value) == 0) mode_.exposure_us = 100.0 * value.value;
    if (settings_.exposure_us) check("exposure", *settings_.exposure_us, mode_.exposure_us, 100);
  }

  void set_rate() {
    auto rate = cleared<v4l2_streamparm>();
    rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    auto& period = rate.parm.capture.timeperframe;
    if (settings_.fps) {
      period = {1000, static_cast<__u32>(std::lround(1000 * *settings_.fps))};
      ask(VIDIOC_S_PARM, &rate, "rejects the frame rate (VIDIOC_S_PARM)");
    } else if (driver_->control(VIDIOC_G_PARM, &rate) != 0) {
      return;
    }
    if (period.numerator > 0) mode_.fps = static_cast<double>(period.denominator) / period.numerator;
    if (settings_.fps) check("frame rate", *settings_.fps, mode_.fps, 0);
  }

  void check(const std::string& what, double wanted, double got, double grain) const {
    require_read_back(path_ + ": the " + what, wanted, got, grain);
  }

  void map_buffers(int count) {
    auto wanted = cleared<v4l2_requestbuffers>();
    wanted.count = static_cast<std::uint32_t>(count);
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    wanted.memory = V4L2_MEMORY_MMAP;
    ask(VIDIOC_REQBUFS, &wanted, "provides no buffers (VIDIOC_REQBUFS)");
    for (std::uint32_t i = 0; i < wanted.count; ++i) {
      auto buffer = capture_buffer();
      buffer.index = i;
      ask(VIDIOC_QUERYBUF, &buffer, "does not describe its buffers (VIDIOC_QUERYBUF)");
      void* start = driver_->map(buffer.length, buffer.m.offset);
      if (start == MAP_FAILED) throw Error{Fault::memory, path_ + ": a buffer cannot be mapped"};
      mappings_.push_back({start, buffer.length});
      ask(VIDIOC_QBUF, &buffer, "rejects a buffer (VIDIOC_QBUF)");
    }
    if (mappings_.empty()) throw Error{Fault::memory, path_ + ": provides no buffers"};
  }

  // As the driver says, unless the printer file knows better.
  StampMoment moment_of(const v4l2_buffer& buffer) {
    const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    const std::string driver = word_of(at_start ? StampMoment::start : StampMoment::end);
    return stamp_moment(settings_.stamp == "auto" ? driver : settings_.stamp, "");
  }

  CapturedFrame take(v4l2_buffer& buffer) {
    if (buffer.index >= mappings_.size()) throw Error{Fault::protocol, path_ + ": returned an unknown buffer"};
    const Mapping& mapping = mappings_[buffer.index];
    CapturedFrame frame;
    frame.number = count_.number(buffer.sequence);
    frame.complete = (buffer.flags & V4L2_BUF_FLAG_ERROR) == 0;
    const double stamp_s =
        static_cast<double>(buffer.timestamp.tv_sec) + 1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
    const bool monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    frame.time_s = monotonic ? stamp_s + to_middle_s(moment_of(buffer), 1e-6 * mode_.exposure_us)
                             : clock_.now_s() - 0.5e-6 * mode_.exposure_us;
    frame.device_s = stamp_s;
    const auto used = std::min<std::size_t>(buffer.bytesused, mapping.size);
    const bool whole = to_grey({static_cast<const std::uint8_t*>(mapping.start), used}, mode_.columns, mode_.rows,
                               stride_, format_.layout, format_.bits, frame.levels);
    frame.complete = frame.complete && whole;
    ask(VIDIOC_QBUF, &buffer, "rejects a returned buffer (VIDIOC_QBUF)");
    return frame;
  }

  std::string path_;
  CameraSettings settings_;
  std::unique_ptr<V4l2Driver> driver_;
  Clock& clock_;
  Json about_;
  CameraMode mode_;
  Format format_ = formats.front();
  std::size_t stride_ = 0;
  std::vector<Mapping> mappings_;
  bool streaming_ = false;
  FrameCount count_;
};

}  // namespace

std::unique_ptr<V4l2Driver> kernel_v4l2() { return std::make_unique<KernelV4l2>(); }

std::unique_ptr<Camera> open_v4l2_camera(const Address& address, const CameraSettings& settings,
                                         std::unique_ptr<V4l2Driver> driver, Clock& clock) {
  if (settings.binning.value_or(1) != 1 || settings.trigger != "free") {
    throw Error{Fault::usage, "device '" + address.text + "': V4L2 supports neither binning nor triggers"};
  }
  return std::make_unique<V4l2Camera>(address, settings, std::move(driver), clock);
}

}  // namespace vam::device
