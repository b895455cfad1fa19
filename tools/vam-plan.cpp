// SPDX-License-Identifier: GPL-3.0-or-later
// vam-plan: whether and how a part can be printed, in seconds.
#include <cmath>
#include <string>
#include <vector>

#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "model/conditions.hpp"
#include "session/printer.hpp"
#include "vam-plan/options.hpp"
#include "vam-plan/plan.hpp"

namespace {

using namespace vam;

/// A figure that this part has not is unmet.
std::vector<model::Condition> conditions_of(const plan_tool::Options& options) {
  if (options.require.empty()) return {};
  return model::parse_conditions(options.require, {"prints", "fits", "scale_that_fits", "slices", "thinnest_wall_mm",
                                                   "thinnest_place_mm", "ver", "pw", "turns", "duration_s"});
}

void run(const plan_tool::Options& options) {
  if (options.printers) return io::write_text("-", io::preset_list());
  const std::vector<model::Condition> conditions = conditions_of(options);
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, "-")) return;
  const plan_tool::Plan plan = plan_tool::plan(options, printer);
  const Json figures = report(plan);
  io::write_report(options.report, "vam-plan", figures);
  if (options.report != "-") io::write_text("-", table(plan));
  model::require_met(conditions, [&](const std::string& name) {
    const Json& value = figures.value(name, Json());
    if (value.is_boolean()) return value.get<bool>() ? 1.0 : 0.0;
    return number_at(figures, name.c_str(), std::nan(""));
  });
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-plan", "estimate within seconds whether and how a part can be printed", manual_page});
  plan_tool::Options options;
  declare(app, options);
  return app.run(argc, argv, [&] {
    options.unit_given = app.given("--unit");
    options.unit_known = app.given("--unit") || app.given("--scale");
    run(options);
  });
}
