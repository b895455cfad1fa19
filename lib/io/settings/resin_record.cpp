// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/resin_record.hpp"

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

double gelation_isovalue(const std::string& path) {
  const Json record = sealed_record(path, {"vam-resin", "vam-working-curve"});
  const double isovalue = number_at(record, "isovalue");
  const double critical = number_at(record, "critical_dose_mj_cm3", 1);
  if (!(critical > 0)) {
    throw Error{Fault::data, path + ": critical_dose_mj_cm3 is " + format_number(critical) +
                                 "; it must be above 0; measure it again"};
  }
  if (!(isovalue > 0)) {
    throw Error{Fault::data, path + ": isovalue is " + format_number(isovalue) + "; it must be above 0"};
  }
  return isovalue;
}

Json sealed_record(const std::string& path, std::initializer_list<FormatKind> schemas) {
  Json record = parse_distinct(read_all(path, Content::text, most_record_bytes), path);
  std::vector<std::string> known;
  for (const FormatKind& schema : schemas) {
    if (is_of(record, schema)) return (void)require_seal(record, path), record;
    known.push_back(schema.schema());
  }
  const std::string stated = text_at(record, "schema");
  throw Error{Fault::data, path + ": not JSON of the schema " + join(known, " or ") +
                               (stated.empty() ? "" : ", but of " + briefly(stated))};
}

}  // namespace vam::io
