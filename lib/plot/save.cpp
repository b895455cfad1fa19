// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/save.hpp"

#include <algorithm>

#include "io/image/image_file.hpp"
#include "io/stream/stream.hpp"
#include "plot/private/cairo_library.hpp"

namespace vam::plot {

namespace {

/// Not to a terminal.
void write_binary(const std::string& path, const std::string& bytes) {
  io::OutputFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace

const std::vector<std::string>& figure_endings() {
  static const std::vector<std::string> endings{".png", ".pdf", ".svg"};
  return endings;
}

bool is_figure(const std::string& path) {
  return std::any_of(figure_endings().begin(), figure_endings().end(),
                     [&](const std::string& ending) { return path.ends_with(ending); });
}

void require_figures() { (void)cairo_api(); }

void save(const std::string& path, const Canvas& figure, const std::string& history, double dpi) {
  if (path.ends_with(".pdf")) return write_binary(path, figure.pdf(history));
  if (path.ends_with(".svg")) return io::write_text(path, figure.svg(history));
  const io::ImageText text = history.empty() ? io::ImageText{} : io::ImageText{{"Comment", history}};
  write_binary(path, io::encode_png(figure.image(dpi), text, dpi));
}

}  // namespace vam::plot
