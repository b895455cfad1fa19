// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/app.hpp"

#include <cstring>

#include "cli/private/declaration.hpp"
#include "lib/cli/demo.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::cli;

TEST_CASE("options reach their variables") {
  Tool tool;
  CHECK(tool.run({"part.vdb", "--voxel", "0.1", "--angles=90", "--rotate", "-10,20,3.5", "--window", "cosine", "--half",
                  "--set", "a=1", "--set", "b=2"}) == 0);
  CHECK(tool.voxel_mm == 0.1);
  CHECK(tool.angles == 90);
  CHECK(tool.rotate == std::vector<double>{-10, 20, 3.5});
  CHECK(tool.window == "cosine");
  CHECK(tool.half);
  CHECK(tool.sets == std::vector<std::string>{"a=1", "b=2"});
  CHECK(tool.input == "part.vdb");
  CHECK(tool.app.given("--voxel"));
  CHECK(tool.app.history() ==
        std::string("vam-demo ") + VAM_VERSION +
            " part.vdb --voxel 0.1 --angles=90 --rotate -10,20,3.5 --window cosine --half --set a=1 --set b=2");
}

TEST_CASE("options can be left out of the history, with their values") {
  const auto without = [](const std::vector<std::string>& words) {
    Tool tool;
    CHECK(tool.run(words) == 0);
    return tool.app.history_without({"--voxel", "--half"})
        .substr(std::string("vam-demo ").size() + std::strlen(VAM_VERSION));
  };
  CHECK(without({"part.vdb", "--voxel", "0.1", "--angles", "90"}) == " part.vdb --angles 90");
  CHECK(without({"--half", "part.vdb", "--voxel=0.1"}) == " part.vdb");
  CHECK(without({"--angles", "90", "--half", "--", "part.vdb"}) == " --angles 90 -- part.vdb");
}

TEST_CASE("a number may be left out behind an option that says so") {
  struct Case {
    std::vector<std::string> words;
    double clearance;
    const char* input;
    const char* window;
  };
  for (const auto& [words, clearance, input, window] :
       std::vector<Case>{{{"--cut"}, 0.5, "-", "hann"},
                         {{"--cut", "part.vdb"}, 0.5, "part.vdb", "hann"},
                         {{"part.vdb", "--cut", "2"}, 2, "part.vdb", "hann"},
                         {{"--cut=3", "part.vdb"}, 3, "part.vdb", "hann"},
                         {{"--cut", "--window", "cosine"}, 0.5, "-", "cosine"},
                         {{"--cut", "--", "7"}, 0.5, "7", "hann"},
                         {{"--", "--cut"}, 0, "--cut", "hann"}}) {
    Tool tool;
    std::optional<double> cut;
    tool.app.option("--cut", "MM", cut, non_negative, "Cut.").when_left_out("0.5");
    CHECK(tool.run(words) == 0);
    CHECK(cut.value_or(0) == clearance);
    CHECK(tool.input == input);
    CHECK(tool.window == window);
  }
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--cut", "-1"}, {"--voxel", "--cut"}}) {
    Tool tool;
    std::optional<double> cut;
    tool.app.option("--cut", "MM", cut, non_negative, "Cut.").when_left_out("0.5");
    CHECK(tool.run(words) == 64);
  }
}

TEST_CASE("a repeatable option takes one value each time and leaves positionals alone") {
  Tool tool;
  CHECK(tool.run({"--set", "a=1", "part.vdb"}) == 0);
  CHECK(tool.input == "part.vdb");
  CHECK(tool.sets.size() == 1);
}

TEST_CASE("wrong options are usage errors") {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--voxle", "1"},
                                             {"--voxel", "0"},
                                             {"--voxel", "-1"},
                                             {"--voxel", "abc"},
                                             {"--voxel", "nan"},
                                             {"--voxel"},
                                             {"--angles", "1.5"},
                                             {"--angles", "0"},
                                             {"--rotate", "1,2"},
                                             {"--window", "han"},
                                             {"a", "b"},
                                             {"--window", ""},
                                             {""},
                                             {"--half", "--half=x"},
                                             {"--voxel", "1", "--voxel", "2"}}) {
    Tool tool;
    CAPTURE(words.back());
    CHECK(tool.run(words) == 64);
  }
}

