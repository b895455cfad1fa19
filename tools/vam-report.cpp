// SPDX-License-Identifier: GPL-3.0-or-later
// vam-report: a print, from part to dose, as one page.
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "plot/page.hpp"
#include "session/grey_target.hpp"
#include "session/printer.hpp"
#include "vam-report/content.hpp"
#include "vam-report/page_parts.hpp"
#include "vam-report/sources.hpp"

namespace {

using namespace vam;

struct Options {
  std::vector<std::string> files;
  std::string output = "-";
  std::string title;
  int sections = 24;
  int projections = 36;
  session::GreyChoice grey;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, Options& o) {
  app.positional("FILE ...", o.files, "Volumes, meshes, stacks, videos, reports, traces, images, or folders of them.")
      .reads();
  app.option("-o,--output", "FILE", o.output, "Write the page to FILE; - is standard output.")
      .writes({".html", ".htm"});
  app.option("--title", "TEXT", o.title, "Title of the page.").default_is("the name of the first file");
  app.option("--max-sections", "N", o.sections, {1, 200}, "Maximum number of sections of a volume.")
      .not_for({report_tool::no_volume});
  app.option("--max-images", "N", o.projections, {1, 360}, "Maximum number of images of a stack or video.")
      .not_for({report_tool::no_light});
  session::add_grey_target(app, o.grey, {}, {report_tool::no_target}, {report_tool::no_dose});
  cli::add_printer(app, o.printer);
  cli::add_threads(app);
  app.usual({"--output", "--title", "--max-sections", "--max-images", "--grey-target", "--printer", "--set"});
}

void run(const cli::App& app, Options& o) {
  if (session::print_printer(o.printer, o.output)) return;
  if (o.files.empty()) throw Error{Fault::usage, "FILE: give the files of a print, or their folder"};
  if (o.title.empty()) o.title = report_tool::file_name(o.files.front());
  plot::Page page;
  page.title = o.title;
  page.style = report_tool::page_style;
  page.script = report_tool::page_script;
  page.body =
      report_tool::content(app, report_tool::gather(o.files), o.printer, {o.title, o.sections, o.projections, o.grey});
  io::write_text(o.output, plot::html(page));
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-report", "show a part, its projections, dose and figures on one page", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
