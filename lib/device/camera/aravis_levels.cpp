// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/aravis_levels.hpp"

#include <arv.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/private/aravis_problem.hpp"

namespace vam::device {

namespace {

class Levels {
 public:
  Levels(ArvCamera* camera, const std::string& name) : camera_(camera), name_(name) {}

  [[nodiscard]] bool has(const char* feature) const {
    AravisProblem problem;
    return arv_camera_is_feature_available(camera_, feature, problem) != 0;
  }

  // False where the camera has no such automatic.
  [[nodiscard]] bool switch_off(const char* feature) const {
    if (!has(feature)) return false;
    AravisProblem problem;
    arv_camera_set_string(camera_, feature, "Off", problem);
    const char* now = arv_camera_get_string(camera_, feature, problem);
    if (problem.there() || now == nullptr || std::string(now) != "Off") {
      throw Error{Fault::protocol, name_ + ": " + feature + " cannot be switched off (" +
                                       (problem.there()  ? problem.text()
                                        : now == nullptr ? "no answer"
                                                         : now) +
                                       ")"};
    }
    return true;
  }

  // The first of these features that there is, float or whole; nothing without any.
  [[nodiscard]] std::optional<double> set(const std::string& what, std::initializer_list<const char*> features,
                                          std::optional<double> wanted) const {
    const auto* feature = std::find_if(features.begin(), features.end(), [&](const char* f) { return has(f); });
    if (feature == features.end()) {
      if (!wanted) return std::nullopt;
      throw Error{Fault::usage, name_ + ": has no setting for " + what + "; omit it"};
    }
    AravisProblem problem;
    const bool whole = ARV_IS_GC_INTEGER(arv_device_get_feature(arv_camera_get_device(camera_), *feature)) != 0;
    const auto read = [&] {
      return whole ? static_cast<double>(arv_camera_get_integer(camera_, *feature, problem))
                   : arv_camera_get_float(camera_, *feature, problem);
    };
    if (wanted && whole) arv_camera_set_integer(camera_, *feature, std::lround(*wanted), problem);
    if (wanted && !whole) arv_camera_set_float(camera_, *feature, *wanted, problem);
    if (problem.there()) throw Error{Fault::protocol, name_ + ": " + what + ": " + problem.text()};
    const double got = read();
    if (problem.there()) throw Error{Fault::protocol, name_ + ": " + what + ": " + problem.text()};
    if (wanted) require_read_back(name_ + ": " + what, *wanted, got, step);
    return got;
  }

  void enable_gamma(bool on) const {
    for (const char* feature : {"GammaEnable", "GammaEnabled"}) {
      AravisProblem problem;
      if (has(feature)) arv_camera_set_boolean(camera_, feature, on ? TRUE : FALSE, problem);
    }
  }

 private:
  static constexpr double step = 0.05;  // of a gain in dB, to which cameras round
  ArvCamera* camera_;
  const std::string& name_;
};

}  // namespace

void set_levels(ArvCamera* camera, const std::string& name, const CameraSettings& settings, CameraMode& mode) {
  const Levels levels(camera, name);
  for (const char* automatic : {"ExposureAuto", "GainAuto", "BlackLevelAuto", "GammaAuto", "BalanceWhiteAuto"}) {
    if (levels.switch_off(automatic)) mode.automatic_off.emplace_back(automatic);
  }
  // A camera whose gamma can be switched off is linear without; one that has none is linear anyway.
  levels.enable_gamma(settings.gamma != 1);
  const bool can = settings.gamma != 1 || levels.has("Gamma");
  mode.gamma = levels.set("gamma", {"Gamma"}, can ? std::optional(settings.gamma) : std::nullopt);
  mode.gain = levels.set("gain", {"Gain", "GainRaw"}, settings.gain);
  mode.black_level = levels.set("black level", {"BlackLevel", "BlackLevelRaw"}, settings.black_level);
}

}  // namespace vam::device