TEST_CASE("faults become exit codes") {
  Tool tool;
  std::vector<std::string> words{"vam-demo"};
  char* argv[] = {words[0].data()};
  CHECK(tool.app.run(1, argv, [] { throw Error{Fault::data, "bad"}; }) == 65);
  CHECK(tool.app.run(1, argv, [] { throw std::bad_alloc(); }) == 71);
  CHECK(tool.app.run(1, argv, [] { throw std::runtime_error("x"); }) == 70);
}

namespace {

// A tool that does nothing without a command, or, with `plain`, something.
struct Stage {
  std::string chosen, device = "sim:", input = "-", file;
  double speed = 1, angle = 0;
  bool quick = false;
  App app{Manual{"vam-demo", "shows commands"}};
  explicit Stage(bool plain = false) {
    if (plain) app.positional("INPUT", input, "What to read.").flag("--quick", quick, "Quick.");
    App& spin = app.subcommand("spin", "turn on", [this] { chosen = "spin"; });
    spin.option("--device", "DEVICE", device, "The stage.");
    spin.option("--speed", "DEG_S", speed, positive, "Speed.").default_is("stage.speed_deg_s");
    App& move = app.subcommand("move", "go there", [this] { chosen = "move"; });
    move.option("--device", "DEVICE", device, "The stage.").option("--angle", "DEG", angle, any, "Angle.");
    move.positional("FILE", file, "A file.");
  }
  int run(const std::vector<std::string>& words) { return run_app(app, words); }
};

std::string man_of(Stage& stage) {
  return written_to(stdout, [&] { CHECK(stage.run({"--man"}) == 0); });
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("an operand of a command may have the name of another command") {
  Stage stage;
  CHECK(stage.run({"move", "spin", "--angle", "3"}) == 0);
  CHECK(stage.chosen == "move");
  CHECK(stage.file == "spin");
  CHECK(stage.angle == 3);
}

TEST_CASE("a command is asked for its own options") {
  Stage stage(true);
  CHECK(stage.run({"spin", "--speed", "2"}) == 0);
  CHECK(stage.chosen == "spin");
  CHECK(stage.app.given("--speed"));
  CHECK_FALSE(stage.app.given("--device"));
}

TEST_CASE("only the first operand names a command") {
  Stage stage(true);
  std::string second;
  stage.app.positional("SECOND", second, "Another.");
  CHECK(stage.run({"part.stl", "move", "--quick"}) == 0);
  CHECK(stage.chosen.empty());
  CHECK(stage.input == "part.stl");
  CHECK(second == "move");
  CHECK(stage.quick);
}

TEST_CASE("an option behind -- is named in the error") {
  Tool tool;
  const std::string text = written_to(stderr, [&] { CHECK(tool.run({"--", "part.vdb", "--half"}) == 64); });
  CHECK(has(text, "--half: "));
}

TEST_CASE("options of a command may stand before or behind it") {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"spin", "--speed", "25", "--device", "move"},
                                             {"--speed", "25", "--device", "move", "spin"},
                                             {"--device=move", "spin", "--speed=25"}}) {
    for (const bool plain : {false, true}) {
      Stage stage(plain);
      CHECK(stage.run(words) == 0);
      CHECK(stage.chosen == "spin");
      CHECK(stage.speed == 25);
      CHECK(stage.device == "move");
    }
  }
}

TEST_CASE("the error for a wrong option of a command names the command it belongs to") {
  const auto said = [](const std::vector<std::string>& words, bool plain) {
    return written_to(stderr, [&] { CHECK(Stage(plain).run(words) == 64); });
  };
  CHECK(said({"--angle", "3", "spin"}, false) ==
        "vam-demo: --angle: not an option of vam-demo spin; it belongs to move\n");
  CHECK(said({"--quick", "spin"}, true) ==
        "vam-demo: --quick: not an option of vam-demo spin; it belongs to vam-demo without a command\n");
  CHECK(said({"spin", "--sped", "3"}, false) ==
        "vam-demo: --sped: unknown option; did you mean --speed? (vam-demo spin --help lists all)\n");
  CHECK(said({"spinn"}, false) == "vam-demo: spinn: unknown command; did you mean spin? (vam-demo --help lists all)\n");
  CHECK(said({"--device", "spin"}, false) == "vam-demo: no command; give one of spin, move\n");
  for (const auto& unknown : {std::vector<std::string>{"--foo", "3", "spin"}, {"--device", "x", "--foo=3", "spin"}}) {
    CHECK(said(unknown, false) == "vam-demo: --foo: unknown option (vam-demo --help lists all)\n");
  }
}

