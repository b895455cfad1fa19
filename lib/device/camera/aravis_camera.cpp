// SPDX-License-Identifier: GPL-3.0-or-later
// GenICam cameras (USB3 Vision, GigE Vision) by Aravis. glib stays in the aravis_ sources.
#include <arv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <mutex>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/private/aravis_clock.hpp"
#include "device/camera/private/aravis_levels.hpp"
#include "device/camera/private/aravis_problem.hpp"
#include "device/camera/private/frame_count.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/os/identity.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class Object>
using Handle = std::unique_ptr<Object, Unref>;

struct Format {
  const char* name;
  ArvPixelFormat code;
  PixelLayout layout;
  int bits;
};
constexpr std::array formats{Format{"Mono8", ARV_PIXEL_FORMAT_MONO_8, PixelLayout::bytes, 8},
                             Format{"Mono16", ARV_PIXEL_FORMAT_MONO_16, PixelLayout::words, 16},
                             Format{"Mono12", ARV_PIXEL_FORMAT_MONO_12, PixelLayout::words, 12},
                             Format{"Mono10", ARV_PIXEL_FORMAT_MONO_10, PixelLayout::words, 10}};

// A camera that is gone answers nothing, and taking its objects down waits 10 s for it: they are left to the process'
// end instead.
void abandon(GObject* object) {
  static std::mutex guard;
  static std::vector<GObject*> abandoned;
  const std::lock_guard lock(guard);
  abandoned.push_back(object);
}

// The kernel's memory for USB transfers, where it is reported: too little of it makes frames of more than a megabyte
// fail.
void check_usb_memory(std::size_t needed_bytes) {
  std::ifstream file("/sys/module/usbcore/parameters/usbfs_memory_mb");
  double megabytes = 0;
  if (!(file >> megabytes) || megabytes == 0 || 1e6 * megabytes >= static_cast<double>(needed_bytes)) return;
  warn("usbfs_memory_mb is " + format_number(megabytes) + ", but the camera's buffers need " +
       format_number(std::ceil(1e-6 * static_cast<double>(needed_bytes))) +
       "; write more into /sys/module/usbcore/parameters/usbfs_memory_mb");
}

// CLOCK_MONOTONIC of a moment that Aravis gave on CLOCK_REALTIME.
double monotonic_s(std::uint64_t system_ns, Clock& clock) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const std::uint64_t whole_s = system_ns / 1000000000;
  const std::uint64_t rest_ns = system_ns % 1000000000;
  const double age_s = static_cast<double>(now.tv_sec) - static_cast<double>(whole_s) +
                       1e-9 * (static_cast<double>(now.tv_nsec) - static_cast<double>(rest_ns));
  return clock.now_s() - std::clamp(age_s, 0.0, 10.0);
}

