// SPDX-License-Identifier: GPL-3.0-or-later
// vam-curethrough: continuous stereolithography without cure-through [CURE19].
#include "cli/app.hpp"
#include "manual_page.hpp"
#include "vam-curethrough/subcommands.hpp"

using namespace vam;

int main(int argc, char** argv) {
  cli::App app({"vam-curethrough", "model and correct cure-through in continuous stereolithography", manual_page});
  curethrough::add_model(app);
  curethrough::add_correct(app);
  curethrough::add_sweep(app);
  return app.run(argc, argv);
}
