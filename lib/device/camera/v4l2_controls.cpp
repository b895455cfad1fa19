// SPDX-License-Identifier: GPL-3.0-or-later
#include <linux/videodev2.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/private/v4l2_node.hpp"

namespace vam::device {

namespace {

// A value that the camera rounds by more than a hundredth is not what was asked for.
void check(const V4l2Node& node, const std::string& what, double wanted, double got) {
  require_read_back(node.path + ": the " + what, wanted, got, 0);
}

// Empty: the camera has no such control.
std::optional<int> level(const V4l2Node& node, std::uint32_t id, std::optional<double> wanted,
                         const std::string& what) {
  auto value = cleared<v4l2_control>();
  value.id = id;
  if (node.driver->control(VIDIOC_G_CTRL, &value) != 0) {
    if (!wanted) return std::nullopt;
    throw Error{Fault::usage, node.path + ": has no setting for " + what + "; omit it"};
  }
  if (!wanted) return value.value;
  value.value = round_int(*wanted);
  node.ask(VIDIOC_S_CTRL, &value, "rejects the " + what + " (VIDIOC_S_CTRL)");
  node.ask(VIDIOC_G_CTRL, &value, "does not report the " + what + " (VIDIOC_G_CTRL)");
  check(node, what, *wanted, value.value);
  return value.value;
}

struct Automatic {
  std::uint32_t id;
  const char* name;
  int off = 0;
};
constexpr std::array automatics{Automatic{V4L2_CID_AUTOGAIN, "gain"},
                                Automatic{V4L2_CID_AUTOBRIGHTNESS, "brightness"},
                                Automatic{V4L2_CID_AUTO_WHITE_BALANCE, "white balance"},
                                Automatic{V4L2_CID_EXPOSURE_AUTO_PRIORITY, "exposure priority"},
                                Automatic{V4L2_CID_BACKLIGHT_COMPENSATION, "backlight compensation"},
                                Automatic{V4L2_CID_EXPOSURE_AUTO, "exposure", V4L2_EXPOSURE_MANUAL}};

// Nothing: it has no such control.
std::optional<int> automatic_now(const V4l2Node& node, const Automatic& automatic) {
  auto value = cleared<v4l2_control>();
  value.id = automatic.id;
  if (node.driver->control(VIDIOC_G_CTRL, &value) == 0) return value.value;
  if (errno == EINVAL || errno == ENOTTY) return std::nullopt;
  if (errno == ENODEV) throw node.gone();
  throw Error{Fault::protocol, node.path + ": does not report whether its automatic " + automatic.name + " is off (" +
                                   std::strerror(errno) + "); use another camera"};
}

// A driver may reject the value, or accept and ignore it: what counts is what it reads back as.
void switch_off(const V4l2Node& node, const Automatic& automatic) {
  auto off = cleared<v4l2_control>();
  off.id = automatic.id;
  off.value = automatic.off;
  const int reason = node.driver->control(VIDIOC_S_CTRL, &off) == 0 ? 0 : errno;
  const auto now = automatic_now(node, automatic);
  if (now == automatic.off) return;
  throw Error{Fault::protocol, node.path + ": automatic " + automatic.name + " cannot be switched off (" +
                                   (reason != 0 ? std::string(std::strerror(reason)) + ", " : "") + "reads back as " +
                                   (now ? std::to_string(*now) : "nothing") + " instead of " +
                                   std::to_string(automatic.off) +
                                   "); switch it off by v4l2-ctl or use another camera"};
}

void switch_off_automatics(const V4l2Node& node, CameraMode& mode) {
  for (const auto& automatic : automatics) {
    if (!automatic_now(node, automatic)) continue;
    switch_off(node, automatic);
    mode.automatic_off.emplace_back(automatic.name);
  }
}

void set_levels(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode) {
  constexpr double hundredths = 100;  // USB Video Class 1.5, 4.2.2.3.12: 100 is linear
  const bool has_gamma = settings.gamma != 1 || level(node, V4L2_CID_GAMMA, std::nullopt, "gamma");
  const auto gamma =
      has_gamma ? level(node, V4L2_CID_GAMMA, hundredths * settings.gamma, "gamma in hundredths") : std::nullopt;
  if (gamma) mode.gamma = *gamma / hundredths;
  mode.gain = level(node, V4L2_CID_GAIN, settings.gain, "gain");
  mode.black_level = level(node, V4L2_CID_BRIGHTNESS, settings.black_level, "black level (brightness)");
}

// V4L2_CID_EXPOSURE is of no defined unit, so that the middle of such an exposure is not known.
[[noreturn]] void lacks_exposure(const V4l2Node& node) {
  const bool other = level(node, V4L2_CID_EXPOSURE, std::nullopt, "exposure").has_value();
  throw Error{Fault::usage, node.path + ": has no exposure time (V4L2_CID_EXPOSURE_ABSOLUTE)" +
                                (other ? ", only an exposure without unit (V4L2_CID_EXPOSURE)" : "") +
                                "; use another camera"};
}

void set_exposure(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode) {
  constexpr double step_us = 100;
  const auto now = level(node, V4L2_CID_EXPOSURE_ABSOLUTE, std::nullopt, "exposure");
  if (now) mode.exposure_us = step_us * *now;
  if (!settings.exposure_us) return;
  if (!now) lacks_exposure(node);
  auto value = cleared<v4l2_control>();
  value.id = V4L2_CID_EXPOSURE_ABSOLUTE;
  value.value = round_int(*settings.exposure_us / step_us);
  node.ask(VIDIOC_S_CTRL, &value, "rejects the exposure (VIDIOC_S_CTRL)");
  node.ask(VIDIOC_G_CTRL, &value, "does not report the exposure (VIDIOC_G_CTRL)");
  mode.exposure_us = step_us * value.value;
  check(node, "exposure (us, in steps of 100)", *settings.exposure_us, mode.exposure_us);
}

v4l2_streamparm stream_parameters() {
  auto rate = cleared<v4l2_streamparm>();
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return rate;
}

// 0: the camera does not say.
double rate_hz(const v4l2_streamparm& rate) {
  const auto& period = rate.parm.capture.timeperframe;
  return period.numerator > 0 ? static_cast<double>(period.denominator) / period.numerator : 0;
}

double rate_now_hz(const V4l2Node& node) {
  auto rate = stream_parameters();
  return node.driver->control(VIDIOC_G_PARM, &rate) == 0 ? rate_hz(rate) : 0;
}

// A camera whose rate cannot be set may have the requested one.
double set_rate_hz(const V4l2Node& node, double wanted_hz) {
  auto rate = stream_parameters();
  rate.parm.capture.timeperframe = {1000, static_cast<__u32>(std::lround(1000 * wanted_hz))};
  if (node.driver->control(VIDIOC_S_PARM, &rate) == 0) return rate_hz(rate);
  if (errno != ENOTTY) throw node.refusal("rejects the frame rate (VIDIOC_S_PARM)");
  return rate_now_hz(node);
}

void set_rate(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode) {
  mode.fps = settings.fps ? set_rate_hz(node, *settings.fps) : rate_now_hz(node);
  if (!settings.fps) return;
  if (mode.fps > 0) return check(node, "frame rate", *settings.fps, mode.fps);
  warn(node.path +
       ": its frame rate can be neither set nor read (VIDIOC_S_PARM); frames come at the camera's own rate, " +
       "not necessarily at " + format_number(*settings.fps) + " Hz");
}

}  // namespace

// Automatics first: with one of them on a value holds until the next frame.
void set_controls(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode) {
  switch_off_automatics(node, mode);
  set_levels(node, settings, mode);
  set_exposure(node, settings, mode);
  set_rate(node, settings, mode);
}

}  // namespace vam::device