TEST_CASE("a tool with operands of its own runs without a command") {
  Stage stage(true);
  CHECK(stage.run({"part.vdb"}) == 0);
  CHECK(stage.chosen.empty());
  CHECK(stage.input == "part.vdb");
}

TEST_CASE("the manual prints options of several commands once, and the plain form where there is one") {
  Stage commands;
  Stage both(true);
  const std::string page = man_of(commands);
  CHECK(count_of(page, ".It Fl -device") == 1);
  CHECK(count_of(page, "Options described above: --device.") == 2);
  CHECK(has(page, "Default: stage.speed_deg_s."));
  CHECK_FALSE(has(page, "--pace"));
  CHECK(has(page, ".Sh SYNOPSIS\n.Nm\n.Cm spin\n"));
  CHECK(has(man_of(both), ".Sh SYNOPSIS\n.Nm\n.Op Ar OPTIONS\n.Op Ar \\&INPUT\n.Nm\n.Cm spin\n"));
}

TEST_CASE("an operand without a default, and any before it, is shown as required") {
  Stage stage;
  std::string print = "-", reference;
  stage.app.positional("PRINT", print, "Print.").positional("REFERENCE", reference, "Design.");
  CHECK(has(man_of(stage), ".Nm\n.Ar \\&PRINT\n.Ar \\&REFERENCE\n"));
}

TEST_CASE("the manual lists the variables and statuses of what the tool has") {
  Declaration tool{.manual = {"vam-demo", "shows"}};
  const std::string bare = printed_manual(tool);
  CHECK_FALSE(has(bare, "VAM_PRINTER"));
  CHECK_FALSE(has(bare, ".It 1\n"));
  CHECK_FALSE(has(bare, ".It 76\n"));
  CHECK_FALSE(has(bare, "VAM_LOCK_DIR"));
  tool.manual.locks = true;
  CHECK(has(printed_manual(tool), "VAM_LOCK_DIR"));
  tool.manual.locks = false;
  tool.manual.statuses = device_statuses;
  tool.groups = {
      {"Options", {{"--printer", "FILE", "Settings.", "", "", {}}, {"--require", "C", "Limits.", "", "", {}}}}};
  const std::string page = printed_manual(tool);
  CHECK(has(page, "VAM_PRINTER"));
  CHECK(has(page, "VAM_LOCK_DIR"));
  CHECK(has(page, ".It 1\n"));
  CHECK(has(page, ".It 76\nDevice protocol error.\n"));
}

TEST_CASE("an option that stands for an operand is a form of its own in the synopsis") {
  const auto printed = [](const std::string& word) {
    std::string part = "-", shape;
    bool live = false;
    App app(Manual{"vam-demo", "shows options"});
    app.positional("PART", part, "What to read.").reads({"--shape"});
    app.option("--shape", "NAME", shape, "Instead of PART.").form();
    app.flag("--live", live, "As it arrives.").form();
    return written_to(stdout, [&] { CHECK(run_app(app, {word}) == 0); });
  };
  CHECK(
      printed("--help").starts_with("Usage: vam-demo [OPTIONS] [PART]\n"
                                    "       vam-demo [OPTIONS] --shape NAME\n"
                                    "       vam-demo [OPTIONS] --live [PART]\n"));
  CHECK(has(printed("--man"),
            ".Sh SYNOPSIS\n.Nm\n.Op Ar OPTIONS\n.Op Ar \\&PART\n"
            ".Nm\n.Op Ar OPTIONS\n.Fl -shape Ar \\&NAME\n"
            ".Nm\n.Op Ar OPTIONS\n.Fl -live\n.Op Ar \\&PART\n.\\\""));
}

