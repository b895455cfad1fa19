// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/common.hpp"
#include "io/exr/stack_pieces.hpp"
#include "io/stream/stream.hpp"
#include "vam-convert/conversions.hpp"

namespace vam::convert_tool {

namespace {

struct PieceOptions {
  std::vector<std::string> inputs{"-"};
  std::string slices;  // to cut; empty: all are joined
  std::string output = "-";
  io::StackOptions stack;
};

model::ImageRange chosen(const PieceOptions& options, const io::StackPieces& in, const std::string& name) {
  const model::ImageRange& there = in.images();
  const std::string held =
      (options.inputs.size() == 1 ? name + ": holds" : "the pieces: hold") + " images " + model::range_text(there);
  if (options.slices.empty()) {
    if (there.count() == in.info().count) return there;
    throw Error{Fault::data,
                held + " of " + std::to_string(in.info().count) + "; name the other pieces, too, or cut some of these"};
  }
  const model::ImageRange range = model::slices_among(options.slices, in.info().count, name);
  if (range.from >= there.from && range.to <= there.to) return range;
  throw Error{Fault::data, held + " of " + std::to_string(in.info().count) + ", not all of --slices " + options.slices};
}

void copy_pieces(const PieceOptions& options) {
  const std::string name = io::input_name(options.inputs.front());
  if (!options.slices.empty()) (void)model::slices_named(options.slices);  // before files are opened
  io::StackPieces in(options.inputs);
  const model::ImageRange range = chosen(options, in, name);
  io::StackWriter out(options.output, io::cut(in.info(), range, name), options.stack);
  in.copy(range, out);
  out.commit();
}

}  // namespace

void add_pieces(cli::App& app) {
  const auto options = std::make_shared<PieceOptions>();
  const auto copy = [options] { copy_pieces(*options); };
  auto& cut = app.subcommand("cut", "copy some images of a stack as a piece", copy);
  auto& join = app.subcommand("join", "join all pieces of a stack", copy);
  cut.option("--slices", "SLICES", options->slices,
             "Images of the undivided stack, counted from 0: FROM to TO - 1 as FROM:TO, or the I-th of N similar "
             "shares as I/N.")
      .required();
  for (cli::App* form : {&cut, &join}) {
    form->positional("STACK ...", options->inputs, "A stack, or pieces of one (EXR).").reads();
    cli::add_output(*form, options->output).writes_as({".exr"});
    cli::add_stack_output(*form, options->stack.half, options->stack.compression);
    cli::add_threads(*form);
  }
}

}  // namespace vam::convert_tool
