// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/light.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "io/exr/stack_batches.hpp"
#include "io/stream/stream.hpp"
#include "resin/dither.hpp"
#include "session/printer.hpp"
#include "vam-dose/shown.hpp"

namespace vam::dose_tool {

namespace {

/// What the projector makes of the sinograms: a range, and on request the grey levels in it.
class Display {
 public:
  Display(const light::DisplayRange& range, const Options& options, const model::Projector& projector) : range_(range) {
    if (!options.bits) return;
    levels_.emplace(session::response_of(projector), *options.bits);
    if (options.dither_turns) dither_.emplace(*levels_, *options.dither_turns);
  }

  void shine(std::span<Image> sinograms, light::LightSeen& seen) const {
    light::shine(range_, sinograms, seen);
    if (!levels_) return;
    parallel_for(count_of(sinograms), [&](int k) {
      if (dither_) {
        sinograms[k] = resin::dithered(sinograms[k], *dither_);
      } else {
        for (float& value : sinograms[k].values) value = levels_->intensity(levels_->level(value));
      }
    });
  }

 private:
  light::DisplayRange range_;
  std::optional<resin::GreyLevels> levels_;
  std::optional<resin::Dither> dither_;
};

light::DisplayRange range_of(const Options& options, const std::optional<double>& full_scale, bool projector,
                             const model::Projector& by) {
  const bool rounded = options.bits.has_value();  // the response has what leaks at grey 0
  return {projector && options.negative == "clip", full_scale,
          rounded ? 0 : by.min_intensity_mw_cm2 / by.max_intensity_mw_cm2};
}

void require_alike(const model::StackInfo& first, const model::StackInfo& info, const std::string& path,
                   const Options& options) {
  if (info.space == first.space && info.width == first.width && info.height == first.height &&
      info.count == first.count && info.z_start_mm == first.z_start_mm) {
    return;
  }
  throw Error{Fault::data, path + ": has other columns, angles or slices than " + options.inputs.front() +
                               ", so that no print can have shown both"};
}

/// By what is in them, as the log knows them.
void require_distinct_light(const std::vector<std::string>& paths) {
  std::set<std::string> hashes;
  for (const std::string& path : paths) {
    if (path == "-") throw Error{Fault::usage, "SINOGRAM: of several each is a file, whose hash is in the log"};
    if (hashes.insert(io::sha256_of(path)).second) continue;
    throw Error{Fault::usage, path + ": is given twice, but its light was delivered once; give each sinogram once"};
  }
}

}  // namespace

struct Light::Part {
  std::unique_ptr<io::StackReader> own;
  io::StackReader& reader;
  Display display;
  std::vector<double> turns;
  std::unique_ptr<io::ReadAhead> ahead = {};
};

Light::Light(io::StackReader& first, const model::StackInfo& info, const Options& options,
             const model::Printer& printer, double stated_turns)
    : sealed_(first.is_sealed()) {
  if (options.inputs.size() > 1 && options.shown.empty()) {
    throw Error{Fault::usage, "SINOGRAM: several add up only as a print showed them; give its --shown, or one of them"};
  }
  if (options.inputs.size() > 1) require_distinct_light(options.inputs);
  const bool projector = info.space == model::Space::projector;
  for (const std::string& path : options.inputs) {
    std::unique_ptr<io::StackReader> own;
    if (path != options.inputs.front()) {
      own = std::make_unique<io::StackReader>(path);
      require_alike(info, own->info(), path, options);
    }
    const auto full_scale =
        options.inputs.size() == 1 ? options.full_scale : std::optional(shown_full_scale(options, path));
    std::vector<double> turns = shown_turns(options, path, full_scale, info, printer);
    for (const double t : turns) turns_ += t / static_cast<double>(turns.size());
    if (options.shown.empty() && info.poses.empty()) turns = shares_of(stated_turns, info.height);
    io::StackReader& reader = own ? *own : first;
    parts_.push_back(std::make_unique<Part>(
        Part{std::move(own), reader,
             Display(range_of(options, full_scale, projector, printer.projector), options, printer.projector),
             std::move(turns)}));
  }
  if (!options.shown.empty() && turns_ == 0) {
    throw Error{Fault::data, options.shown.front() + ": no light was shown in this run" +
                                 (options.before_s ? " before that time; check --before" : "")};
  }
  require_all_sinograms(options);
}

Light::~Light() = default;

void Light::begin(int batch) {
  for (const auto& part : parts_) part->ahead = std::make_unique<io::ReadAhead>(part->reader, batch);
}

std::vector<Image> Light::next() {
  std::vector<Image> sum;
  for (const auto& part : parts_) {
    std::vector<Image> slices = part->ahead->next();
    part->display.shine(slices, seen_);
    weigh(part->turns, slices);
    if (sum.empty()) {
      sum = std::move(slices);
      continue;
    }
    parallel_for(count_of(slices), [&](int k) {
      std::transform(slices[k].values.begin(), slices[k].values.end(), sum[k].values.begin(), sum[k].values.begin(),
                     [](float one, float other) { return one + other; });
    });
  }
  return sum;
}

}  // namespace vam::dose_tool
