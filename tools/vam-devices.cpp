// SPDX-License-Identifier: GPL-3.0-or-later
// vam-devices: the devices of this machine, and why some cannot be used.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/json.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "device/open/find.hpp"
#include "device/port/lines.hpp"
#include "io/settings/report.hpp"
#include "model/device_schemes.hpp"

namespace {

using namespace vam;

struct Options {
  std::vector<std::string> ports;
  bool probe = false;
  std::string report;
};

void add_options(std::vector<std::string>& notes, const std::string& kind, const auto& schemes) {
  notes.push_back("Options of a " + kind + ", after a question mark and separated by &:");
  for (std::string& line : model::options_of(schemes)) notes.push_back(std::move(line));
}

std::vector<std::string> notes() {
  std::vector<std::string> notes{
      "Duration. About a second, the time allowed for replies of network cameras; with --probe up to 4 s more per "
      "port.",
      "Limits. A camera in another subnet is not found; give its IP address (aravis:192.168.1.7)."};
  add_options(notes, "stage", model::stage_schemes);
  add_options(notes, "camera", model::camera_schemes);
  add_options(notes, "display", model::display_schemes);
  add_options(notes, "light engine", model::light_schemes);
  add_options(notes, "relay (projector.relay)", model::relay_schemes);
  return notes;
}

cli::Manual manual() {
  return {
      "vam-devices",
      "list stages, cameras, displays and light engines",
      {"Lists the devices found on this machine, each with its device string, for the printer file and for --device, "
       "--display and --light, and a description. A line below a device states why it cannot be used, and the remedy: "
       "access denied (with the group to join or the udev rule to add), in use by another program (with its process "
       "number), a graphics card controlled by a desktop session. If no device of a kind is found, the checks to make "
       "are listed.",
       "No commands are sent: nothing moves and no light is switched on. The device on a serial port cannot be "
       "determined in this way; the port is listed as gcs: or, where the maker of its USB converter suggests another "
       "protocol, by that scheme. --probe queries each port for the identity of a controller, by one protocol after "
       "the other. This does not move the stage, but most GRBL boards are reset when their port is opened, and other "
       "instruments on such ports receive commands of a protocol that they do not understand."},
      {{"List the connected devices:", "vam-devices"},
       {"A simulated stage on a pseudo-terminal, queried for its identity:",
        "vam-sim-stage --link port --die-with-parent >pty & while [ ! -s pty ]; do sleep 0.1; done; "
        "LD_PRELOAD=$(vam-sim-stage --shim) vam-devices --port \"$PWD/port\" --probe"}},
      notes(),
      {"vam-stage", "vam-capture", "vam-project", "vam-print"},
      {},
      {},
      true,
      false};
}

struct Kind {
  const char* name;
  const char* advice;
};
constexpr Kind kinds[] = {
    Kind{"stage", "check power and cable; sim: is a simulated one"},
    Kind{"camera", "check power, cable and, on a network, the address; sim: is a simulated one"},
    Kind{"display", "connect the projector and switch it on; null: is a dry run"},
    Kind{"light", "check the USB cable, or use a projector without one; sim: is a simulated one"}};

void print(const std::vector<device::Found>& found) {
  std::size_t width = 0;
  for (const auto& one : found) width = std::max(width, one.device.size());
  const auto column = [](std::string text, std::size_t to) { return text.append(to - std::min(to, text.size()), ' '); };
  for (const auto& [kind, advice] : kinds) {
    bool any = false;
    for (const auto& one : found) {
      if (one.kind != kind) continue;
      any = true;
      device::print_line(column(kind, 9) +
                         (one.about.empty() ? one.device : column(one.device, width) + "  " + one.about));
      if (!one.obstacle.empty()) device::print_line(column("", 9) + "! " + one.obstacle);
    }
    if (!any) device::print_line(column(kind, 9) + "none found; " + advice);
  }
}

void run(const Options& options) {
  std::vector<device::Found> found = device::find_devices(options.ports);
  for (auto& one : found) {
    if (options.probe && one.kind == "stage") device::ask_stage(one);
  }
  if (options.report != "-") print(found);
  Json list = Json::array();
  for (const auto& one : found) {
    list.push_back({{"kind", one.kind}, {"device", one.device}, {"description", one.about}, {"problem", one.obstacle}});
  }
  io::write_report(options.report, "vam-devices", {{"found", list}});
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::App app(manual());
  app.option("--port", "PATH", options.ports, "Serial port to list in addition to those of the system.");
  app.flag("--probe", options.probe, "Query the serial ports for stage controllers.");
  cli::add_report(app, options.report);
  return app.run(argc, argv, [&] { run(options); });
}
