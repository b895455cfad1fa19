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
  write_text(path, report.dump(2) + "\n");
}

}  // namespace vam::io
