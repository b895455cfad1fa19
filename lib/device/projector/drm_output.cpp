// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/private/drm_output.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <xf86drm.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::device {

namespace {

struct Free {
  void operator()(drmModeRes* resources) const { drmModeFreeResources(resources); }
  void operator()(drmModeConnector* connector) const { drmModeFreeConnector(connector); }
  void operator()(drmModeEncoder* encoder) const { drmModeFreeEncoder(encoder); }
  void operator()(drmModeCrtc* crtc) const { drmModeFreeCrtc(crtc); }
  void operator()(drmModeObjectProperties* all) const { drmModeFreeObjectProperties(all); }
  void operator()(drmModePropertyRes* property) const { drmModeFreeProperty(property); }
};
template <class Thing>
using Handle = std::unique_ptr<Thing, Free>;

std::string connector_name(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type != nullptr ? type : "Unknown") + "-" + std::to_string(connector.connector_type_id);
}

// The CRTC that drives the connector already, else the first one that can and drives no other screen.
std::uint32_t crtc_for(int card, const drmModeRes& resources, const drmModeConnector& connector) {
  std::set<std::uint32_t> taken;
  for (int e = 0; e < resources.count_encoders; ++e) {
    const Handle<drmModeEncoder> encoder(drmModeGetEncoder(card, resources.encoders[e]));
    if (!encoder || encoder->crtc_id == 0) continue;
    if (encoder->encoder_id == connector.encoder_id) return encoder->crtc_id;
    taken.insert(encoder->crtc_id);
  }
  for (int e = 0; e < connector.count_encoders; ++e) {
    const Handle<drmModeEncoder> encoder(drmModeGetEncoder(card, connector.encoders[e]));
    if (!encoder) continue;
    for (int c = 0; c < resources.count_crtcs; ++c) {
      if ((encoder->possible_crtcs >> c & 1U) != 0 && !taken.contains(resources.crtcs[c])) return resources.crtcs[c];
    }
  }
  return 0;
}

// An interlaced image is shown in two halves, one after the other, and the lines of a doubled one twice: neither is the
// frame of one angle.
std::vector<drmModeModeInfo> whole_modes(const drmModeConnector& connector) {
  std::vector<drmModeModeInfo> modes;
  std::copy_if(connector.modes, connector.modes + connector.count_modes, std::back_inserter(modes),
               [](const auto& m) { return (m.flags & (DRM_MODE_FLAG_INTERLACE | DRM_MODE_FLAG_DBLSCAN)) == 0; });
  return modes;
}

drmModeModeInfo preferred_mode(const std::vector<drmModeModeInfo>& modes) {
  const auto best = std::find_if(modes.begin(), modes.end(),
                                 [](const drmModeModeInfo& m) { return (m.type & DRM_MODE_TYPE_PREFERRED) != 0; });
  return best != modes.end() ? *best : modes.front();
}

double rate_hz(const drmModeModeInfo& mode) { return mode.clock * 1000.0 / (mode.htotal * mode.vtotal); }

std::string size_of(const drmModeModeInfo& mode) {
  return std::to_string(mode.hdisplay) + "x" + std::to_string(mode.vdisplay);
}

// The first of that size, or the one nearest to that rate: 59.94 Hz are written 60, too.
drmModeModeInfo mode_called(const drmModeConnector& connector, const std::string& wanted) {
  const std::vector<drmModeModeInfo> modes = whole_modes(connector);
  if (modes.empty()) {
    throw Error{Fault::protocol, "drm:" + connector_name(connector) +
                                     ": the screen has only interlaced modes, which do not show a frame at one time; "
                                     "use another screen"};
  }
  if (wanted.empty()) return preferred_mode(modes);
  const std::size_t at = wanted.find('@');
  const bool any_rate = at == std::string::npos;
  const double hz = any_rate ? 0 : parse_number(wanted.substr(at + 1)).value_or(0);
  const drmModeModeInfo* best = nullptr;
  double best_off_hz = 0.5;
  std::set<std::string> known;
  for (const drmModeModeInfo& mode : modes) {
    known.insert(size_of(mode) + "@" + format_number(rate_hz(mode), 4));
    const double off_hz = any_rate ? 0 : std::abs(rate_hz(mode) - hz);
    if (size_of(mode) != wanted.substr(0, at) || off_hz >= best_off_hz) continue;
    best = &mode;
    best_off_hz = off_hz;
  }
  if (best != nullptr) return *best;
  throw Error{Fault::usage, "drm:" + connector_name(connector) + ": no mode " + wanted +
                                "; the screen has: " + join({known.begin(), known.end()}, ", ")};
}

struct Property {
  Handle<drmModePropertyRes> about;  // null: the connector has none of this name
  std::uint64_t value = 0;
};

Property property_of(const DrmOutput& output, const std::string& name) {
  const Handle<drmModeObjectProperties> all(
      drmModeObjectGetProperties(output.card, output.connector, DRM_MODE_OBJECT_CONNECTOR));
  for (std::uint32_t i = 0; all && i < all->count_props; ++i) {
    Handle<drmModePropertyRes> about(drmModeGetProperty(output.card, all->props[i]));
    if (about && name == about->name) return {std::move(about), all->prop_values[i]};
  }
  return {};
}

bool set_property(const DrmOutput& output, const std::string& name, std::uint64_t value) {
  const Property before = property_of(output, name);
  if (before.value == value) return true;
  drmModeConnectorSetProperty(output.card, output.connector, before.about->prop_id, value);
  return property_of(output, name).value == value;
}

