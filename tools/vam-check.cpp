// SPDX-License-Identifier: GPL-3.0-or-later
// vam-check: are files what was written, and what were they made from?
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/log/progress.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "io/inspect/provenance.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/run_folder.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"

namespace {

using namespace vam;
using io::ProvenanceEntry;

struct Options {
  std::vector<std::string> files{"-"};
  bool fast = false;
  bool seal = false;
};

// The names of the files that are checked, by their seals.
using Names = std::map<std::string, std::string>;

std::string state_of(const ProvenanceEntry& finding) {
  if (!finding.damage.empty()) return ", damaged";
  if (!finding.sealed) return finding.checksums ? ", unsealed; its checksums hold" : ", unsealed";
  return ", sealed" + (finding.seal.empty() ? "" : " " + finding.seal);
}

std::string report(const std::string& path, const std::vector<ProvenanceEntry>& findings, const Names& names) {
  std::string text;
  for (const ProvenanceEntry& finding : findings) {
    text += printable(io::input_name(path)) + ": " + printable(finding.what) + state_of(finding) + "\n";
    for (const std::string& fact : finding.facts) text += "  " + printable(fact) + "\n";
    for (const auto& [command, seal] : chain_of(finding)) {
      const auto named = names.find(seal);
      text += "  " + (seal.empty() ? std::string(15, ' ') + "-" : seal) + "  " + printable(command) +
              (named == names.end() ? "" : "  (" + printable(named->second) + ")") + "\n";
    }
  }
  return text;
}

// Those of the files that are intact run folders.
std::vector<std::string> runs_of(const std::map<std::string, std::vector<ProvenanceEntry>>& found) {
  std::vector<std::string> runs;
  for (const auto& [path, findings] : found) {
    const auto events = std::filesystem::path(path) / "events.jsonl";
    if (findings.front().damage.empty() && std::filesystem::is_directory(path) && has_regular_file(events.string()))
      runs.push_back(path);
  }
  return runs;
}

void check(const Options& options) {
  std::map<std::string, std::vector<ProvenanceEntry>> found;
  Names names;
  std::vector<Error> damaged;
  const long count = std::ssize(options.files);
  Progress progress("checking", count);
  for (long done = 0; done < count; ++done) {
    progress.set_progress(done, count, {});
    const std::string& path = options.files[done];
    try {
      found[path] = io::inspect(path, options.fast);
    } catch (const Error& error) {  // the others are checked, too
      damaged.push_back(error);
      continue;
    }
    for (const ProvenanceEntry& finding : found[path]) {
      for (const std::string& damage : finding.damage) damaged.push_back({Fault::data, damage});
      if (!finding.seal.empty()) names.emplace(finding.seal, io::input_name(path));
    }
  }
  try {
    for (const std::string& problem : io::unmarked_resumptions(runs_of(found)))
      damaged.push_back({Fault::data, problem});
  } catch (const Error& error) {  // in logs that --fast has not read
    damaged.push_back(error);
  }
  std::string text;
  for (const std::string& path : options.files) {
    if (const auto findings = found.find(path); findings != found.end()) text += report(path, findings->second, names);
  }
  io::write_text("-", text);
  for (std::size_t i = 1; i < damaged.size(); ++i) warn(damaged[i].what());
  if (!damaged.empty()) throw damaged.front();
}

void seal(const std::string& path) {
  const std::string text = io::read_all(path);
  const std::string name = io::input_name(path);
  (void)io::parse_printer(text, name);
  if (io::require_text_seal(text, name)) {
    if (path == "-") io::write_text(path, text);  // as a filter in a pipe it copies what it need not change
    return;
  }
  if (text.empty()) throw Error{Fault::data, name + ": is empty; there is nothing to seal"};
  if (const std::string sign = io::sign_of_cut(text); !sign.empty()) throw Error{Fault::data, name + ": " + sign};
  io::write_text(path, io::sealed_text(text));
}

void run(const Options& options) {
  if (!options.seal) return check(options);
  for (const std::string& path : options.files) seal(path);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-check", "verify the integrity of files and show their provenance", manual_page});
  Options options;
  app.positional("FILE ...", options.files,
                 "Stacks, volumes, videos, records, reports, printer files, run and capture folders, or other files.")
      .reads();
  app.flag("--fast", options.fast, "Check the headers of stacks and volumes, not their values.");
  app.flag(
         "--seal", options.seal,
         "Seal printer files instead of checking them: append a line with the seal, against which the tools verify the "
         "file from then on; a file with a seal stays as it is. Standard input is copied to standard output with this "
         "line, unchanged if it has one.")
      .form()
      .excludes({"--fast"});
  return app.run(argc, argv, [&] { run(options); });
}
