// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/cameras/makers.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::sim {

using device::StampMoment;

namespace {

// A frame rate is applied after this only (Aravis' own special case, arvcamera.c, ARV_CAMERA_VENDOR_POINT_GREY_FLIR).
constexpr const char* rate_enabled =
    "<Boolean Name=\"AcquisitionFrameRateEnabled\"><pValue>RateEnabledRegister</pValue><OnValue>1</OnValue>"
    "<OffValue>0</OffValue></Boolean>\n"
    "<IntReg Name=\"RateEnabledRegister\"><Address>0x1E0</Address><Length>4</Length><AccessMode>RW</AccessMode>"
    "<pPort>Device</pPort><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n";

const std::vector<SimMaker>& sim_makers() {
  static const std::vector<SimMaker> makers{
      {"aravis", "Aravis", "Fake", StampMoment::end},
      // pilot User's Manual, 11.17.4 Time Stamp: made when the acquisition of the image was triggered.
      {"basler", "Basler", "piA (simulated)", StampMoment::start},
      // Genie Nano User's Manual, Event Control: timestampLatchSource is FrameStart, before the exposure.
      {"dalsa", "Teledyne DALSA", "Nano (simulated)", StampMoment::start},
      // Technical guidance "Imaging products timestamping": stamped when the shutter was closed.
      {"flir", "Point Grey Research", "Grasshopper3 (simulated)", StampMoment::end, rate_enabled}};
  return makers;
}

}  // namespace

std::vector<std::string> sim_maker_names() {
  std::vector<std::string> names;
  for (const auto& maker : sim_makers()) names.push_back(maker.name);
  return names;
}

const SimMaker& sim_maker(const std::string& name) {
  const auto& makers = sim_makers();
  const auto found = std::find_if(makers.begin(), makers.end(), [&](const SimMaker& m) { return m.name == name; });
  if (found != makers.end()) return *found;
  throw Error{Fault::usage, "camera maker '" + name + "' is not one of " + join(sim_maker_names(), ", ")};
}

}  // namespace vam::sim
