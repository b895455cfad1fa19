// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/cameras/gv_camera.hpp"

#include <arpa/inet.h>
#include <arv.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/fingerprint.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "sim/cameras/makers.hpp"
#include "sim/cameras/private/gv_clock.hpp"

namespace vam::sim {

namespace {

// Packets of a cut frame that are lost, by a generator with a fixed seed: some of them, rarely all.
constexpr double cut_ratio = 0.4;
constexpr unsigned gain_auto_off = 1;  // and 2 is Continuous, in the description of Aravis' fake camera
constexpr unsigned gain_auto_on = 2;
constexpr double readout_s = 0.004;  // from the end of an exposure, and its time stamp, to the frame

// Aravis' own description lets the region be as large as the sensor whatever the binning is; no real camera does.
std::string description(const SimCameraSettings& settings) {
  ArvFakeCamera* plain = arv_fake_camera_new("plain");
  std::size_t size = 0;
  const char* text = arv_fake_camera_get_genicam_xml(plain, &size);
  std::string xml(text, size);
  g_object_unref(plain);
  for (const auto& [side, direction] : {std::pair("Width", "Horizontal"), std::pair("Height", "Vertical")}) {
    const std::string name = side;
    const std::string old = "<pMax>Sensor" + name + "</pMax>";
    for (std::size_t at = 0; (at = xml.find(old, at)) != std::string::npos;) {
      xml.replace(at, old.size(), "<pMax>" + name + "Max</pMax>");
    }
    const std::string node = "<IntSwissKnife Name=\"" + name +
                             "Max\" NameSpace=\"Standard\"><pVariable Name=\"SENSOR\">Sensor" + name +
                             "</pVariable><pVariable Name=\"BINNING\">Binning" + direction +
                             "</pVariable><Formula>SENSOR / BINNING</Formula></IntSwissKnife>\n";
    const std::size_t before = xml.find("<Integer Name=\"" + name + "\"");
    if (before == std::string::npos) throw Error{Fault::bug, "the fake camera's description has no " + name};
    xml.insert(before, node);
  }
  xml.insert(xml.find("<Port Name=\"Device\""),
             sim_maker(settings.maker).nodes + (settings.latch ? GvClock::nodes() : ""));
  return xml;
}

// Aravis takes the description from a file.
class DescriptionFile {
 public:
  explicit DescriptionFile(const SimCameraSettings& settings) {
    const char* folder = std::getenv("TMPDIR");
    path_ = std::string(folder != nullptr && *folder != '\0' ? folder : "/tmp") + "/vam-sim-XXXXXX";
    const int file = mkstemp(path_.data());
    const std::string xml = description(settings);
    const bool good = file >= 0 && write(file, xml.data(), xml.size()) == static_cast<ssize_t>(xml.size());
    if (file >= 0) close(file);
    if (!good) throw Error{Fault::no_output, path_ + ": cannot be written (" + std::strerror(errno) + ")"};
  }
  ~DescriptionFile() { unlink(path_.c_str()); }
  DescriptionFile(const DescriptionFile&) = delete;
  DescriptionFile& operator=(const DescriptionFile&) = delete;
  [[nodiscard]] const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

// Aravis shares its port with any other user; then each receives some of the packets.
void require_free(const std::string& address) {
  const std::string subject = address + ": cannot serve a camera there: ";
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(3956);
  if (inet_pton(AF_INET, address.c_str(), &place.sin_addr) != 1) {
    throw Error{Fault::usage, subject + "not an IPv4 address"};
  }
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool free = bind(probe, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  const int reason = errno;
  close(probe);
  if (free) return;
  if (reason == EADDRINUSE) throw Error{Fault::busy, subject + "UDP port 3956 is in use; end the other camera"};
  throw Error{Fault::usage, subject + std::strerror(reason) + "; use an address of this machine"};
}

}  // namespace

struct SimGvCamera::State {
  SimCameraSettings settings;
  SimLog log;
  ArvGvFakeCamera* server = nullptr;
  std::optional<SimPrint> print;
  int quarters = 0;  // turned when the print was handed over last
  std::optional<SimWorld> world;
  std::unique_ptr<GvClock> clock;
  device::StampMoment stamp = device::StampMoment::end;
  std::unique_ptr<SimScene> scene;
  std::pair<unsigned, int> scene_of;  // binning and bits
  long next = 0;

