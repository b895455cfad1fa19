// vam-report: a print, from part to dose, as one page.
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
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
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  return {
      "vam-report",
      "show a part, its projections, dose and figures on one page",
      {"Writes one page (HTML) from the files of a print, for a notebook, a publication's supplement, or a colleague. "
       "It "
       "needs no network and no server: images, values and script are within, and nothing else can run. It opens in "
       "any "
       "browser, on a telephone, too, and prints to PDF.",
       "FILE is a volume (target, dose, scatter, insert), a stack of sinograms or frames, a video, a report in JSON "
       "(--report of any tool), the trace of vam-optimize or a PNG image; of a folder all such files are taken. What a "
       "file is, is determined by its content.",
       "The page has, as far as the files tell: the verdict of vam-score with its figures; design and print as bodies "
       "that can be turned, the design coloured by the margin of the dose on its surface, the print by its distance "
       "from the design; sections of every volume, the dose with the design's outline; the projections as they play, "
       "and the sinograms; the dose in part and void; convergence; all reports; and for each file the commands that it "
       "was made by, with their seals.",
       "The first target and the first dose are judged, with the settings of the printer file, as vam-score does."},
      {{"A print from design to dose:",
        "vam-slice --shape gyroid --voxel 0.3 -o part.vdb && vam-optimize part.vdb --angles 120 --iterations 12 "
        "--trace "
        "trace.csv -o light.exr --report light.json && vam-dose light.exr --like part.vdb -o dose.vdb && vam-report "
        "part.vdb light.exr dose.vdb light.json trace.csv -o report.html"},
       {"Everything in a folder:",
        "mkdir print && cp part.vdb dose.vdb light.json print/ && vam-report print -o print.html"}},
      {"Memory: the volumes as stored in their files, one image of a stack, and the page itself. A page has 2 to 15 "
       "MB, by "
       "--sections and --projections.",
       "Surfaces are drawn from voxels averaged until they have less than 60,000 vertices; for measurement use "
       "vam-sdf."},
      {"vam-check", "vam-score", "vam-sdf", "vam-status", "vam-view"}};
}

void declare(cli::App& app, Options& o) {
  app.positional("FILE ...", o.files, "Volumes, stacks, videos, reports, traces, images, or folders of them.").reads();
  app.option("-o,--output", "FILE", o.output, "Write the page to FILE; - is standard output.")
      .writes({".html", ".htm"});
  app.option("--title", "TEXT", o.title, "Title of the page.").default_is("the name of the first file");
  app.option("--sections", "N", o.sections, {1, 200}, "Maximum number of sections of a volume.");
  app.option("--projections", "N", o.projections, {1, 360}, "Maximum number of images of a stack or video.");
  cli::add_printer(app, o.printer);
  cli::add_threads(app);
}

void run(const cli::App& app, Options& o) {
  const model::Printer printer = tool::load_printer(o.printer);
  if (tool::print_printer(o.printer, printer, o.output)) return;
  if (o.files.empty()) throw Error{Fault::usage, "FILE: name the files of a print, or their folder"};
  if (o.title.empty()) o.title = report_tool::file_name(o.files.front());
  plot::Page page;
  page.title = o.title;
  page.style = report_tool::page_style;
  page.script = report_tool::page_script;
  page.body =
      report_tool::content(report_tool::gather(o.files), printer, {o.title, app.history(), o.sections, o.projections});
  io::write_text(o.output, plot::html(page));
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
