// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/save.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/image/image_file.hpp"
#include "io/stream/stream.hpp"
#include "plot/private/cairo_library.hpp"

namespace vam::plot {

namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

/// The chunk that says how many pixels a metre has (PNG specification, 11.3.5.3), behind the header.
std::string with_density(std::string png, double dpi) {
  constexpr std::size_t header = 8 + 25;  // signature, IHDR
  constexpr double m_per_inch = 0.0254;
  const std::string density = big_endian(static_cast<std::uint32_t>(std::lround(dpi / m_per_inch)));
  const std::string chunk = "pHYs" + density + density + '\1';  // per metre
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()));
  return png.insert(header, big_endian(9) + chunk + big_endian(static_cast<std::uint32_t>(sum)));
}

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
  write_binary(path, with_density(io::encode_png(figure.image(dpi), text), dpi));
}

}  // namespace vam::plot
