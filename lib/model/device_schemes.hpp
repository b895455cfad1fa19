// SPDX-License-Identifier: GPL-3.0-or-later
// What device strings may consist of: scheme, place and options. The tables of lib/device/open hold how each is opened,
// and the compiler compares them with these; what is accepted, help texts, the list in vam-devices(1), the comments of
// the printer file and tests/tools/devices.t follow.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vam::model {

/// "baud=N", with what it is and its default, for people.
struct DeviceOption {
  std::string_view name;
  std::string_view value;
  std::string_view text = {};  // empty: it is explained elsewhere
};

struct DeviceScheme {
  std::string_view scheme;
  std::string_view place;  // what follows the colon, for people
  std::span<const DeviceOption> options = {};
};

inline constexpr DeviceOption gcs_options[] = {
    {"baud", "N", "rate of the port; default: detected"},
    {"address", "N", "controller of a daisy chain, 1 to 16; default: none"},
    {"axis", "NAME", "axis of the controller; default: 1"},
    {"timeout_s", "S", "longest wait for a reply, 0.01 to 0.4; default: 0.2"}};
inline constexpr DeviceOption tic_options[] = {
    {"steps_per_deg", "N", "microsteps per degree of the stage, negative to reverse it; required"}};
inline constexpr DeviceOption grbl_options[] = {
    {"baud", "N", "rate of the port; default: 115200"},
    {"axis", "X|Y|Z", "axis of the stage; default: X"},
    {"home", "switch|here",
     "what --home does: search the homing switch, or take the present position as 0 degrees for "
     "one command; default: switch"}};
inline constexpr DeviceOption zaber_options[] = {
    {"baud", "N", "rate of the port; default: 115200"},
    {"address", "N", "device of the chain, 1 to 99; default: 1"},
    {"axis", "N", "axis of the device, 1 to 9; default: 1"},
    {"steps_per_deg", "N", "microsteps per degree; default: as stored in the device"}};
inline constexpr DeviceOption sim_stage_options[] = {  // those of vam-sim(1)
    {"acceleration", "DEG/S2"},
    {"speed_error", "FRACTION"},
    {"ripple", "FRACTION"},
    {"max_speed", "DEG/S"},
    {"min_angle", "DEG"},
    {"max_angle", "DEG"},
    {"start_angle", "DEG"},
    {"reply_delay", "MS"},
    {"jitter", "MS"},
    {"address", "N"},
    {"fault", "FAULTS"},
    {"seed", "N"},
    {"log", "FILE"}};
inline constexpr DeviceOption aravis_options[] = {
    {"packet_size", "BYTES", "of GigE Vision, 576 to 9000; default: as the camera has it"},
    {"buffers", "N", "frames that can wait in memory, 10 to 1000; default: 20"}};
inline constexpr DeviceOption v4l2_options[] = {
    {"buffers", "N", "frames that can wait in memory, 2 to 64; default: 10"}};
inline constexpr DeviceOption replay_options[] = {
    {"pace", "real|virtual", "wait for the recorded times, or do not; default: virtual"}};
inline constexpr DeviceOption sim_camera_options[] = {  // those of vam-sim(1), and some of the sensor
    {"part", "BODIES"},
    {"lit", "S"},
    {"follow", "FILE"},
    {"speed", "DEG/S"},
    {"flips", "FILE"},
    {"axis_offset", "PX"},
    {"tilt", "DEG"},
    {"centre", "PX"},
    {"wobble", "MM"},
    {"wobble_phase", "DEG"},
    {"beam", "MM"},
    {"focus", "MM"},
    {"divergence", "DEG"},
    {"projector_gamma", "N"},
    {"vignetting", "FRACTION"},
    {"glow", "FRACTION"},
    {"card", "1"},
    {"columns", "PX"},
    {"rows", "PX"},
    {"bits", "N", "depth of grey levels, 8 to 16; default: 8"},
    {"background", "FRACTION"},
    {"noise", "FRACTION"},
    {"lag", "MS"},
    {"drop", "FRAMES"},
    {"incomplete", "FRAMES"},
    {"unplug", "N"},
    {"shrink", "N"},
    {"pace", "real|virtual", "wait for the frame period, or do not; default: real"},
    {"seed", "N"},
    {"log", "FILE"}};
