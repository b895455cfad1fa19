#include "cli/app.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "cli/declaration.hpp"

using namespace vam;
using namespace vam::cli;

namespace {

struct Tool {
  double voxel_mm = 0.065;
  int angles = 360;
  std::string input = "-";
  std::string window = "hann";
  std::vector<double> rotate{0, 0, 0};
  std::vector<std::string> sets;
  bool half = false;
  App app{Manual{"vam-demo", "shows options", {"First. Second."}, {{"Do it.", "vam-demo --half"}}, {}, {"vam-slice"}}};
  Tool() {
    app.positional("INPUT", input, "What to read.");
    app.option("--voxel", "MM", voxel_mm, positive, "Voxel edge.");
    app.option("--angles", "N", angles, Range{1, 10000}, "Stage angles.");
    app.option("--rotate", "X,Y,Z", rotate, 3, "Angles in degrees.");
    app.option("--set", "K=V", sets, "Override.");
    app.choice("--window", window, {"hann", "cosine"}, "Window.");
    app.flag("--half", half, "Half.");
  }
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "vam-demo");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    return app.run(static_cast<int>(argv.size()), argv.data(), [] {});
  }
};

}  // namespace

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

TEST_CASE("subcommands have options of their own") {
  App app(Manual{"vam-demo", "shows commands", {}, {}, {}, {}});
  std::string chosen;
  double speed = 1;
  double angle = 0;
  app.subcommand("spin", "turn on", chosen).option("--speed", "DEG_S", speed, positive, "Speed.");
  app.subcommand("move", "go there", chosen).option("--angle", "DEG", angle, any, "Angle.");
  std::vector<std::string> words{"vam-demo", "spin", "--speed", "25"};
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  CHECK(app.run(4, argv.data(), [] {}) == 0);
  CHECK(chosen == "spin");
  CHECK(speed == 25);
}

TEST_CASE("the manual page escapes what roff would take for its own") {
  Declaration tool;
  tool.manual = {"vam-demo", "shows", {".starts with a dot and a \\ and 5 µm. Next sentence."}, {}, {}, {}};
  const std::string page = manual_page(tool);
  CHECK(page.find("\\&.starts") != std::string::npos);
  CHECK(page.find("\\e") != std::string::npos);
  CHECK(page.find("\\[u00B5]m.\nNext sentence.") != std::string::npos);
}
