// SPDX-License-Identifier: GPL-3.0-or-later
// vam-capture's plain form and identify.
#pragma once

#include <memory>

#include "cli/app.hpp"
#include "vam-capture/options.hpp"

namespace vam::capture_tool {

/// The camera that the options and the printer file name, with their settings.
[[nodiscard]] std::unique_ptr<device::Camera> open_camera(const Options& options, const model::Printer& printer);

void identify(const Options& options);
void take(const cli::App& app, const Options& options);

}  // namespace vam::capture_tool
