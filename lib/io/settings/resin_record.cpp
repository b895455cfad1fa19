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
  double isovalue = 0;
  double critical = 1;
  try {
    const Json record = parse_distinct(read_all(path, Content::text, most_record_bytes), path);
    if (record.is_discarded()) throw Error{Fault::data, path + ": not a record of vam-calibrate resin, nor other JSON"};
    if (!is_of(record, "vam-resin") && !is_of(record, "vam-working-curve"))
      throw Error{Fault::data,
                  path + ": not a record of vam-calibrate resin, its schema is " + briefly(record.at("schema").dump())};
    require_seal(record, path);
    isovalue = record.at("isovalue").get<double>();
    critical = number_at(record, "critical_dose_mj_cm3", critical);
  } catch (const Json::exception&) {
    throw Error{Fault::data, path + ": not a record of vam-calibrate resin, which has schema and isovalue"};
  }
  if (!(critical > 0)) {
    throw Error{Fault::data, path + ": critical_dose_mj_cm3 is " + format_number(critical) +
                                 "; it must be above 0; measure it again"};
  }
  if (!(isovalue > 0)) {
    throw Error{Fault::data, path + ": isovalue is " + format_number(isovalue) + "; it must be above 0"};
  }
  return isovalue;
}

Json sealed_record(const std::string& path, FormatKind schema) {
  Json record = parse_distinct(read_all(path, Content::text, most_record_bytes), path);
  if (!is_of(record, schema)) {
    throw Error{Fault::data, path + ": not JSON of the schema " + schema.schema()};
  }
  require_seal(record, path);
  return record;
}

}  // namespace vam::io
