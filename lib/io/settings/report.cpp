// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/report.hpp"

#include "base/text/json.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

void write_report(const std::string& path, FormatKind schema, const Json& figures) {
  if (path.empty()) return;
  Json report{{"schema", schema.schema()}};
  report.update(figures);
  seal_json(report);
  OutputFile file(path, Content::text);
  file.write(report.dump(2) + "\n");
  file.commit();
}

}  // namespace vam::io