class AravisCamera final : public Camera {
 public:
  AravisCamera(const Address& address, const CameraSettings& settings, Clock& clock)
      : name_(address.text), settings_(settings), clock_(clock) {
    AravisProblem problem;
    camera_.reset(arv_camera_new(address.place.empty() ? nullptr : address.place.c_str(), problem));
    if (!camera_) throw Error{Fault::absent, name_ + ": no such camera (" + problem.text() + ")"};
    g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(note_lost), &lost_);
    if (const auto bytes = address.integer("packet_size", 576, 9000)) {
      arv_camera_gv_set_packet_size(camera_.get(), *bytes, problem);
      check(problem, "packet size");
    }
    choose_format();
    set_binning();
    set_levels(camera_.get(), name_, settings_, mode_);
    set_exposure();
    set_rate();
    set_trigger();
    read_mode();
    read_clock();
    open_stream(address.integer("buffers", 10, 1000).value_or(20));
  }

  ~AravisCamera() override {
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &lost_);
    if (lost_) {
      if (stream_) abandon(G_OBJECT(stream_.release()));
      abandon(G_OBJECT(camera_.release()));
      return;
    }
    AravisProblem problem;
    if (streaming_) arv_camera_stop_acquisition(camera_.get(), problem);
  }

  Json identify() override {
    AravisProblem problem;
    const auto text = [&](const char* value) { return value == nullptr ? Json() : Json(value); };
    Json about{{"maker", text(arv_camera_get_vendor_name(camera_.get(), problem))},
               {"model", text(arv_camera_get_model_name(camera_.get(), problem))},
               {"serial", text(arv_camera_get_device_serial_number(camera_.get(), problem))}};
    for (const char* feature : {"DeviceFirmwareVersion", "DeviceVersion"}) {
      if (!has(feature)) continue;
      about["firmware"] = text(arv_camera_get_string(camera_.get(), feature, problem));
      break;
    }
    about["transport"] = arv_camera_is_gv_device(camera_.get())   ? "GigE Vision"
                         : arv_camera_is_uv_device(camera_.get()) ? "USB3 Vision"
                                                                  : "other";
    about["stamp"] = camera_clock_->ready() ? word_of(moment_) : "arrival";
    return with_mark(about);
  }

  CameraMode mode() const override { return mode_; }

  void start() override {
    AravisProblem problem;
    arv_camera_start_acquisition(camera_.get(), problem);
    check(problem, "start of the acquisition");
    streaming_ = true;
    last_s_ = clock_.now_s();
  }

  void trigger() override {
    AravisProblem problem;
    arv_camera_software_trigger(camera_.get(), problem);
    check(problem, "software trigger");
  }

  std::optional<CapturedFrame> next() override {
    camera_clock_->refresh();
    const double patience_s = settings_.patience_s(mode_.fps > 0 ? 1 / mode_.fps : 0);
    const double limit_s = clock_.now_s() + patience_s;
    for (;;) {
      check_interrupted();
      if (ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), 50000)) return take(buffer);
      if (lost_) throw Error{Fault::absent, name_ + ": the camera is disconnected; check cable and power"};
      if (clock_.now_s() < limit_s) continue;
      AravisProblem problem;  // silent, or gone? It tells its width or it does not.
      arv_camera_get_integer(camera_.get(), "Width", problem);
      if (problem.there()) {
        lost_ = true;
        throw Error{Fault::absent, name_ + ": the camera is disconnected (" + problem.text() + ")"};
      }
      throw Error{Fault::busy, name_ + ": no frame within " + format_number(patience_s, 3) +
                                   " s, although the camera responds; check the trigger"};
    }
  }

 private:
  static void note_lost(ArvDevice*, std::atomic<bool>* lost) { *lost = true; }

  void check(const AravisProblem& problem, const std::string& what) {
    if (!problem.there()) return;
    if (problem.timed_out()) lost_ = true;
    throw Error{problem.timed_out() ? Fault::absent : Fault::protocol, name_ + ": " + what + ": " + problem.text()};
  }

  [[nodiscard]] bool has(const char* feature) const {
    AravisProblem problem;
    return arv_camera_is_feature_available(camera_.get(), feature, problem) != 0;
  }

  void same(const std::string& what, double wanted, double got, double grain) const {
    require_read_back(name_ + ": " + what, wanted, got, grain);
  }

  void choose_format() {
    AravisProblem problem;
    guint count = 0;
    const char** names = arv_camera_dup_available_pixel_formats_as_strings(camera_.get(), &count, problem);
    check(problem, "pixel formats");
    std::vector<std::string> offered(names, names + count);
    g_free(names);
    const auto* chosen = std::find_if(formats.begin(), formats.end(), [&](const Format& format) {
      if (!settings_.format.empty() && settings_.format != format.name) return false;
      return std::find(offered.begin(), offered.end(), format.name) != offered.end();
    });
    if (chosen == formats.end()) {
      throw Error{Fault::usage, name_ + ": no pixel format " +
                                    (settings_.format.empty() ? "Mono8 to Mono16" : settings_.format) +
                                    "; the camera has " + join(offered, ", ")};
    }
    format_ = *chosen;
    arv_camera_set_pixel_format(camera_.get(), format_.code, problem);
    check(problem, "pixel format");
    if (arv_camera_get_pixel_format(camera_.get(), problem) != format_.code) {
      throw Error{Fault::protocol, name_ + ": pixel format set to another value than " + format_.name};
    }
  }

  // Before anybody looks at the region: binning changes its limits.
  void set_binning() {
    AravisProblem problem;
    const bool able = arv_camera_is_binning_available(camera_.get(), problem) != 0;
    int across = 1;
    int down = 1;
    if (settings_.binning && able) {
      arv_camera_set_binning(camera_.get(), *settings_.binning, *settings_.binning, problem);
      check(problem, "binning");
    }
    if (able) arv_camera_get_binning(camera_.get(), &across, &down, problem);
    const int wanted = settings_.binning.value_or(across);
    if (across != wanted || down != wanted) {
      throw Error{able ? Fault::protocol : Fault::usage, name_ + ": binning is " + std::to_string(across) + " x " +
                                                             std::to_string(down) + ", not " + std::to_string(wanted)};
    }
    mode_.binning = across;
    if (settings_.binning && able) use_whole_sensor();
  }

  void use_whole_sensor() {
    AravisProblem problem;
    int least = 0;
    int width = 0;
    int height = 0;
    arv_camera_get_width_bounds(camera_.get(), &least, &width, problem);
    arv_camera_get_height_bounds(camera_.get(), &least, &height, problem);
    check(problem, "size");
    arv_camera_set_region(camera_.get(), 0, 0, width, height, problem);
    check(problem, "region");
  }

  void set_exposure() {
    if (!settings_.exposure_us) return;
    AravisProblem problem;
    arv_camera_set_exposure_time(camera_.get(), *settings_.exposure_us, problem);
    check(problem, "exposure");
  }

  // Point Grey and FLIR do not apply the rate until it is enabled, under names that differ from model to model.
  void set_rate() {
    if (!settings_.fps) return;
    AravisProblem problem;
    if (has("AcquisitionFrameRateAuto"))
      arv_camera_set_string(camera_.get(), "AcquisitionFrameRateAuto", "Off", problem);
    for (const char* name : {"AcquisitionFrameRateEnable", "AcquisitionFrameRateEnabled"}) {
      if (has(name)) arv_camera_set_boolean(camera_.get(), name, TRUE, problem);
    }
    arv_camera_set_frame_rate(camera_.get(), *settings_.fps, problem);
    check(problem, "frame rate");
  }

  void set_trigger() {
    AravisProblem problem;
    if (settings_.trigger == "free") {
      arv_camera_clear_triggers(camera_.get(), problem);
      return;
    }
    const std::string source = settings_.trigger == "software" ? "Software" : settings_.trigger;
    guint count = 0;
    const char** names = arv_camera_dup_available_trigger_sources(camera_.get(), &count, problem);
    const std::vector<std::string> offered(names, names == nullptr ? names : names + count);
    g_free(names);
    if (std::find(offered.begin(), offered.end(), source) == offered.end()) {
      throw Error{Fault::usage, name_ + ": no trigger " + source + "; the camera has " + join(offered, ", ")};
    }
    arv_camera_set_trigger(camera_.get(), source.c_str(), problem);
    check(problem, "trigger");
  }

  void read_mode() {
    AravisProblem problem;
    int x = 0;
    int y = 0;
    arv_camera_get_region(camera_.get(), &x, &y, &mode_.columns, &mode_.rows, problem);
    check(problem, "region");
    mode_.bits = format_.bits;
    if (arv_camera_is_exposure_time_available(camera_.get(), problem) != 0) {
      mode_.exposure_us = arv_camera_get_exposure_time(camera_.get(), problem);
    }
    if (arv_camera_is_frame_rate_available(camera_.get(), problem) != 0) {
      mode_.fps = arv_camera_get_frame_rate(camera_.get(), problem);
    }
    if (settings_.exposure_us) same("exposure", *settings_.exposure_us, mode_.exposure_us, 1);
    if (settings_.fps && settings_.trigger == "free") same("frame rate", *settings_.fps, mode_.fps, 0);
  }

  void read_clock() {
    AravisProblem problem;
    const char* maker = arv_camera_get_vendor_name(camera_.get(), problem);
    moment_ = stamp_moment(settings_.stamp, maker == nullptr ? "" : maker);
    camera_clock_.emplace(camera_.get(), name_, clock_);
  }

  // The middle of the exposure. Where the camera's clock cannot be read its stamps are as good as the shortest way of
  // a frame, which begins at the end of the exposure whatever moment they name.
  double middle_s(double device_s, double arrived_s) {
    const double exposure_s = 1e-6 * mode_.exposure_us;
    if (const auto host_s = camera_clock_->host_s(device_s, arrived_s, exposure_s)) {
      return *host_s + to_middle_s(moment_, exposure_s);
    }
    return stamps_.host_s(device_s, arrived_s) + to_middle_s(StampMoment::end, exposure_s);
  }

  void open_stream(int buffers) {
    AravisProblem problem;
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, problem));
    if (!stream_) throw Error{Fault::absent, name_ + ": no stream (" + problem.text() + ")"};
    const std::size_t payload = arv_camera_get_payload(camera_.get(), problem);
    check(problem, "payload");
    if (arv_camera_is_uv_device(camera_.get()) != 0) check_usb_memory(payload * static_cast<std::size_t>(buffers));
    payload_ = payload;
    for (int i = 0; i < buffers; ++i) give_back(arv_buffer_new(payload, nullptr));
  }

  // Cleared: what does not arrive next time shall not be of another moment.
  void give_back(ArvBuffer* buffer) {
    arv_buffer_set_frame_id(buffer, 0);
    std::memset(const_cast<void*>(arv_buffer_get_data(buffer, nullptr)), 0, payload_);
    arv_stream_push_buffer(stream_.get(), buffer);
  }

  // The status comes first: of a frame whose leader was lost, id, times and shape are those of the buffer's last use.
  CapturedFrame take(ArvBuffer* buffer) {
    const ArvBufferStatus status = arv_buffer_get_status(buffer);
    const std::uint64_t id = arv_buffer_get_frame_id(buffer);
    const bool known = status == ARV_BUFFER_STATUS_SUCCESS || id != 0;
    CapturedFrame frame;
    frame.complete = status == ARV_BUFFER_STATUS_SUCCESS;
    const bool usb = arv_camera_is_uv_device(camera_.get()) != 0;
    frame.number = count_.number(known || usb ? std::optional(id) : std::nullopt);
    frame.time_s =
        mode_.fps > 0 ? last_s_ + static_cast<double>(frame.number - last_number_) / mode_.fps : clock_.now_s();
    if (known) {
      frame.device_s = 1e-9 * static_cast<double>(arv_buffer_get_timestamp(buffer));
      frame.time_s = middle_s(*frame.device_s, monotonic_s(arv_buffer_get_system_timestamp(buffer), clock_));
      if (camera_clock_->ready()) frame.time_sigma_s = camera_clock_->sigma_s();
    }
    last_s_ = frame.time_s;
    last_number_ = frame.number;
    const auto other =  // Aravis tells the size of whole images only
        frame.complete ? another_size(mode_, arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer))
                       : std::nullopt;
    const auto* bytes = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, nullptr));
    const bool whole =
        to_grey({bytes, payload_}, mode_.columns, mode_.rows, 0, format_.layout, format_.bits, frame.levels);
    frame.complete = frame.complete && whole;
    give_back(buffer);
    if (other) throw Error{Fault::protocol, name_ + ": sends images of " + *other + "; run it again"};
    return frame;
  }

  std::string name_;
  CameraSettings settings_;
  Clock& clock_;
  std::atomic<bool> lost_{false};
  Handle<ArvCamera> camera_;
  Handle<ArvStream> stream_;  // after the camera, so that it goes first
  Format format_ = formats.front();
  CameraMode mode_;
  bool streaming_ = false;
  std::size_t payload_ = 0;
  FrameCount count_;
  StampMoment moment_ = StampMoment::end;
  std::optional<AravisClock> camera_clock_;
  StampClock stamps_;
  double last_s_ = 0;
  long last_number_ = 0;
};

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const Address& address, const CameraSettings& settings, Clock& clock) {
  return std::make_unique<AravisCamera>(address, settings, clock);
}

}  // namespace vam::device
