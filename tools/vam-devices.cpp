// SPDX-License-Identifier: GPL-3.0-or-later
// vam-devices: the devices of this machine, and why some cannot be used; and all of them off.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "device/open/find.hpp"
#include "device/open/off.hpp"
#include "device/port/lines.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "manual_page.hpp"
#include "model/device_schemes.hpp"
#include "session/printer.hpp"

namespace {

using namespace vam;

struct Options {
  std::vector<std::string> ports;
  bool probe = false;
  std::string report;
  std::string light;  // of off; empty: those that are found, "none": none
  cli::PrinterOptions printer;
};

/// A paragraph for the options of each kind of device, and one for each option.
std::vector<std::string> device_texts() {
  std::vector<std::string> texts;
  const auto add = [&](const std::string& kind, const auto& schemes) {
    texts.push_back("Options of a " + kind + ":");
    for (std::string& line : model::options_of(schemes)) texts.push_back(std::move(line));
  };
  add("stage", model::stage_schemes);
  add("camera", model::camera_schemes);
  add("display", model::display_schemes);
  add("light engine", model::light_schemes);
  add("relay (projector.relay)", model::relay_schemes);
  return texts;
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

void print(const std::vector<device::DeviceListing>& found) {
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
  std::vector<device::DeviceListing> found = device::find_devices(options.ports);
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

// A printer file that cannot be read keeps no light on.
std::vector<device::Switched> to_switch_off(const Options& options, std::vector<std::string>& problems, Fault& fault) {
  std::vector<device::Switched> devices;
  const auto add = [&](const char* kind, const std::string& device) {
    if (!device.empty()) devices.push_back({kind, device});
  };
  if (options.light.empty()) devices = device::find_lit();
  if (options.light != "none") add("light", options.light);
  try {
    const auto printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
    add("relay", printer.projector.relay);
    add("stage", printer.stage.device);
  } catch (const Error& error) {
    problems.emplace_back(error.what());
    fault = error.fault;
  }
  return devices;
}

void switch_off(const Options& options) {
  if (session::print_printer(options.printer)) return;
  std::vector<std::string> problems;
  Fault fault = Fault::busy;
  auto devices = to_switch_off(options, problems, fault);
  if (devices.empty() && problems.empty()) {
    throw Error{Fault::usage,
                "off: no device to switch off: the printer file names no stage and no relay, and no light engine is on "
                "USB; give --printer FILE"};
  }
  device::switch_off(devices);
  for (const auto& one : devices) {
    if (one.problem.empty()) {
      device::print_line(std::string(one.kind).append(9 - one.kind.size(), ' ') + one.device + "  " + one.state);
      continue;
    }
    if (problems.empty()) fault = one.fault;
    problems.push_back(one.kind + " " + one.problem);
  }
  if (!problems.empty()) {
    throw Error{fault, "not everything is off: " + join(problems, "; ") + "; cut the power by hand"};
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::App app({"vam-devices",
                "list stages, cameras, displays and light engines",
                manual_page,
                {{69, "off: a device is absent."},
                 {75, "off: a device is in use, or timed out; try again."},
                 {76, "off: device protocol error."}},
                false,
                {cli::ManualList{"devices", device_texts()}}});
  app.option("--port", "PATH", options.ports, "Serial port to list in addition to those of the system.");
  app.flag("--probe", options.probe, "Query the serial ports for stage controllers.");
  cli::add_report(app, options.report);
  auto& off =
      app.subcommand("off", "switch everything off: light, relay, displays, stage", [&] { switch_off(options); });
  off.option("--light", "DEVICE", options.light, "Light engine, and no display; none for no light engine.")
      .default_is("every light engine on USB, and every display in use");
  cli::add_printer(off, options.printer);
  return app.run(argc, argv, [&] { run(options); });
}
