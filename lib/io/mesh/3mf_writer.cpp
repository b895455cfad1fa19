// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh as a 3MF package: one object, in millimetres.
#include <zip.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr const char* content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr const char* relations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

std::string model_xml(const model::TriangleSoup& mesh, const std::vector<std::string>& comments) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n";
  if (!comments.empty()) xml += " <metadata name=\"Description\">" + page_text(join(comments, "; ")) + "</metadata>\n";
  xml += " <resources>\n<object id=\"1\" type=\"model\"><mesh>\n<vertices>\n";
  for (const auto& [x, y, z] : mesh.points) {
    xml += "<vertex x=\"" + format_number(x, 9) + "\" y=\"" + format_number(y, 9) + "\" z=\"" + format_number(z, 9) +
           "\"/>\n";
  }
  xml += "</vertices>\n<triangles>\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    if (a == b || b == c || c == a) continue;
    xml += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" + std::to_string(c) +
           "\"/>\n";
  }
  return xml + "</triangles>\n</mesh></object>\n </resources>\n <build><item objectid=\"1\"/></build>\n</model>\n";
}

[[noreturn]] void failed(const std::string& why) {
  throw Error{Fault::memory, "3MF: the package cannot be put together (" + why + ")"};
}

/// The bytes of an archive of these files.
std::string package(std::initializer_list<std::pair<const char*, std::string_view>> files) {
  constexpr zip_uint16_t first_day = (1 << 5) | 1;  // of 1980: the same bytes at any time
  const std::unique_ptr<zip_source_t, decltype(&zip_source_free)> made(zip_source_buffer_create(nullptr, 0, 0, nullptr),
                                                                       zip_source_free);
  if (made == nullptr) failed("its memory");
  std::unique_ptr<zip_t, decltype(&zip_discard)> archive(zip_open_from_source(made.get(), ZIP_TRUNCATE, nullptr),
                                                         zip_discard);
  if (archive == nullptr) failed("its begin");
  zip_source_keep(made.get());  // the archive frees it, too
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive.get(), content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive.get(), name, source, ZIP_FL_ENC_UTF_8);
    if (index < 0) zip_source_free(source);
    if (index < 0) failed(zip_strerror(archive.get()));
    zip_file_set_dostime(archive.get(), static_cast<zip_uint64_t>(index), 0, first_day, 0);
  }
  if (zip_close(archive.get()) != 0) failed(zip_strerror(archive.get()));
  (void)archive.release();  // closing has freed it
  zip_stat_t about;
  if (zip_source_stat(made.get(), &about) != 0 || zip_source_open(made.get()) != 0) failed("its memory");
  std::string bytes(about.size, '\0');
  const zip_int64_t got = zip_source_read(made.get(), bytes.data(), bytes.size());
  zip_source_close(made.get());
  if (got != static_cast<zip_int64_t>(bytes.size())) failed("its end");
  return bytes;
}

}  // namespace

void write_3mf(const std::string& path, const model::TriangleSoup& mesh, const std::vector<std::string>& comments) {
  OutputFile file(path);
  const std::string model = model_xml(mesh, comments);
  file.write(
      package({{"[Content_Types].xml", content_types}, {"_rels/.rels", relations}, {"3D/3dmodel.model", model}}));
  file.commit();
}

}  // namespace vam::io
