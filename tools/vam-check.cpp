// SPDX-License-Identifier: GPL-3.0-or-later
// vam-check: are files what was written, and what were they made from?
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "io/inspect/provenance.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/resumption.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/log_lines.hpp"
#include "io/stream/stream.hpp"

namespace {

using namespace vam;
using io::ProvenanceEntry;

struct Options {
  std::vector<std::string> files{"-"};
  bool fast = false;
  bool seal = false;
};

cli::Manual manual() {
  return {
      "vam-check",
      "verify the integrity of files and show their provenance",
      {"vam-check reads each file and verifies it against its seals: hashes of values and attributes that these "
       "tools write into stacks, volumes, lossless videos, calibration records, reports and the printer file of a "
       "print (vam-formats(7), SEALS). If a file differs, the exit status is 65, "
       "after all others have been checked.",
       "Of the run folder of a print every file is verified against its SHA256SUMS; files that were changed, that "
       "are lost or that are not in the list are named, as are links (all but resumed.json, which a resumption adds, "
       "and "
       "sinogram.exr, a link that is verified against the hash in events.jsonl); flips.jsonl is verified against "
       "summary.json, too, also where it is given alone; before the print has ended, or if it was killed, its lines "
       "against the seals in events.jsonl, up to the last of which they are verified, as is said, its end and its "
       "light "
       "against angles.jsonl, what it began against what events.jsonl armed, and printer.toml against its own. A "
       "print that was resumed must have its resumed.json: by its events.jsonl if it was killed, and by that of "
       "the resumption if both folders are given. Of a folder of "
       "vam-capture every line of the manifest is verified against the one above, and every image "
       "against its line; images that are lost, exchanged or without a line are named; its manifest.jsonl stands for "
       "the folder.",
       "For each file vam-check prints whether it is sealed, and the commands that produced it: for each command "
       "the seal of the file that it wrote, the command line, and the name of that file if it is among those "
       "checked. A dash replaces the seal of a file that was not sealed or came through a pipe.",
       "All tools verify the seals of the files that they read; vam-check is for archives and for files received "
       "from others. Files of other programs have no seal, which is printed and is not an error; of their videos the "
       "checksums of container and slices are verified, where they have some. Seals reveal bit "
       "rot, truncation and edits; they are not signatures."},
      {{"Check a part and its sinogram:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb\n"
        "vam-sinogram part.vdb -o sino.exr\n"
        "vam-check part.vdb sino.exr"},
       {"Headers only, for large archives:",
        "vam-slice --shape gyroid --voxel 0.2 | vam-sinogram -o sino.exr\n"
        "vam-check --fast sino.exr"},
       {"Seal printer settings:",
        "vam-slice --print-printer -o printer.toml\n"
        "vam-check --seal printer.toml\n"
        "vam-check printer.toml"}},
      {"Memory: one image, or the topology of one volume. Speed: that of reading."},
      {"vam-print", "vam-view"}};
}

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
    if (findings.front().damage.empty() && std::filesystem::is_directory(path) && io::has_regular_file(events.string()))
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
    progress.stand(done, count, {});
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
  cli::App app(manual());
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
      .form();
  return app.run(argc, argv, [&] { run(options); });
}
