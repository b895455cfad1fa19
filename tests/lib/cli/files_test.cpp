// SPDX-License-Identifier: GPL-3.0-or-later
// Files that a tool reads and writes.
#include <unistd.h>

#include <fstream>

#include "lib/cli/demo.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::cli;

TEST_CASE("inputs: one standard input, none of them an output, their contents part of the job") {
  const std::string file = "/tmp/vam-cli-input." + std::to_string(getpid());
  std::ofstream(file) << "first";
  const auto said = [](const std::vector<std::string>& words, std::string* job = nullptr) {
    std::string part = "-", weights, shape, out;
    App app(Manual{"vam-demo", "shows options"});
    app.positional("PART", part, "What to read.").reads({"--shape"});
    app.option("--weights", "FILE", weights, "Weights.").reads();
    app.option("--shape", "NAME", shape, "Instead of PART.");
    app.option("-o,--output", "FILE", out, "Output.").not_in_job().writes();
    const std::string text = written_to(stderr, [&] { run_app(app, words); });
    if (job != nullptr) *job = app.job();
    return text;
  };
  CHECK(said({"--weights", "-"}) ==
        "vam-demo: 2 inputs are standard input, which can be read once; name files for the others\n");
  for (const char* name : {"/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"}) {
    CHECK(said({"--weights", name}).starts_with("vam-demo: 2 inputs are standard input"));
    CHECK(said({file, "--weights", name}).empty());
  }
  CHECK(said({"--weights", "-", "--shape", "cube"}).empty());
  CHECK(said({file, "-o", file}) == "vam-demo: " + file + ": is also the input; write to another file\n");
  CHECK(said({"--weights", file, "-o", file}) == "vam-demo: " + file + ": is also the input; write to another file\n");
  const std::string link = file + ".link";
  for (const auto make : {&::link, &::symlink}) {
    CHECK(make(file.c_str(), link.c_str()) == 0);
    CHECK(said({file, "-o", link}) == "vam-demo: " + link + ": is also the input; write to another file\n");
    CHECK(said({link, "-o", file}) == "vam-demo: " + file + ": is also the input; write to another file\n");
    unlink(link.c_str());
  }
  CHECK(said({"/dev/null", "-o", "/dev/null"}).empty());
  CHECK(said({file, "-o", file + ".absent"}).empty());
  std::string before, same, after;
  CHECK(said({"--weights", file}, &before).empty());
  CHECK(said({"--weights", file}, &same).empty());
  std::ofstream(file) << "second";
  CHECK(said({"--weights", file}, &after).empty());
  CHECK(before == same);
  CHECK(before != after);
  unlink(file.c_str());
}

TEST_CASE("the extension of an output must match its format") {
  for (const auto& [path, status] :
       std::vector<std::pair<std::string, int>>{{"a.png", 0}, {"-", 0}, {"/dev/null", 0}, {"a.jpg", 64}, {"png", 64}}) {
    Tool tool;
    std::string file;
    tool.app.option("--plot", "FILE.png", file, "Plot.").writes({".png", ".tif"});
    const std::string text = written_to(stderr, [&] { CHECK(tool.run({"--plot", path}) == status); });
    CHECK(text == (status == 0 ? "" : "vam-demo: --plot: '" + path + "' must end in .png or .tif\n"));
  }
}

TEST_CASE("two outputs do not share a file or standard output; devices may be shared") {
  const auto run = [](const std::vector<std::string>& words, std::string& text) {
    Tool tool;
    std::string trace;
    std::string report;
    tool.app.option("--trace", "FILE", trace, "Trace.").writes().option("--report", "FILE", report, "Report.").writes();
    int status = 0;
    text = written_to(stderr, [&] { status = tool.run(words); });
    return status;
  };
  std::string text;
  CHECK(run({"--trace", "missing-a", "--report", "missing-b"}, text) == 0);
  CHECK(run({"--trace", "/dev/null", "--report", "/dev/null"}, text) == 0);
  CHECK(run({"--trace", "missing-a", "--report", "./missing-a"}, text) == 64);
  CHECK(text == "vam-demo: --report: would write to ./missing-a, as --trace does; name another file\n");
  CHECK(run({"--trace", "-", "--report", "-"}, text) == 64);
  CHECK(text == "vam-demo: --report: would write to standard output, as --trace does; name a file for one of them\n");
}
