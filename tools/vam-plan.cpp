// SPDX-License-Identifier: GPL-3.0-or-later
// vam-plan: whether and how a part can be printed, in seconds.
#include "base/text/json.hpp"
#include "io/settings/report.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "session/printer.hpp"
#include "vam-plan/options.hpp"
#include "vam-plan/plan.hpp"

namespace {

using namespace vam;

void run(const plan_tool::Options& options) {
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, "-")) return;
  const plan_tool::Plan plan = plan_tool::plan(options, printer);
  io::write_report(options.report, "vam-plan", report(plan));
  if (options.report != "-") io::write_text("-", table(plan));
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
