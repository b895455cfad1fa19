#include "cli/app.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <functional>

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
    app.choice("--window", window, {"hann", "cosine"}, "Window.").was("--taper");
    app.flag("--half", half, "Half.");
  }
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "vam-demo");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    return app.run(static_cast<int>(argv.size()), argv.data(), [] {});
  }
};

// What is written to stderr while the work runs.
std::string stderr_of(const std::function<void()>& work) {
  std::FILE* file = std::tmpfile();
  const int saved = dup(STDERR_FILENO);
  dup2(fileno(file), STDERR_FILENO);
  work();
  dup2(saved, STDERR_FILENO);
  close(saved);
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  CHECK(std::fread(text.data(), 1, text.size(), file) == text.size());
  std::fclose(file);
  return text;
}

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

TEST_CASE("a former spelling works as the option does, with one warning") {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--taper", "cosine"}, {"--taper=cosine"}}) {
    Tool tool;
    int status = -1;
    CHECK(stderr_of([&] { status = tool.run(words); }) == "vam-demo: --taper is now --window\n");
    CHECK(status == 0);
    CHECK(tool.window == "cosine");
    CHECK(tool.app.given("--window"));
    CHECK(tool.app.history().find("--taper") == std::string::npos);
  }
  Tool tool;
  CHECK(tool.run({"--taper", "hann", "--window", "hann"}) == 64);
}

TEST_CASE("a former spelling is not shown") {
  Tool tool;
  const std::string text = stderr_of([&] { CHECK(tool.run({"--windov", "hann"}) == 64); });
  CHECK(text.find("--window") != std::string::npos);
  CHECK(text.find("--taper") == std::string::npos);
}

TEST_CASE("a former spelling of a subcommand's option is known after its name") {
  App app(Manual{"vam-demo", "shows commands", {}, {}, {}, {}});
  std::string chosen;
  double speed = 1;
  double level = 0;
  app.option("--level", "N", level, any, "Level.");
  app.subcommand("spin", "turn on", chosen).option("--speed", "DEG_S", speed, positive, "Speed.").was("--level");
  std::vector<std::string> words{"vam-demo", "--level", "3", "spin", "--level", "25"};
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  CHECK(stderr_of([&] { CHECK(app.run(6, argv.data(), [] {}) == 0); }) == "vam-demo: --level is now --speed\n");
  CHECK(speed == 25);
  CHECK(level == 3);
}

TEST_CASE("the manual page escapes what roff would take for its own") {
  Declaration tool;
  tool.manual = {"vam-demo", "shows", {".starts with a dot and a \\ and 5 µm. Next sentence."}, {}, {}, {}};
  const std::string page = manual_page(tool);
  CHECK(page.find("\\&.starts") != std::string::npos);
  CHECK(page.find("\\e") != std::string::npos);
  CHECK(page.find("\\[u00B5]m.\nNext sentence.") != std::string::npos);
}
