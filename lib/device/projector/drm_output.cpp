#include "device/projector/private/drm_output.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <xf86drm.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::device {

namespace {

struct Free {
  void operator()(drmModeRes* resources) const { drmModeFreeResources(resources); }
  void operator()(drmModeConnector* connector) const { drmModeFreeConnector(connector); }
  void operator()(drmModeEncoder* encoder) const { drmModeFreeEncoder(encoder); }
  void operator()(drmModeCrtc* crtc) const { drmModeFreeCrtc(crtc); }
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

drmModeModeInfo preferred_mode(const drmModeConnector& connector) {
  const auto* begin = connector.modes;
  const auto* end = begin + connector.count_modes;
  const auto* best =
      std::find_if(begin, end, [](const drmModeModeInfo& m) { return (m.type & DRM_MODE_TYPE_PREFERRED) != 0; });
  return best != end ? *best : *begin;
}

bool find_output(int card, const std::string& wanted, DrmOutput& output, std::vector<std::string>& seen) {
  const Handle<drmModeRes> resources(drmModeGetResources(card));
  if (!resources) return false;
  for (int i = 0; i < resources->count_connectors; ++i) {
    const Handle<drmModeConnector> connector(drmModeGetConnector(card, resources->connectors[i]));
    if (!connector) continue;
    const bool connected = connector->connection == DRM_MODE_CONNECTED && connector->count_modes > 0;
    seen.push_back(connector_name(*connector) + (connected ? "" : " (nothing connected)"));
    if (!connected || connector_name(*connector) != wanted) continue;
    output = {card, connector->connector_id, crtc_for(card, *resources, *connector), preferred_mode(*connector)};
    return output.crtc != 0;
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
    const drmModeModeInfo mode = preferred_mode(*connector);
    screens.push_back({connector_name(*connector), mode.hdisplay, mode.vdisplay, static_cast<double>(mode.vrefresh)});
  }
  return screens;
}

DrmOutput open_drm_output(const std::string& connector) {
  std::vector<std::string> seen;
  for (const auto& path : drm_cards()) {
    const int card = open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (card < 0) continue;
    DrmOutput output;
    if (find_output(card, connector, output, seen)) return output;
    close(card);
  }
  throw Error{Fault::absent, "drm:" + connector + ": no such connected screen" +
                                 (seen.empty() ? "; no GPU can be opened" : "; connectors: " + join(seen, ", "))};
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
