// SPDX-License-Identifier: GPL-3.0-or-later
// A tool to test lib/cli with.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "cli/app.hpp"

namespace vam::cli {

inline int run_app(
    App& app, std::vector<std::string> words, const std::function<void()>& body = [] {}) {
  words.insert(words.begin(), "vam-demo");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  return app.run(static_cast<int>(argv.size()), argv.data(), body);
}

struct Tool {
  double voxel_mm = 0.065;
  int angles = 360;
  std::string input = "-";
  std::string window = "hann";
  std::vector<double> rotate{0, 0, 0};
  std::vector<std::string> sets;
  bool half = false;
  App app{Manual{"vam-demo", "shows options"}};
  Tool() {
    app.positional("INPUT", input, "What to read.");
    app.option("--voxel", "MM", voxel_mm, positive, "Voxel edge.");
    app.option("--angles", "N", angles, Range{1, 10000}, "Stage angles.");
    app.option("--rotate", "X,Y,Z", rotate, 3, "Angles in degrees.");
    app.option("--set", "K=V", sets, "Override.");
    app.choice("--window", window, {"hann", "cosine"}, "Window.");
    app.flag("--half", half, "Half.");
  }
  int run(const std::vector<std::string>& words) { return run_app(app, words); }
};

/// What is written to the stream while the work runs.
inline std::string written_to(std::FILE* stream, const std::function<void()>& work) {
  std::fflush(stream);
  std::FILE* file = std::tmpfile();
  const int saved = dup(fileno(stream));
  dup2(fileno(file), fileno(stream));
  work();
  std::fflush(stream);
  dup2(saved, fileno(stream));
  close(saved);
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  CHECK(std::fread(text.data(), 1, text.size(), file) == text.size());
  std::fclose(file);
  return text;
}

}  // namespace vam::cli
