// SPDX-License-Identifier: GPL-3.0-or-later
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "device/camera/private/v4l2_node.hpp"

namespace vam::device {

namespace {

struct Known {
  std::uint32_t code;
  const char* name;
  PixelLayout layout;
  int bits;
};
// In the order of preference: a depth that is known shows saturation.
constexpr std::array pixel_formats{Known{V4L2_PIX_FMT_GREY, "GREY", PixelLayout::bytes, 8},
                                   Known{V4L2_PIX_FMT_Y12, "Y12", PixelLayout::words, 12},
                                   Known{V4L2_PIX_FMT_Y10, "Y10", PixelLayout::words, 10},
                                   Known{V4L2_PIX_FMT_Y16, "Y16", PixelLayout::words, 16},
                                   Known{V4L2_PIX_FMT_YUYV, "YUYV", PixelLayout::even_bytes, 8},
                                   Known{V4L2_PIX_FMT_UYVY, "UYVY", PixelLayout::odd_bytes, 8}};

bool is_luma(const Known& format) {
  return format.layout == PixelLayout::even_bytes || format.layout == PixelLayout::odd_bytes;
}

// As the driver says, and by default as the kernel documents it: limited, but for JPEG's colours.
bool has_limited_range(const v4l2_pix_format& pixels) {
  const auto range = pixels.quantization != V4L2_QUANTIZATION_DEFAULT
                         ? static_cast<v4l2_quantization>(pixels.quantization)
                         : V4L2_MAP_QUANTIZATION_DEFAULT(false, pixels.colorspace, pixels.ycbcr_enc);
  return range == V4L2_QUANTIZATION_LIM_RANGE;
}

// "MJPG": the name as drivers' tools show it; big-endian formats have the highest bit.
std::string name_of(std::uint32_t code) {
  std::string name;
  for (unsigned shift = 0; shift < 32; shift += 8) name += static_cast<char>(code >> shift & 127);
  return name.substr(0, name.find_last_not_of(' ') + 1) + (code >> 31 != 0 ? "-BE" : "");
}

std::vector<std::uint32_t> offered_formats(const V4l2Node& node) {
  std::vector<std::uint32_t> offered;
  for (std::uint32_t index = 0;; ++index) {
    auto found = cleared<v4l2_fmtdesc>();
    found.index = index;
    found.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (node.driver->control(VIDIOC_ENUM_FMT, &found) != 0) return offered;
    offered.push_back(found.pixelformat);
  }
}

Error no_format(const V4l2Node& node, const std::string& wanted, const std::vector<std::uint32_t>& offered) {
  std::vector<std::string> has;
  std::vector<std::string> known;
  for (const std::uint32_t code : offered) has.push_back(name_of(code));
  for (const Known& format : pixel_formats) known.emplace_back(format.name);
  return {Fault::usage, node.path + ": no pixel format " + (wanted.empty() ? "for grey" : wanted) + "; it has " +
                            (has.empty() ? "none" : join(has, ", ")) + ", supported are " + join(known, ", ") +
                            (wanted.empty() ? "; use another camera" : "")};
}

const Known& chosen_format(const V4l2Node& node, const std::string& wanted) {
  const auto offered = offered_formats(node);
  const auto* chosen = std::find_if(pixel_formats.begin(), pixel_formats.end(), [&](const Known& f) {
    return (wanted.empty() || f.name == wanted) && std::find(offered.begin(), offered.end(), f.code) != offered.end();
  });
  if (chosen == pixel_formats.end()) throw no_format(node, wanted, offered);
  return *chosen;
}

}  // namespace

V4l2Format choose_format(const V4l2Node& node, const std::string& wanted, CameraMode& mode) {
  const Known& chosen = chosen_format(node, wanted);
  auto size = cleared<v4l2_format>();
  size.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  node.ask(VIDIOC_G_FMT, &size, "does not report its format (VIDIOC_G_FMT)");
  const auto& pixels = size.fmt.pix;
  size.fmt.pix.pixelformat = chosen.code;
  size.fmt.pix.field = V4L2_FIELD_NONE;
  node.ask(VIDIOC_S_FMT, &size, "rejects the format (VIDIOC_S_FMT)");
  if (pixels.pixelformat != chosen.code) {
    throw Error{Fault::protocol, node.path + ": pixel format set to another value than " + chosen.name};
  }
  if (pixels.field != V4L2_FIELD_NONE && pixels.field != V4L2_FIELD_ANY) {
    throw Error{Fault::usage, node.path + ": sends interlaced fields (V4L2 field " + std::to_string(pixels.field) +
                                  "), whose rows are of two moments; use a progressive camera or mode"};
  }
  // The kernel's page of Y16: the sensor may have fewer bits than 16, in the low ones.
  if (chosen.code == V4L2_PIX_FMT_Y16) {
    warn(node.path + ": the depth of Y16 is not known, full scale is taken as 65535; do not rely on saturation");
  }
  mode.columns = static_cast<int>(pixels.width);
  mode.rows = static_cast<int>(pixels.height);
  mode.bits = chosen.bits;
  return {chosen.layout, chosen.bits, pixels.bytesperline, is_luma(chosen) && has_limited_range(pixels)};
}

}  // namespace vam::device