TEST_CASE("required options of a form are shown as such and refused where missing") {
  const auto said = [](const std::vector<std::string>& words, std::FILE* stream) {
    std::string frames, log;
    App app(Manual{"vam-demo", "shows options"});
    auto& scan = app.subcommand("scan", "one", [] {});
    scan.positional("FRAMES", frames, "Captured frames.");
    scan.option("--flips", "FILE", log, "Log.").required();
    app.subcommand("check", "another", [] {});
    return written_to(stream, [&] { run_app(app, words); });
  };
  CHECK(said({"scan", "a.exr", "--flips", "log"}, stderr).empty());
  CHECK(said({"check"}, stderr).empty());
  CHECK(said({"scan", "a.exr"}, stderr) == "vam-demo: --flips: missing; see --help\n");
  CHECK(said({"scan", "--flips", "log"}, stderr) == "vam-demo: FRAMES: missing; see --help\n");
  CHECK(said({"scan", "--help"}, stdout).starts_with("Usage: vam-demo scan [OPTIONS] --flips FILE FRAMES\n"));
  CHECK(has(said({"--help"}, stdout), "\nOptions of a command, e.g.: vam-demo scan --help\nCommon options: --memory"));
  CHECK(has(said({"--help=all"}, stdout), "\n  --memory GIB\n"));
}

TEST_CASE("an option that stands for others is a form of its own without them") {
  const auto said = [](const std::vector<std::string>& words, std::FILE* stream) {
    std::string chosen;
    double first = 0;
    bool side = false;
    App app(Manual{"vam-demo", "shows options"});
    auto& beam = app.subcommand("beam", "one", [] {});
    beam.flag("--side", side, "From the side.").form();
    beam.option("--first", "MM", first, any, "First plane.").required_without("--side");
    return written_to(stream, [&] { run_app(app, words); });
  };
  CHECK(said({"beam", "--side"}, stderr).empty());
  CHECK(said({"beam", "--first", "1"}, stderr).empty());
  CHECK(said({"beam"}, stderr) == "vam-demo: --first: missing, as is --side; see --help\n");
  const std::string help = said({"beam", "--help"}, stdout);
  CHECK(
      help.starts_with("Usage: vam-demo beam [OPTIONS] --first MM\n"
                       "       vam-demo beam [OPTIONS] --side\n"));
  CHECK(has(help, "First plane. Required without --side."));
  CHECK(has(said({"--man"}, stdout), ".Cm beam\n.Op Ar OPTIONS\n.Fl -side\n.\\\""));
}

TEST_CASE("a job is every option but those declared to be none of it, with the value in force") {
  Tool tool;
  std::string trace;
  std::optional<double> seconds;
  tool.app.option("--seconds", "S", seconds, positive, "Time.");
  tool.app.option("--trace", "FILE", trace, "Trace.").not_in_job();
  CHECK(tool.run({"part.vdb", "--voxel", "0.5", "--angles", "90", "--rotate", "1,2,3", "--half", "--set", "a=1",
                  "--trace", "x"}) == 0);
  CHECK(tool.app.job() == "--voxel=0.5\n--angles=90\n--rotate=1,2,3\n--set=a=1\n--window=hann\n--half=1\n--seconds=\n");
}

TEST_CASE("a page keeps its text, and has between its marks what the tool declares") {
  Declaration tool{.manual = {"vam-demo", "shows"}};
  tool.manual.page =
      ".\\\" <name>\nof before\n.\\\" </name>\n.Sh DESCRIPTION\nShows.\n.\\\" <kinds>\n.\\\" </kinds>\nMore.\n";
  tool.manual.lists = {{"kinds", {"One.", "Two."}}};
  CHECK(printed_manual(tool) ==
        ".\\\" <name>\n.Dt VAM-DEMO 1\n.Os\n.Sh NAME\n.Nm vam-demo\n.Nd shows\n.\\\" </name>\n.Sh DESCRIPTION\nShows.\n"
        ".\\\" <kinds>\nOne.\n.Pp\nTwo.\n.\\\" </kinds>\nMore.\n");
}

TEST_CASE("the manual page escapes the control characters of roff") {
  Declaration tool{.manual = {"vam-demo", "shows"}};
  tool.manual.lists = {{"kinds", {".starts with a dot and a \\ and 5 µm. Next sentence."}}};
  const std::string page = printed_manual(tool);
  CHECK(has(page, "\\&.starts"));
  CHECK(has(page, "\\e"));
  CHECK(has(page, "\\[u00B5]m.\nNext sentence."));
}