  [[nodiscard]] ArvFakeCamera* registers() const { return arv_gv_fake_camera_get_fake_camera(server); }

  [[nodiscard]] unsigned get(unsigned place) const {
    guint32 value = 0;
    arv_fake_camera_read_register(registers(), place, &value);
    return value;
  }

  // The bootstrap registers of GigE Vision for these: 32 bytes each.
  void name(const SimMaker& maker) const {
    for (const auto& [place, text] : {std::pair(0x48U, maker.vendor), std::pair(0x68U, maker.model)}) {
      std::string bytes = text;
      bytes.resize(32, '\0');
      arv_fake_camera_write_memory(registers(), place, 32, bytes.data());
    }
  }

  void set(unsigned place, unsigned value) const { arv_fake_camera_write_register(registers(), place, value); }

  void begin(double now_s) {
    if (settings.bench.resin) print.emplace(settings.bench);
    world.emplace(settings.sources, now_s, print ? &*print : nullptr);
  }

  // In the server's thread, right before the frame's packets leave.
  void fill(ArvBuffer* buffer, double exposure_us, ArvPixelFormat format) {
    const double now_s = device::real_clock().now_s();
    const long number = next++;
    if (number == settings.unplug) std::_Exit(0);  // no goodbye: the cable is pulled
    if (number + 1 == settings.shrink) set(ARV_FAKE_CAMERA_REGISTER_HEIGHT, get(ARV_FAKE_CAMERA_REGISTER_HEIGHT) / 2);
    if (!world) begin(now_s);
    const int bits = format == ARV_PIXEL_FORMAT_MONO_16 ? 16 : 8;
    const std::pair wanted(std::max(1U, get(ARV_FAKE_CAMERA_REGISTER_BINNING_HORIZONTAL)), bits);
    if (!scene || scene_of != wanted) {
      scene = std::make_unique<SimScene>(settings.bench, static_cast<int>(wanted.first), bits);
      scene_of = wanted;
    }
    // The exposure ended a while ago: what was on until then has come to the logs.
    const double end_s = now_s - readout_s - std::max(settings.lag_s, 0.0);
    const double middle_s = end_s - 0.5e-6 * exposure_us;
    GreyImage levels =
        region(scene->render(world->during(end_s - 1e-6 * exposure_us, end_s), exposure_us, number), buffer);
    const SimMoment moment = world->moment(middle_s);
    arv_buffer_set_timestamp(buffer,
                             clock->ns(middle_s - device::to_middle_s(stamp, 1e-6 * exposure_us) + settings.lag_s));
    amplify(levels, number);
    copy(levels, buffer);
    hand_over(moment.angle_deg);
    const bool lost = settings.drop.contains(number);
    const bool cut = settings.incomplete.contains(number);
    g_object_set(server, "gvsp-lost-ratio", lost ? 1.0 : cut ? cut_ratio : 0.0, nullptr);
    if (!log) return;
    log({{"t_monotonic_s", middle_s},
         {"event", lost  ? "lost"
                   : cut ? "cut"
                         : "frame"},
         {"number", number},
         {"angle_deg", moment.angle_deg},
         {"lit_s", moment.lit_s},
         {"levels", fingerprint(levels)}});
  }

  void hand_over(double angle_deg) {
    const int now = floor_int(std::abs(angle_deg) / 90);
    if (!print || !settings.cured || now == quarters || print->lit_s() == 0) return;
    quarters = now;
    settings.cured(*print);
  }

  // Gain in dB, as many makers count GainRaw or Gain. While it is automatic, as cameras are delivered, it wanders, and
  // a value that was set is lost (Point Grey, Flea3 USB 3.0 Technical Reference, GAIN: a write in auto mode is
  // ignored).
  void amplify(GreyImage& levels, long number) const {
    if (get(ARV_FAKE_CAMERA_REGISTER_GAIN_MODE) != gain_auto_off) {
      set(ARV_FAKE_CAMERA_REGISTER_GAIN_RAW,
          static_cast<unsigned>(std::lround(3 + 3 * std::sin(static_cast<double>(number)))));
    }
    const auto gain_db = static_cast<double>(get(ARV_FAKE_CAMERA_REGISTER_GAIN_RAW));
    if (gain_db == 0) return;
    const double factor = std::pow(10, gain_db / 20);
    for (auto& level : levels.values) {
      level = static_cast<std::uint16_t>(std::min<double>(levels.full(), std::round(factor * level)));
    }
  }

