// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "cli/private/command_line.hpp"
#include "lib/cli/demo.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::cli;

namespace {

std::string warned(const std::vector<std::string>& words) {
  Tool tool;
  return written_to(stderr, [&] { CHECK(tool.run(words) == 0); });
}

std::string refused(const std::vector<std::string>& words) {
  Tool tool;
  return written_to(stderr, [&] { CHECK(tool.run(words) == 64); });
}

}  // namespace

TEST_CASE("options of every tool are taken out of the words, wherever they stand") {
  std::vector<std::string> words{"-v", "part.stl", "--progress=json", "--memory", "2", "--half", "--", "--quiet"};
  const CommonOptions all = take_common_options(words);
  CHECK(words == std::vector<std::string>{"part.stl", "--half", "--", "--quiet"});
  CHECK(all.memory_gib == "2");
  CHECK(all.log.verbose);
  CHECK_FALSE(all.log.quiet);
  CHECK(all.log.progress == ProgressStyle::json);
  std::vector<std::string> none{"part.stl"};
  CHECK(take_common_options(none).log.progress == ProgressStyle::line);
}

TEST_CASE("and are not part of the history") {
  Tool tool;
  CHECK(tool.run({"--quiet", "part.vdb", "--progress", "none"}) == 0);
  CHECK(tool.app.history() == std::string("vam-demo ") + VAM_VERSION + " part.vdb");
}

TEST_CASE("what is wrong with them is a usage error") {
  CHECK(refused({"--progress", "jason"}) ==
        "vam-demo: --progress: 'jason' is not one of line, json, none; did you mean json?\n");
  CHECK(refused({"--progress"}) == "vam-demo: --progress: needs a value\n");
  CHECK(refused({"--memory", "1", "--memory=2"}) == "vam-demo: --memory: given twice\n");
  CHECK(refused({"--memory", "much"}).starts_with("vam-demo: --memory: 'much' is not a number"));
  CHECK(refused({"--memory", "0"}).starts_with("vam-demo: --memory: 0 is out of range"));
  CHECK(refused({"--quiet=yes"}) == "vam-demo: --quiet: takes no value\n");
  CHECK(refused({"--half=1"}) == "vam-demo: --half: takes no value\n");
  CHECK(refused({"-q", "--quiet"}) == "vam-demo: --quiet: given twice\n");
  CHECK(refused({"-q", "-v"}) == "vam-demo: --quiet: contradicts --verbose\n");
  CHECK(refused({"--help=most"}) == "vam-demo: --help: 'most' is not one of all\n");
}

TEST_CASE("quiet leaves out warnings, not errors") {
  const auto said = [](std::vector<std::string> words) {
    words.insert(words.begin(), "vam-demo");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    Tool tool;
    return written_to(stderr, [&] {
      CHECK(tool.app.run(static_cast<int>(argv.size()), argv.data(), [] { warn("part.vdb: is dark"); }) == 0);
    });
  };
  CHECK(said({"part.vdb"}) == "vam-demo: warning: part.vdb: is dark\n");
  CHECK(said({"part.vdb", "--quiet"}).empty());
  CHECK(refused({"--voxel", "0", "-q"}).starts_with("vam-demo: --voxel: 0 is out of range"));
}

TEST_CASE("verbose states time and memory") {
  const std::string text = warned({"part.vdb", "--verbose"});
  CHECK(text.starts_with("vam-demo: "));
  CHECK(text.ends_with(" GiB of memory\n"));
}

TEST_CASE("--help shows the usual options, --help=all all") {
  const auto help = [](bool usual, const std::string& word) {
    Tool tool;
    if (usual) tool.app.usual({"--voxel", "--half"});
    return written_to(stdout, [&] { CHECK(tool.run({word}) == 0); });
  };
  const std::string some = help(true, "--help");
  CHECK(has(some, "\n  --voxel MM            "));
  CHECK_FALSE(has(some, "--angles"));
  CHECK(has(some, "\n4 more options, and all of each: vam-demo --help=all\n"));
  CHECK(has(some, "--quiet"));
  CHECK_FALSE(has(some, "json: one object a\n"));  // the first sentence of each
  CHECK(has(help(true, "--help=all"), "json: one object a\n"));
  CHECK(help(true, "--help=all") == help(false, "--help"));
}

TEST_CASE("progress as JSON: a line when the work ends, with its figures") {
  set_talk({.progress = ProgressStyle::json});
  const std::string text = written_to(stderr, [] {
    Progress progress("optimising", 8);
    progress.set_progress(3, 9, {{"iteration", 3}, {"VER", 0.25}});
  });
  CHECK(has(text, R"("task":"optimising","done":3,"total":9,)"));
  CHECK(has(text, R"("left_s":0.0,"finished":true,"iteration":3.0,"ver":0.25})"));
  const std::string failed = written_to(stderr, [] {
    try {
      const Progress progress("slicing", 8);
      throw 1;
    } catch (int) {
    }
  });
  CHECK(failed.empty());
  set_talk({.quiet = true, .progress = ProgressStyle::json});
  CHECK(written_to(stderr, [] { Progress("slicing", 8).tick(8); }).empty());
  set_talk({});
}

TEST_CASE("times left") {
  CHECK(clock_text(4.6) == "0:05");
  CHECK(clock_text(760) == "12:40");
  CHECK(clock_text(3760) == "1:02:40");
}
