// What a device says about itself, and whether it is a device.
#pragma once

#include <string>

#include "base/json.hpp"

namespace vam::device {

/// In the maker, model or name of every simulated device, so that no log or record can pass it off as a real one.
inline constexpr const char* simulated_mark = "(simulated)";

/// Adds {"simulated": true} to an identity whose maker, model or serial bears the mark, and to Aravis' fake camera.
inline Json with_mark(Json about) {
  const auto bears = [&](const char* key) {
    return about.contains(key) && about[key].is_string() &&
           about[key].get<std::string>().find(simulated_mark) != std::string::npos;
  };
  const bool fake = about.value("model", Json()) == "Fake" && about.value("maker", Json()) == "Aravis";
  if (fake || bears("maker") || bears("model") || bears("serial")) about["simulated"] = true;
  return about;
}

}  // namespace vam::device
