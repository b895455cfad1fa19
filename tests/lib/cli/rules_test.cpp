// SPDX-License-Identifier: GPL-3.0-or-later
// Options that need and exclude each other, and kinds of input.
#include "lib/cli/demo.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::cli;

namespace {

struct Ruled : Tool {
  std::string mesh, part = "-";
  std::string beam = "vial";
  bool points = false, both = false;
  Ruled() {
    app.choice("--beam", beam, {"vial", "parallel"}, "Beam.");
    app.option("--mesh", "FILE", mesh, "Mesh.").excludes({"--both", "--window cosine"});
    app.flag("--points", points, "Points.").only_with({"--mesh", "--beam parallel"}).not_for({"images"});
    app.flag("--both", both, "Both.").only_with({"--half"}).only_with({"--beam vial"});
    app.choice("--name", part, {"plain", "disc"}, "Kind.").only_with({"--beam parallel"}, "disc");
  }
  /// What the tool says to these words; nothing where it runs.
  std::string said(const std::vector<std::string>& words) {
    return written_to(stderr, [&] {
      const int status = run(words);
      CHECK((status == 0 || status == 64));
    });
  }
};

std::string said(const std::vector<std::string>& words) { return Ruled{}.said(words); }

}  // namespace

TEST_CASE("an option is refused without what it requires: an option, a value in force, each of several rules") {
  CHECK(said({"--points"}) == "vam-demo: --points: requires --mesh or --beam parallel; give it, or omit --points\n");
  CHECK(said({"--points", "--mesh", "a"}).empty());
  CHECK(said({"--points", "--beam", "parallel"}).empty());
  CHECK(said({"--both"}).starts_with("vam-demo: --both: requires --half;"));
  CHECK(said({"--both", "--half", "--beam", "parallel"}).starts_with("vam-demo: --both: requires --beam vial;"));
  CHECK(said({"--both", "--half"}).empty());
}

TEST_CASE("a group's rules are those of each of its options, but for options that they name") {
  bool live = false, page = false, beside = false;
  const auto judged = [&](const std::vector<std::string>& words, const std::string& kind) {
    Tool tool;
    tool.app.group("Live", {"--live"}, {"images"}).flag("--live", live, "Live.").flag("--page", page, "Page.");
    tool.app.not_for({"meshes"}).group("Other").flag("--beside", beside, "Beside.");
    const auto run = [&] { return tool.app.require_for(kind, "x"); };
    return written_to(stderr, [&] { (void)run_app(tool.app, words, run); });
  };
  CHECK(judged({"--page"}, "stacks").starts_with("vam-demo: --page: requires --live;"));
  CHECK(judged({"--live", "--page", "--beside"}, "stacks").empty());
  CHECK(has(judged({"--live"}, "images"), "--live: does not apply to images"));
  CHECK(has(judged({"--page", "--live"}, "meshes"), "--page: does not apply to meshes"));
  CHECK(judged({"--beside"}, "images").empty());
}

TEST_CASE("an option is refused beside what it excludes, in either order") {
  CHECK(said({"--mesh", "a", "--both", "--half"}) == "vam-demo: --mesh: conflicts with --both; omit one of them\n");
  CHECK(said({"--both", "--half", "--mesh", "a"}) == "vam-demo: --mesh: conflicts with --both; omit one of them\n");
  CHECK(has(said({"--window", "cosine", "--mesh", "a"}), "--window cosine; omit one"));
  CHECK(said({"--window", "hann", "--mesh", "a"}).empty());
}

TEST_CASE("a rule of one value leaves the others alone") {
  CHECK(said({"--name", "plain"}).empty());
  CHECK(said({"--name", "disc"}).starts_with("vam-demo: --name disc: requires --beam parallel; give it, or omit "));
  CHECK(said({"--name", "disc", "--beam", "parallel"}).empty());
}

TEST_CASE("an operand and the option that stands for it exclude each other") {
  std::string part = "-", shape;
  App app(Manual{"vam-demo", "shows options"});
  app.positional("PART", part, "What to read.").reads({"--shape"});
  app.option("--shape", "NAME", shape, "Instead of PART.").form();
  const std::string text = written_to(stderr, [&] { CHECK(run_app(app, {"a.stl", "--shape", "cube"}) == 64); });
  CHECK(text == "vam-demo: PART: conflicts with --shape; omit one of them\n");
}

TEST_CASE("an option is refused for the kind of input that it has no effect on") {
  for (const bool points : {false, true}) {
    Ruled tool;
    CHECK(tool.said(points ? std::vector<std::string>{"--points", "--mesh", "a"} : std::vector<std::string>{}).empty());
    CHECK_NOTHROW(tool.app.require_for("meshes", "a.stl"));
    if (!points) CHECK_NOTHROW(tool.app.require_for("images", "a/"));
    if (points)
      CHECK_THROWS_WITH(tool.app.require_for("images", "a/"), "--points: does not apply to images (a/); omit it");
  }
}

TEST_CASE("a rule on settings of the printer waits until they are known") {
  for (const bool set : {false, true}) {
    Tool tool;
    bool points = false;
    tool.app.flag("--points", points, "Points.").only_with({"resin.psf_mm", "resin.diffusion_mm2_s"});
    CHECK(tool.run({"--points"}) == 0);
    const auto is_set = [&](const std::string& name) { return set && name == "resin.psf_mm"; };
    if (set) CHECK_NOTHROW(tool.app.require_settings(is_set));
    if (!set)
      CHECK_THROWS_WITH(tool.app.require_settings(is_set),
                        "--points: requires resin.psf_mm or resin.diffusion_mm2_s; give it, or omit --points");
  }
}

TEST_CASE("a rule that names what is not declared is a bug that every run finds") {
  for (const char* condition : {"--wall", "--window hamming"}) {
    Tool tool;
    bool points = false;
    tool.app.flag("--points", points, "Points.").excludes({condition});
    const std::string text = written_to(stderr, [&] { CHECK(tool.run({}) == 70); });
    CHECK(has(text, condition));
  }
}

TEST_CASE("help and manual state the rules") {
  Ruled tool;
  const std::string help = written_to(stdout, [&] { CHECK(tool.run({"--help"}) == 0); });
  for (const char* sentence : {"Requires --mesh or --beam parallel.", "Not for images.", "Not with --both or --window",
                               "disc: requires --beam parallel."}) {
    CHECK(has(help, sentence));
  }
}
