// vam-check: are files what was written, and what were they made from?
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "io/inspect/provenance.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/input_name.hpp"
#include "io/stream/stream.hpp"

namespace {

using namespace vam;
using io::Finding;

struct Options {
  std::vector<std::string> files{"-"};
  bool fast = false;
  bool seal = false;
};

cli::Manual manual() {
  return {
      "vam-check",
      "verify the integrity of files and show their provenance",
      {"vam-check reads each file and verifies it against its seals: hashes of values and attributes that these tools "
       "write into "
       "stacks, volumes, calibration records, reports and the printer file of a print (vam-formats(7), SEALS), and the "
       "checksums of lossless videos. A file that differs ends it with status 65, after the others have been read.",
       "For each file it prints whether it is sealed, and the chain of commands that led to it: the seal of the file "
       "that each command wrote, the command, and, where that file is among those that are checked, its name. A dash "
       "stands for a file that was not sealed or came through a pipe.",
       "The tools themselves verify every file that they read against its seals; this check is for archives, and for "
       "files that others pass on. A file of another program has no seal; that is printed and no error. Seals find "
       "bit rot, cuts and edits; they are not signatures."},
      {{"A part and its sinogram:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb && vam-sinogram part.vdb -o sino.exr && vam-check part.vdb "
        "sino.exr"},
       {"Headers alone, for large archives:", "vam-check --fast sino.exr"},
       {"Sealed printer settings:",
        "vam-slice --print-printer -o printer.toml && vam-check --seal printer.toml && vam-check printer.toml"}},
      {"Memory: one image, or the topology of one volume. Speed: that of reading."},
      {"vam-print", "vam-view"}};
}

// The names of the files that are checked, by their seals.
using Names = std::map<std::string, std::string>;

std::string report(const std::string& path, const std::vector<Finding>& findings, const Names& names) {
  std::string text;
  for (const Finding& finding : findings) {
    text += printable(io::input_name(path)) + ": " + printable(finding.what) +
            (finding.sealed ? ", sealed" : ", unsealed") + (finding.seal.empty() ? "" : " " + finding.seal) + "\n";
    for (const auto& [command, seal] : chain_of(finding)) {
      const auto named = names.find(seal);
      text += "  " + (seal.empty() ? std::string(15, ' ') + "-" : seal) + "  " + printable(command) +
              (named == names.end() ? "" : "  (" + printable(named->second) + ")") + "\n";
    }
  }
  return text;
}

void check(const Options& options) {
  std::map<std::string, std::vector<Finding>> found;
  Names names;
  std::vector<Error> damaged;
  for (const std::string& path : options.files) {
    try {
      found[path] = io::inspect(path, options.fast);
    } catch (const Error& error) {  // the others are checked, too
      damaged.push_back(error);
      continue;
    }
    for (const Finding& finding : found[path]) {
      if (!finding.seal.empty()) names.emplace(finding.seal, io::input_name(path));
    }
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
  (void)io::parse_printer(text, path);
  if (io::require_text_seal(text, path)) return;
  if (text.empty() || text.back() != '\n') {
    throw Error{Fault::data, path + ": ends within a line; complete it before it is sealed"};
  }
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
  app.positional("FILE ...", options.files, "Stacks, volumes, videos, records, reports, printer files, or any others.")
      .reads();
  app.flag("--fast", options.fast, "Check the headers of stacks and volumes, not their values.");
  app.flag("--seal", options.seal,
           "Seal printer files instead: a seal line is appended, against which the tools verify the file from then on.")
      .form();
  return app.run(argc, argv, [&] { run(options); });
}
