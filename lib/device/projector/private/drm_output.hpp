// SPDX-License-Identifier: GPL-3.0-or-later
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
  drmModeModeInfo mode{};
  std::string status_file;  // where the kernel says whether a screen is connected
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
/// one that drives it already, else one that no other screen has. mode: "1920x1080" or "1920x1080@60", empty: the one
/// that the screen prefers. Throws Fault::absent naming the connectors there are, Fault::usage naming the modes.
[[nodiscard]] DrmOutput open_drm_output(const std::string& connector, const std::string& mode);

/// False when the screen has been unplugged, which flips do not notice. It is read from sysfs, which waits for no lock
/// of the card, as asking the card might (Linux, drm_sysfs.c: status_show).
[[nodiscard]] bool is_connected(const DrmOutput& output);

/// Grey from 0 to 255 on the wire: a card left to itself sends 16 to 235 to a screen that it takes for a television
/// (property "Broadcast RGB"; Linux, drm-kms: standard connector properties). Read back; nothing to do where the card
/// has no such property. Throws Fault::protocol when it stays as it is.
void send_full_range(const DrmOutput& output, const std::string& name);
/// Bits of each colour on the wire at most (property "max bpc"), read back. Throws Fault::usage when the card has no
/// such property, Fault::protocol when it stays as it is.
void limit_bits(const DrmOutput& output, const std::string& name, int bits);

/// The table between frames and grey, identity and read back: grey must be linear, and another program may have left
/// its own. A CRTC without a table is straight anyway. Throws Fault::protocol when it stays as it is.
void straighten_gamma(const DrmOutput& output, const std::string& name);

}  // namespace vam::device
