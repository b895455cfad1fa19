// SPDX-License-Identifier: GPL-3.0-or-later
// vam-convert: data of other programs, and from these tools to others; pieces of stacks.
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "session/printer.hpp"
#include "vam-convert/conversions.hpp"
#include "vam-convert/options.hpp"

namespace {

using namespace vam;
using convert_tool::Options;

/// Native file -> array, array -> volume, array or images -> projections.
void run(const cli::App& app, const Options& options) {
  if (session::print_printer(options.printer, options.output)) return;
  const auto type = io::known_file_type(options.input);
  if (type == io::FileType::volume || type == io::FileType::stack) {
    const bool volume = type == io::FileType::volume;
    app.require_for(volume ? "VDB volumes" : "EXR stacks", io::input_name(options.input));
    check_export(options);
    return volume ? convert_tool::export_volume(options) : convert_tool::export_stack(options);
  }
  if (options.input != "-") io::require_content(options.input);  // a socket cannot be looked at
  app.require_for(type ? "images" : "arrays", io::input_name(options.input));
  if (!type && io::is_lone_array(options.input))
    app.require_for("arrays alone in a file", io::input_name(options.input));
  check_import(options);
  if (options.voxel_mm) return convert_tool::make_volume(app, options, type, session::load_printer(options.printer));
  convert_tool::make_projections(app, options, type);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-convert", "exchange files with other programs; cut and join stacks", manual_page});
  Options options;
  declare(app, options);
  convert_tool::add_pieces(app);
  return app.run(argc, argv, [&] { run(app, options); });
}
