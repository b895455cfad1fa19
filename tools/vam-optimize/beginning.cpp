// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/beginning.hpp"

#include <utility>

namespace vam::optimize_tool {

Beginning::Beginning(const cli::App& app, const model::Printer& printer, const model::StackInfo& info,
                     const Options& options)
    : count_(info.count), width_(info.width), height_(info.height) {
  if (!options.init.empty()) initial_.emplace(options.init, info);
  if (options.checkpoint.empty()) return;
  checkpoint_.emplace(options.checkpoint);
  interruption_ = checkpoint_->interruption(job_of(app, printer, options));
}

void Beginning::begin(optimize::VolumeTask& task, const Inputs& in, const Scene& scene, const light::Operator& light,
                      Options& options) {
  if (initial_) task.initial = [this](int k) { return k < count_ ? (*initial_)(k) : Image(width_, height_); };
  task.interruption = interruption_;
  if (interruption_.from != nullptr && light.couples_slices()) return;  // there is one pass
  if (auto start = coarse_start(in, scene, options)) continue_from(std::move(*start), task, options);
}

}  // namespace vam::optimize_tool
