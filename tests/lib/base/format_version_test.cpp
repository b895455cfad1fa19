// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/format_version.hpp"

#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "testing.hpp"

using namespace vam;

TEST_CASE("versions up to the tool's are read; a newer one is refused with both numbers, nonsense as such") {
  for (const FormatVersion& entry : format_versions) {
    const FormatKind kind(entry);
    CAPTURE(kind.schema());
    CHECK(find_format(entry.kind) == &entry);  // listed once
    for (int version = 1; version <= entry.version; ++version) CHECK(kind.objection(std::to_string(version)).empty());
    const std::string newer = std::to_string(entry.version + 1);
    CHECK(kind.objection(newer) == "is of version " + newer + " of its format (" + std::string(entry.kind) +
                                       "), and this tool reads up to version " + kind.version() +
                                       "; install newer VAM tools");
    for (const char* nonsense : {"abc", "-1", "1e9", "0", "", "1.5", " 1", "1 ", "99999999999"})
      CHECK(has(kind.objection(nonsense), "no whole number from 1 on"));
  }
}

TEST_CASE("JSON of a newer schema of these tools is refused wherever it is read; any other is read") {
  const auto read = [](const std::string& schema) { return parse_distinct(R"({"schema":)" + schema + "}", "x.json"); };
  CHECK(is_of(read(R"("vam-sdf/1")"), "vam-sdf"));
  CHECK(is_of(read(R"("vam-curethrough-sweep/1")"), "vam-curethrough-sweep"));  // of a former version
  CHECK_FALSE(is_of(read(R"("vam-sdf-trend/1")"), "vam-sdf"));
  for (const char* foreign : {R"("https://json-schema.org/2")", R"("vam-sdf")", R"("vam-paint/9")", "7", "null"})
    CHECK_FALSE(is_of(read(foreign), "vam-sdf-trend"));
  for (const char* bad :
       {R"("vam-sdf/2")", R"("vam-sdf/abc")", R"("vam-sdf/-1")", R"("vam-sdf/1e9")", R"("vam-sdf/")"}) {
    CHECK(fault_of([&] { (void)read(bad); }) == Fault::data);
    CHECK(message_of([&] { (void)read(bad); }).starts_with("x.json: "));
  }
}
