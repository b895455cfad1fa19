// What of a graphics card's resources one screen needs.
#pragma once

#include <xf86drmMode.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vam::device {

struct DrmOutput {
  int card = -1;  // open
  std::uint32_t connector = 0;
  std::uint32_t crtc = 0;
  drmModeModeInfo mode{};  // the screen's preferred one
};

/// The nodes of the graphics cards, in order.
[[nodiscard]] std::vector<std::string> drm_cards();

struct DrmScreen {
  std::string connector;  // "HDMI-A-1"
  int columns = 0;        // of the preferred mode
  int rows = 0;
  double hz = 0;
};
/// The connectors of an open card that have a screen.
[[nodiscard]] std::vector<DrmScreen> drm_screens(int card);

/// Opens the card that has the connector of this name, such as "HDMI-A-1", with a screen plugged in. Its CRTC is the
/// one that drives it already, else one that no other screen has. Throws Fault::absent naming the connectors there are.
[[nodiscard]] DrmOutput open_drm_output(const std::string& connector);

/// The table between frames and grey, identity and read back: grey must be linear, and another program may have left
/// its own. A CRTC without a table is straight anyway. Throws Fault::protocol when it stays as it is.
void straighten_gamma(const DrmOutput& output, const std::string& name);

}  // namespace vam::device
