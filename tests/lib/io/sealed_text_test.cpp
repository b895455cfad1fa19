// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/sealed_text.hpp"

#include "base/text/json.hpp"
#include "io/stream/seal.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

const std::string settings = "[vial]\n# sealed vials\nindex_glass = 1.47\nradius_mm = 11.5  # of part.vdb xxh3:\n";
const std::string hash = "xxh3:99aa06d3014798d86001c324468d497f";

bool is_sealed(const std::string& text) { return require_text_seal(text, "printer.toml"); }

}  // namespace

TEST_CASE("every damaged byte of a sealed text is noticed") {
  const std::string whole = sealed_text(settings);
  CHECK(is_sealed(whole));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char other : {static_cast<char>(whole[at] ^ 1), static_cast<char>(whole[at] ^ 4), '\n', '#', ' '}) {
      if (other == whole[at]) continue;
      std::string damaged = whole;
      damaged[at] = other;
      CAPTURE(damaged);
      CHECK(fault_of([&] { (void)is_sealed(damaged); }) == Fault::data);
    }
  }
}

TEST_CASE("a seal that is cut off, or after which text was added, is noticed") {
  const std::string whole = sealed_text(settings);
  for (std::size_t size = settings.size() + std::string("# sealed ").size(); size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK(fault_of([&] { (void)is_sealed(whole.substr(0, size)); }) == Fault::data);
  }
  CHECK(fault_of([&] { (void)is_sealed(whole + "[resin]\nindex = 1.5\n# and more\n"); }) == Fault::data);
}

TEST_CASE("comments that mention seals are none") {
  for (const std::string& text :
       {settings, settings + "# see xxh3: in the manual\n", "# from part.vdb, " + hash + "\n" + settings,
        "note = 'xxh3:'\n" + settings, std::string("xxh3:"), std::string("\n\n")}) {
    CAPTURE(text);
    CHECK_FALSE(is_sealed(text));
    CHECK(is_sealed(sealed_text(text + "\n")));
  }
}

TEST_CASE("the seal of a record is that of its keys and values, in any order and layout") {
  Json record{{"scan", "edges"},
              {"n", 3.0},
              {"values", {{"radius", {{"value", 12.5}, {"sigma", 1e-5}}}, {"axis", {1.0, 2.5}}}}};
  seal_json(record);
  CHECK(require_seal(record, "r.json"));
  const std::string seal = record["seal"].dump();
  const auto holds = [&](const std::string& text) { return require_seal(Json::parse(text), "r.json"); };
  const std::string sorted = R"({"n": 3, "scan": "edges", "seal": )" + seal +
                             R"(, "values": {"axis": [1, 2.50], "radius": {"sigma": 0.00001, "value": 12.5}}})";
  CHECK(holds(sorted));
  std::string other = sorted;
  other.replace(other.find("12.5"), 4, "12.6");
  CHECK(fault_of([&] { (void)holds(other); }) == Fault::data);
  other = sorted;
  other.replace(other.find("1, 2.50"), 7, "2.50, 1");
  CHECK(fault_of([&] { (void)holds(other); }) == Fault::data);
}