  // The part of the sensor that the client requested; black beyond it.
  [[nodiscard]] GreyImage region(const GreyImage& whole, ArvBuffer* buffer) const {
    const int left = static_cast<int>(get(ARV_FAKE_CAMERA_REGISTER_X_OFFSET));
    const int top = static_cast<int>(get(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET));
    GreyImage part(arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer), whole.bits);
    for (int y = 0; y < std::min(part.height, whole.height - top); ++y) {
      for (int x = 0; x < std::min(part.width, whole.width - left); ++x) part(x, y) = whole(x + left, y + top);
    }
    return part;
  }

  static void copy(const GreyImage& levels, ArvBuffer* buffer) {
    // Filling it is what the callback is for, though the accessor is const.
    auto* bytes = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, nullptr)));
    for (const std::uint16_t level : levels.values) {
      *bytes++ = static_cast<std::uint8_t>(level & 255U);
      if (levels.bits > 8) *bytes++ = static_cast<std::uint8_t>(level >> 8U);
    }
  }

  void set_registers() const {
    const auto put = [&](unsigned place, double value) { set(place, static_cast<unsigned>(value)); };
    put(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, settings.bench.columns);
    put(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, settings.bench.rows);
    put(ARV_FAKE_CAMERA_REGISTER_WIDTH, settings.bench.columns);
    put(ARV_FAKE_CAMERA_REGISTER_HEIGHT, settings.bench.rows);
    put(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, 1e6 / settings.fps);
    put(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US, settings.exposure_us);
    put(ARV_FAKE_CAMERA_REGISTER_GAIN_MODE, gain_auto_on);
  }
};

SimGvCamera::SimGvCamera(const SimCameraSettings& settings, const std::string& address, const std::string& serial,
                         SimLog log)
    : state_(std::make_unique<State>()) {
  require_free(address);
  state_->settings = settings;
  state_->log = std::move(log);
  // What light was shown before cures before a client waits for its frame; else all begins with the first frame.
  if (settings.bench.resin && !settings.sources.shown.empty()) state_->begin(device::real_clock().now_s());
  g_random_set_seed(static_cast<guint32>(settings.bench.seed));
  const DescriptionFile description(settings);
  state_->server = arv_gv_fake_camera_new_full(address.c_str(), serial.c_str(), description.path());
  if (arv_gv_fake_camera_is_running(state_->server) == 0) {
    g_object_unref(state_->server);
    throw Error{Fault::busy, address + ": cannot serve a camera there; use the address of a network interface"};
  }
  ArvFakeCamera* camera = state_->registers();
  state_->set_registers();
  const SimMaker& maker = sim_maker(settings.maker);
  state_->name(maker);
  state_->stamp = settings.stamp.value_or(maker.stamp);
  state_->clock = std::make_unique<GvClock>([state = state_.get()](unsigned place) { return state->get(place); },
                                            [camera](unsigned place, const std::string& bytes) {
                                              arv_fake_camera_write_memory(
                                                  camera, place, static_cast<guint32>(bytes.size()), bytes.data());
                                            });
  arv_fake_camera_set_fill_pattern(
      camera,
      [](ArvBuffer* buffer, void* state, guint32 exposure_us, guint32, ArvPixelFormat format) {
        try {
          static_cast<State*>(state)->fill(buffer, exposure_us, format);
        } catch (const Error& problem) {  // glib's frames are no way out for exceptions
          say(problem.what());
          std::_Exit(static_cast<int>(problem.fault));
        } catch (const std::exception& problem) {
          say(problem.what());
          std::_Exit(static_cast<int>(Fault::io));
        }
      },
      state_.get());
}

SimGvCamera::~SimGvCamera() {
  state_->clock.reset();
  g_object_unref(state_->server);
}

}  // namespace vam::sim