bool find_output(int card, const std::string& wanted, const std::string& mode, DrmOutput& output,
                 std::vector<std::string>& seen) {
  const Handle<drmModeRes> resources(drmModeGetResources(card));
  if (!resources) return false;
  for (int i = 0; i < resources->count_connectors; ++i) {
    const Handle<drmModeConnector> connector(drmModeGetConnector(card, resources->connectors[i]));
    if (!connector) continue;
    const bool connected = connector->connection == DRM_MODE_CONNECTED && connector->count_modes > 0;
    seen.push_back(connector_name(*connector) + (connected ? "" : " (nothing connected)"));
    if (!connected || connector_name(*connector) != wanted) continue;
    output = {card, connector->connector_id, crtc_for(card, *resources, *connector), mode_called(*connector, mode), {}};
    if (output.crtc != 0) return true;
    throw Error{Fault::busy, "drm:" + wanted +
                                 ": every display controller (CRTC) of the GPU drives another screen; unplug one, or "
                                 "switch it off"};
  }
  return false;
}

}  // namespace

std::vector<std::string> drm_cards() {
  std::error_code none;
  std::vector<std::string> cards;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", none)) {
    if (entry.path().filename().string().rfind("card", 0) == 0) cards.push_back(entry.path());
  }
  std::sort(cards.begin(), cards.end());
  return cards;
}

std::vector<DrmScreen> drm_screens(int card) {
  std::vector<DrmScreen> screens;
  const Handle<drmModeRes> resources(drmModeGetResources(card));
  for (int i = 0; resources && i < resources->count_connectors; ++i) {
    const Handle<drmModeConnector> connector(drmModeGetConnector(card, resources->connectors[i]));
    if (!connector || connector->connection != DRM_MODE_CONNECTED || connector->count_modes == 0) continue;
    const std::vector<drmModeModeInfo> modes = whole_modes(*connector);
    if (modes.empty()) continue;
    const drmModeModeInfo mode = preferred_mode(modes);
    screens.push_back({connector_name(*connector), mode.hdisplay, mode.vdisplay, static_cast<double>(mode.vrefresh)});
  }
  return screens;
}

DrmOutput open_drm_output(const std::string& connector, const std::string& mode) {
  std::vector<std::string> seen;
  std::string closed;
  for (const auto& path : drm_cards()) {
    const int card = open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (card < 0) {
      closed = "; " + path + ": " + std::strerror(errno);
      if (errno == EACCES) closed += "; add the user to the group that owns it (usually video)";
      continue;
    }
    DrmOutput output;
    if (find_output(card, connector, mode, output, seen)) {
      output.status_file =
          "/sys/class/drm/" + std::filesystem::path(path).filename().string() + "-" + connector + "/status";
      return output;
    }
    close(card);
  }
  throw Error{Fault::absent, "drm:" + connector + ": no such connected screen" +
                                 (seen.empty() ? (closed.empty() ? "; there is no GPU (/dev/dri)" : closed)
                                               : "; connectors: " + join(seen, ", "))};
}

bool is_connected(const DrmOutput& output) {
  const int file = open(output.status_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return true;  // not known
  std::array<char, 32> text{};
  const ssize_t size = read(file, text.data(), text.size());
  close(file);
  return std::string(text.data(), std::max<ssize_t>(size, 0)).rfind("disconnected", 0) != 0;
}

void send_full_range(const DrmOutput& output, const std::string& name) {
  const std::string property = "Broadcast RGB";
  const Property range = property_of(output, property);
  if (!range.about) return;
  for (int i = 0; i < range.about->count_enums; ++i) {
    if (std::string(range.about->enums[i].name) != "Full") continue;
    if (set_property(output, property, range.about->enums[i].value)) return;
  }
  throw Error{Fault::protocol, name +
                                   ": the GPU does not send full-range RGB, so that grey is not linear; use another "
                                   "connector"};
}

void limit_bits(const DrmOutput& output, const std::string& name, int bits) {
  const std::string property = "max bpc";
  if (!property_of(output, property).about) {
    throw Error{Fault::usage, name + ": the GPU has no setting for bits per colour (max bpc); omit bpc"};
  }
  if (set_property(output, property, static_cast<std::uint64_t>(bits))) return;
  throw Error{Fault::protocol, name + ": the GPU rejects " + std::to_string(bits) + " bits per colour"};
}

void straighten_gamma(const DrmOutput& output, const std::string& name) {
  const Handle<drmModeCrtc> crtc(drmModeGetCrtc(output.card, output.crtc));
  if (!crtc || crtc->gamma_size < 2) return;
  const auto size = static_cast<std::uint32_t>(crtc->gamma_size);
  std::vector<std::uint16_t> straight(size);
  for (std::uint32_t i = 0; i < size; ++i) straight[i] = static_cast<std::uint16_t>(65535 * i / (size - 1));
  auto red = straight;
  auto green = straight;
  auto blue = straight;
  drmModeCrtcSetGamma(output.card, output.crtc, size, red.data(), green.data(), blue.data());
  const int read = drmModeCrtcGetGamma(output.card, output.crtc, size, red.data(), green.data(), blue.data());
  if (read == 0 && red == straight && green == straight && blue == straight) return;
  throw Error{Fault::protocol, name + ": the GPU's gamma table cannot be set to linear; use sdl:"};
}

}  // namespace vam::device
