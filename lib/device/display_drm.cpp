#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "device/display_backends.hpp"
#include "device/interrupt.hpp"

namespace vam::device {

namespace {

constexpr double flip_timeout_s = 0.25;  // less than the guardian's patience

std::string reason() { return std::string(" (") + std::strerror(errno) + ")"; }

// What of the card's resources one connector needs.
struct Output {
  int card = -1;
  std::uint32_t connector = 0;
  std::uint32_t crtc = 0;
  drmModeModeInfo mode{};
};

struct ResourcesCloser {
  void operator()(drmModeRes* resources) const { drmModeFreeResources(resources); }
};
struct ConnectorCloser {
  void operator()(drmModeConnector* connector) const { drmModeFreeConnector(connector); }
};

std::string connector_name(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type != nullptr ? type : "Unknown") + "-" + std::to_string(connector.connector_type_id);
}

// The CRTC that drives the connector already, else the first one that can.
std::uint32_t crtc_for(int card, const drmModeRes& resources, const drmModeConnector& connector) {
  if (drmModeEncoder* current = drmModeGetEncoder(card, connector.encoder_id)) {
    const std::uint32_t crtc = current->crtc_id;
    drmModeFreeEncoder(current);
    if (crtc != 0) return crtc;
  }
  for (int e = 0; e < connector.count_encoders; ++e) {
    drmModeEncoder* encoder = drmModeGetEncoder(card, connector.encoders[e]);
    if (encoder == nullptr) continue;
    const std::uint32_t possible = encoder->possible_crtcs;
    drmModeFreeEncoder(encoder);
    for (int c = 0; c < resources.count_crtcs; ++c) {
      if ((possible >> c & 1U) != 0) return resources.crtcs[c];
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

bool find_output(int card, const std::string& wanted, Output& output, std::vector<std::string>& seen) {
  const std::unique_ptr<drmModeRes, ResourcesCloser> resources(drmModeGetResources(card));
  if (!resources) return false;
  for (int i = 0; i < resources->count_connectors; ++i) {
    const std::unique_ptr<drmModeConnector, ConnectorCloser> connector(
        drmModeGetConnector(card, resources->connectors[i]));
    if (!connector) continue;
    const bool connected = connector->connection == DRM_MODE_CONNECTED && connector->count_modes > 0;
    seen.push_back(connector_name(*connector) + (connected ? "" : " (nothing connected)"));
    if (!connected || connector_name(*connector) != wanted) continue;
    output = {card, connector->connector_id, crtc_for(card, *resources, *connector), preferred_mode(*connector)};
    return output.crtc != 0;
  }
  return false;
}

Output open_output(const std::string& wanted) {
  std::vector<std::string> seen;
  std::error_code none;
  std::vector<std::string> cards;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/dri", none)) {
    if (entry.path().filename().string().rfind("card", 0) == 0) cards.push_back(entry.path());
  }
  std::sort(cards.begin(), cards.end());
  for (const auto& path : cards) {
    const int card = open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (card < 0) continue;
    Output output;
    if (find_output(card, wanted, output, seen)) return output;
    close(card);
  }
  throw Error{Fault::absent, "drm:" + wanted + ": no such connected screen" +
                                 (seen.empty() ? "; there is no graphics card that may be opened"
                                               : "; there are " + join(seen, ", "))};
}

// A picture in the card's memory.
struct Buffer {
  std::uint32_t handle = 0;
  std::uint32_t framebuffer = 0;
};

class DrmDisplay final : public Display {
 public:
  DrmDisplay(const std::string& connector, Clock& clock, Guardian* guardian)
      : clock_(clock), guardian_(guardian), output_(open_output(connector)), name_("drm:" + connector) {
    if (drmSetMaster(output_.card) != 0) {
      const std::string why = reason();
      close(output_.card);
      throw Error{Fault::busy,
                  name_ + ": the card is in use, by a desktop for instance; log out of it or use sdl:" + why};
    }
    mode_ = {output_.mode.hdisplay, output_.mode.vdisplay,
             output_.mode.clock * 1000.0 / (output_.mode.htotal * output_.mode.vtotal)};
    black_ =
        load(std::vector<std::uint8_t>(static_cast<std::size_t>(mode_.columns) * static_cast<std::size_t>(mode_.rows)));
    show_black();
  }

  ~DrmDisplay() override {
    drmModeSetCrtc(output_.card, output_.crtc, black_.framebuffer, 0, 0, &output_.connector, 1, &output_.mode);
    for (const Buffer& buffer : frames_) drop(buffer);
    drmDropMaster(output_.card);
    close(output_.card);
  }

  DisplayMode mode() const override { return mode_; }

  int add(const GreyImage& levels) override {
    frames_.push_back(load(screen_bytes(levels, mode_)));
    return static_cast<int>(frames_.size()) - 1;
  }

  Flip present(int index) override {
    watch(index >= 0);
    const std::uint32_t framebuffer =
        index < 0 ? black_.framebuffer : frames_[static_cast<std::size_t>(index)].framebuffer;
    Flip flip;
    flip.sequence = -1;
    if (drmModePageFlip(output_.card, output_.crtc, framebuffer, DRM_MODE_PAGE_FLIP_EVENT, &flip) != 0) {
      throw Error{Fault::io, name_ + ": the card refused a page flip" + reason()};
    }
    wait_for(flip);
    if (index < 0) unwatch();
    return flip;
  }

 private:
  Buffer load(const std::vector<std::uint8_t>& bytes) {
    drm_mode_create_dumb make{};
    make.width = output_.mode.hdisplay;
    make.height = output_.mode.vdisplay;
    make.bpp = 32;
    if (drmIoctl(output_.card, DRM_IOCTL_MODE_CREATE_DUMB, &make) != 0) {
      throw Error{Fault::memory,
                  name_ + ": no room in the card's memory for frame " + std::to_string(frames_.size()) + reason()};
    }
    Buffer buffer{make.handle, 0};
    drm_mode_map_dumb where{};
    where.handle = make.handle;
    void* pixels = MAP_FAILED;
    if (drmModeAddFB(output_.card, make.width, make.height, 24, 32, make.pitch, make.handle, &buffer.framebuffer) ==
            0 &&
        drmIoctl(output_.card, DRM_IOCTL_MODE_MAP_DUMB, &where) == 0) {
      pixels =
          mmap(nullptr, make.size, PROT_READ | PROT_WRITE, MAP_SHARED, output_.card, static_cast<off_t>(where.offset));
    }
    if (pixels == MAP_FAILED) throw Error{Fault::memory, name_ + ": a frame cannot be written to the card" + reason()};
    for (std::uint32_t y = 0; y < make.height; ++y) {
      auto* row =
          reinterpret_cast<std::uint32_t*>(static_cast<char*>(pixels) + static_cast<std::size_t>(y) * make.pitch);
      for (std::uint32_t x = 0; x < make.width; ++x)
        row[x] = bytes[static_cast<std::size_t>(y) * make.width + x] * 0x010101U;
    }
    munmap(pixels, make.size);
    return buffer;
  }

  void drop(const Buffer& buffer) const {
    drmModeRmFB(output_.card, buffer.framebuffer);
    drm_mode_destroy_dumb gone{buffer.handle};
    drmIoctl(output_.card, DRM_IOCTL_MODE_DESTROY_DUMB, &gone);
  }

  void show_black() {
    if (drmModeSetCrtc(output_.card, output_.crtc, black_.framebuffer, 0, 0, &output_.connector, 1, &output_.mode) !=
        0) {
      throw Error{Fault::absent, name_ + ": does not take its own mode" + reason()};
    }
  }

  static void flipped(int, unsigned sequence, unsigned seconds, unsigned microseconds, void* flip) {
    *static_cast<Flip*>(flip) = {static_cast<long>(sequence), seconds + 1e-6 * microseconds};
  }

  void wait_for(const Flip& flip) {
    const double deadline_s = clock_.now_s() + flip_timeout_s;
    drmEventContext context{};
    context.version = 2;
    context.page_flip_handler = flipped;
    while (flip.sequence < 0) {
      const double left_s = deadline_s - clock_.now_s();
      pollfd ready{output_.card, POLLIN, 0};
      if (left_s <= 0 || poll(&ready, 1, static_cast<int>(left_s * 1000) + 1) <= 0) {
        if (left_s > 0 && errno == EINTR) continue;
        throw Error{Fault::busy,
                    name_ + ": no flip within " + std::to_string(flip_timeout_s) + " s; is the screen on?"};
      }
      drmHandleEvent(output_.card, &context);
    }
    check_interrupted();
  }

  // The guardian shares the opened card, so that the pictures outlive the tool until black is on.
  void watch(bool lit) {
    if (guardian_ == nullptr) return;
    if (lit && action_ == 0) {
      action_ = guardian_->add({{"do", "drm"},
                                {"order", 0},
                                {"name", "screen"},
                                {"crtc", output_.crtc},
                                {"framebuffer", black_.framebuffer}},
                               output_.card);
    }
    guardian_->beat();
  }
  void unwatch() {
    if (action_ != 0) guardian_->forget(action_);
    action_ = 0;
  }

  Clock& clock_;
  Guardian* guardian_;
  Output output_;
  std::string name_;
  DisplayMode mode_;
  Buffer black_;
  std::vector<Buffer> frames_;
  int action_ = 0;
};

}  // namespace

std::unique_ptr<Display> open_drm_display(const Address& address, Clock& clock, Guardian* guardian) {
  address.allow({});
  auto lock = std::make_unique<DeviceLock>("drm-" + address.place);
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto display = std::make_unique<DrmDisplay>(address.place, clock, guardian);
  display->hold(std::move(lock));
  return display;
}

}  // namespace vam::device
