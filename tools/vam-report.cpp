// SPDX-License-Identifier: GPL-3.0-or-later
// vam-report: a print, from part to dose, as one page.
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "grey_options.hpp"
#include "io/stream/stream.hpp"
#include "plot/page.hpp"
#include "printer.hpp"
#include "vam-report/content.hpp"
#include "vam-report/names.hpp"
#include "vam-report/page_data.hpp"
#include "vam-report/sources.hpp"

namespace {

using namespace vam;

struct Options {
  std::vector<std::string> files;
  std::string output = "-";
  std::string title;
  int sections = 24;
  int projections = 36;
  tool::GreyChoice grey;
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  return {
      "vam-report",
      "show a part, its projections, dose and figures on one page",
      {"vam-report writes one page (HTML) from the files of a print, for a laboratory notebook, the supplement of "
       "a publication, or a colleague. It needs neither network nor server: images, values and script are "
       "embedded, and the page can load nothing else. It opens in any browser, including mobile browsers, and "
       "can be printed to PDF.",
       "FILE is a volume (target, dose, scatter, insert), a mesh, a stack of sinograms or frames, a video, a report in "
       "JSON (--report of any tool), the trace of vam-optimize or a PNG image; of a folder, all such files are "
       "used. The type of a file is determined by its content.",
       "Depending on the files, the page contains: the verdict of vam-score with its figures of merit; design and "
       "print in three dimensions, the design coloured by the margin of the dose on its surface, the print by its "
       "distance from the design; sections of every volume, those of the dose with the outline of the design, and of "
       "what it prints; the "
       "projections as an animation, and the sinograms; the dose distributions in part and void; the convergence "
       "of the optimisation; all reports; and for each file the commands that produced it, with their seals.",
       "An inspection: with the print of vam-sdf (-o), the mesh of the design and the report of vam-sdf, the page has "
       "its verdict, every figure with its expanded uncertainty, the print in three dimensions in the colours of its "
       "deviation, sections through its middle with the dimensions of the print, their expanded uncertainties, and "
       "those of the design, and the histogram of the "
       "deviation, the outermost bins of which hold what is beyond.",
       "The first target and the first dose are scored as by vam-score, with the settings of the printer file. With "
       "--grey-target the target is a dose for every voxel: the page has the verdict and the figures of vam-score "
       "--grey-target, and neither a print in three dimensions nor what prints."},
      {{"A print from design to dose:",
        "vam-slice --shape gyroid --voxel 0.3 -o part.vdb\n"
        "vam-optimize part.vdb --angles 120 --iterations 12 --trace trace.csv -o light.exr --report light.json\n"
        "vam-dose light.exr --like part.vdb -o dose.vdb\n"
        "vam-report part.vdb light.exr dose.vdb light.json trace.csv -o report.html"},
       {"The inspection of a print:",
        "vam-slice --shape box:x=6,y=6,z=6 --voxel 0.2 --stretch-z 1 -o design.vdb\n"
        "vam-slice --shape box:x=6.2,y=6.2,z=6.2 --voxel 0.2 --stretch-z 1 -o seen.vdb\n"
        "vam-sdf seen.vdb design.vdb --isovalue 0.5 -o deviation.ply --report inspection.json\n"
        "vam-report deviation.ply inspection.json -o inspection.html"},
       {"Everything in a folder:",
        "mkdir print\n"
        "vam-slice --shape gyroid --voxel 0.3 -o print/part.vdb\n"
        "vam-optimize print/part.vdb --angles 120 -o print/light.exr --report print/light.json\n"
        "vam-dose print/light.exr --like print/part.vdb -o print/dose.vdb\n"
        "vam-report print -o print.html"}},
      {"Memory: the volumes as stored in their files, one image of a stack, and the page itself. A page has 2 to "
       "15 MB, depending on --max-sections and --max-images.",
       "Surfaces are computed on voxels averaged until they have less than 60,000 vertices; for measurements use "
       "vam-sdf."},
      {"vam-check", "vam-score", "vam-sdf", "vam-status", "vam-view"}};
}

void declare(cli::App& app, Options& o) {
  app.positional("FILE ...", o.files, "Volumes, meshes, stacks, videos, reports, traces, images, or folders of them.")
      .reads();
  app.option("-o,--output", "FILE", o.output, "Write the page to FILE; - is standard output.")
      .writes({".html", ".htm"});
  app.option("--title", "TEXT", o.title, "Title of the page.").default_is("the name of the first file");
  app.option("--max-sections", "N", o.sections, {1, 200}, "Maximum number of sections of a volume.");
  app.option("--max-images", "N", o.projections, {1, 360}, "Maximum number of images of a stack or video.");
  tool::add_grey_target(app, o.grey);
  cli::add_printer(app, o.printer);
  cli::add_threads(app);
  app.usual({"--output", "--title", "--max-sections", "--max-images", "--grey-target", "--printer", "--set"});
}

void run(const cli::App& app, Options& o) {
  const model::Printer printer = tool::load_printer(o.printer);
  if (tool::print_printer(o.printer, printer, o.output)) return;
  if (o.files.empty()) throw Error{Fault::usage, "FILE: give the files of a print, or their folder"};
  if (o.title.empty()) o.title = report_tool::file_name(o.files.front());
  plot::Page page;
  page.title = o.title;
  page.style = report_tool::page_style;
  page.script = report_tool::page_script;
  page.body = report_tool::content(report_tool::gather(o.files), printer,
                                   {o.title, app.history(), o.sections, o.projections, o.grey});
  io::write_text(o.output, plot::html(page));
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
