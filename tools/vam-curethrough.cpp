// SPDX-License-Identifier: GPL-3.0-or-later
// vam-curethrough: continuous stereolithography without cure-through [CURE19].
#include <string>

#include "cli/app.hpp"
#include "manual_page.hpp"
#include "printer.hpp"
#include "vam-curethrough/subcommands.hpp"

using namespace vam;

int main(int argc, char** argv) {
  cli::App app({"vam-curethrough", "model and correct cure-through in continuous stereolithography", manual_page});
  std::string chosen;
  curethrough::ModelOptions model;
  curethrough::CorrectOptions correct;
  curethrough::SweepOptions sweep;
  cli::App& for_model = app.subcommand("model", "compute dose and cure map of slices", chosen);
  cli::App& for_correct = app.subcommand("correct", "compute slices without cure-through", chosen);
  cli::App& for_sweep = app.subcommand("sweep", "study parameters on a ladder", chosen);
  curethrough::declare(for_model, model);
  curethrough::declare(for_correct, correct);
  curethrough::declare(for_sweep, sweep);
  return app.run(argc, argv, [&] {
    if (chosen == "model" && !tool::print_printer(model.print.printer)) run(app, for_model, model);
    if (chosen == "correct" && !tool::print_printer(correct.print.printer)) run(app, for_correct, correct);
    if (chosen == "sweep" && !tool::print_printer(sweep.print.printer)) run(app, for_sweep, sweep);
  });
}
