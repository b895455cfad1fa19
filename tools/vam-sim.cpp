// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sim: simulated devices, for the tools that drive them.
#include "cli/app.hpp"
#include "manual_page.hpp"
#include "vam-sim/commands.hpp"

using namespace vam;

int main(int argc, char** argv) {
  cli::App app({"vam-sim",
                "simulate a rotation stage, or a camera beside the vial",
                manual_page,
                {{69, "No pseudo-terminal is available."},
                 {75, "The address is in use by another camera, or cannot serve one."},
                 {129, "SIGHUP."},
                 {130, "SIGINT."},
                 {143, "SIGTERM."}}});
  sim_tool::add_stage(app);
  sim_tool::add_camera(app);
  return app.run(argc, argv);
}