inline constexpr DeviceOption drm_options[] = {
    {"mode", "COLUMNSxROWS@HZ", "mode of the display, the rate may be omitted; default: the preferred one"},
    {"bpc", "N", "maximum bits per colour on the cable, 6 to 16; default: unchanged"}};
inline constexpr DeviceOption null_options[] = {
    {"hz", "N", "vertical blanks per second, 5 to 1000; default: 60"},
    {"miss", "N", "show every N-th flip one vertical blank late; default: none"}};
inline constexpr DeviceOption light_options[] = {
    {"current_percent", "N", "LED current, in per cent of full; default: unchanged"},
    {"max_current_percent", "N", "limit, if below projector.max_led_current_percent"},
    {"leds", "LETTERS", "LEDs in use, of r, g and b; default: b"}};
inline constexpr DeviceOption sim_light_options[] = {  // those of the others
    {"current_percent", "N"},
    {"max_current_percent", "N"},
    {"leds", "LETTERS"},
    {"log", "FILE"}};
inline constexpr DeviceOption relay_options[] = {{"baud", "N", "rate of the port; default: 115200"}};
inline constexpr DeviceOption sim_relay_options[] = {
    {"fault", "FAULTS", "faults to inject, as KIND@COMMAND:N, separated by commas"}, {"log", "FILE"}};

inline constexpr std::array stage_schemes{
    DeviceScheme{"gcs", "PATH", gcs_options}, DeviceScheme{"tic", "SERIAL", tic_options},
    DeviceScheme{"grbl", "PATH", grbl_options}, DeviceScheme{"zaber", "PATH", zaber_options},
    DeviceScheme{"sim", "", sim_stage_options}};
inline constexpr std::array camera_schemes{
    DeviceScheme{"aravis", "ID-or-IP", aravis_options}, DeviceScheme{"v4l2", "PATH", v4l2_options},
    DeviceScheme{"replay", "PLACE", replay_options}, DeviceScheme{"sim", "", sim_camera_options}};
inline constexpr std::array display_schemes{DeviceScheme{"drm", "CONNECTOR", drm_options},
                                            DeviceScheme{"sdl", "SCREEN"}, DeviceScheme{"null", "", null_options}};
inline constexpr std::array light_schemes{DeviceScheme{"dlpc350", "SERIAL", light_options},
                                          DeviceScheme{"dlpc900", "SERIAL", light_options},
                                          DeviceScheme{"sim", "", sim_light_options}};
inline constexpr std::array relay_schemes{DeviceScheme{"relay", "PATH", relay_options},
                                          DeviceScheme{"sim", "", sim_relay_options}};

/// "a:PATH, b:SERIAL or sim:", of a table whose rows have a scheme and a place.
[[nodiscard]] std::string forms_of(const auto& table) {
  std::string forms;
  for (auto row = std::begin(table); row != std::end(table); ++row) {
    if (row != std::begin(table)) forms += row + 1 != std::end(table) ? ", " : " or ";
    forms += std::string(row->scheme) + ":" + std::string(row->place);
  }
  return forms;
}

/// "sim: baud=N (rate of the port); ...": a line for the options of each scheme, or of several in turn that share them.
[[nodiscard]] std::vector<std::string> options_of(const auto& table) {
  std::vector<std::string> lines;
  std::string schemes;
  for (auto row = std::begin(table); row != std::end(table); ++row) {
    schemes += (schemes.empty() ? "" : ": or ") + std::string(row->scheme);
    if (row + 1 != std::end(table) && row->options.data() == row[1].options.data()) continue;
    std::string line = std::exchange(schemes, "") + ":";
    for (const auto& [name, value, text] : row->options) {
      line += (line.back() == ':' ? " " : "; ") + std::string(name) + "=" + std::string(value) +
              (text.empty() ? "" : " (" + std::string(text) + ")");
    }
    if (!row->options.empty()) lines.push_back(line + ".");
  }
  return lines;
}

/// Whether a table of backends has these schemes, in their order.
template <class Backends, class Schemes>
constexpr bool has_schemes(const Backends& backends, const Schemes& schemes) {
  return std::equal(std::begin(backends), std::end(backends), schemes.begin(), schemes.end(),
                    [](const auto& backend, const DeviceScheme& known) { return backend.scheme == known.scheme; });
}

}  // namespace vam::model
