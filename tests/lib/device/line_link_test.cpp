// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/private/line_link.hpp"

#include <memory>

#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

/// A port that nobody writes to or reads from.
class NamedPort final : public Port {
 public:
  void write(std::string_view) override {}
  std::string read(double) override { return {}; }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string name_ = "port";
};

}  // namespace

TEST_CASE("an answer that is not text is reported escaped, with a remedy") {
  const LineLink link(std::make_unique<NamedPort>());
  const std::string noise("\x0b\0\xff", 3);
  CHECK(std::string(link.malformed("get pos", noise).what()) ==
        "port: 'get pos' was answered '\\x0b\\x00\\xff', not a reply of this controller; check the device and its baud "
        "rate");
  CHECK(
      has(std::string(link.malformed("$$", std::string(100, 'a')).what()), std::string(64, 'a') + "...' (100 bytes)"));
}
