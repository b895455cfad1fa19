// SPDX-License-Identifier: GPL-3.0-or-later
// vam-stack: joins pieces of a stack of images, and cuts pieces out.
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack_pieces.hpp"
#include "io/stream/input_name.hpp"
#include "manual_page.hpp"
#include "slices.hpp"

namespace {

using namespace vam;

struct Options {
  std::vector<std::string> inputs{"-"};
  std::string slices;
  std::string output = "-";
  io::StackOptions stack;
};

model::ImageRange chosen(const Options& options, const io::StackPieces& in, const std::string& name) {
  const model::ImageRange& there = in.images();
  const std::string held =
      (options.inputs.size() == 1 ? name + ": holds" : "the pieces: hold") + " images " + model::range_text(there);
  const std::string all = std::to_string(in.info().count);
  if (options.slices.empty()) {
    if (there.count() == in.info().count) return there;
    throw Error{Fault::data, held + " of " + all + "; name the other pieces, too, or choose some of these by --slices"};
  }
  const model::ImageRange range = tool::slices_among(options.slices, in.info().count, name);
  if (range.from >= there.from && range.to <= there.to) return range;
  throw Error{Fault::data, held + " of " + all + ", not all of --slices " + options.slices};
}

void run(const Options& options) {
  const std::string name = io::input_name(options.inputs.front());
  if (!options.slices.empty()) (void)tool::slices_named(options.slices);  // before files are opened
  io::StackPieces in(options.inputs);
  const model::ImageRange range = chosen(options, in, name);
  io::StackWriter out(options.output, io::cut(in.info(), range, name), options.stack);
  in.copy(range, out);
  out.commit();
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-stack", "join pieces of a stack of images, or cut a piece out", manual_page});
  Options options;
  app.positional("STACK ...", options.inputs, "A stack, or pieces of one (EXR).").reads();
  cli::add_output(app, options.output).writes_as({".exr"});
  app.option(
      "--slices", "SLICES", options.slices,
      "Write these images of the undivided stack, counted from 0: FROM to TO - 1 as FROM:TO, or the I-th of N similar "
      "shares as I/N.");
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  cli::add_threads(app);
  return app.run(argc, argv, [&] { run(options); });
}
