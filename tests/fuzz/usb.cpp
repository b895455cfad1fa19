// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of a device on USB: a Tic, and a DLPC350 or DLPC900 by the first byte.
#include "device/os/clock.hpp"
#include "device/port/usb_link.hpp"
#include "device/projector/light_engine.hpp"
#include "device/stage/stage_backends.hpp"
#include "fuzz/drive.hpp"

namespace {

using namespace vam;
using namespace vam::device;

// Says what it was told to say, then nothing in time.
class Answers final : public UsbLink {
 public:
  Answers(std::string bytes, std::string usb_id) : bytes_(std::move(bytes)), usb_id_(std::move(usb_id)) {}
  void control_out(int, int, int) override {}
  std::string control_in(int, int, int, int length) override { return take(static_cast<std::size_t>(length)); }
  void write_report(const std::string&) override {}
  std::string read_report() override { return take(64); }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] Json about() const override { return {{"usb_id", usb_id_}, {"serial", "1"}}; }

 private:
  std::string take(std::size_t size) {
    if (at_ >= bytes_.size()) throw Error{Fault::busy, name_ + ": no answer"};
    std::string part = bytes_.substr(at_, size);
    at_ += part.size();
    part.resize(size);
    return part;
  }
  std::string bytes_;
  std::size_t at_ = 0;
  std::string usb_id_;
  std::string name_ = "usb";
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  VirtualClock clock;
  const std::string answers = fuzz::text_of(bytes, size);
  fuzz::attempt(
      [&] { fuzz::drive(*make_tic_stage(std::make_unique<Answers>(answers, "1ffb:00b3"), clock, 8.8889, nullptr)); });
  const std::string usb_id = size > 0 && bytes[0] % 2 == 1 ? "0451:c900" : "0451:6401";
  return fuzz::attempt([&] {
    const auto light = make_dlp_light(std::make_unique<Answers>(answers, usb_id), {}, clock, nullptr);
    fuzz::attempt([&] { (void)light->identify().dump(); });
    fuzz::attempt([&] { light->prepare(); });
    fuzz::attempt([&] { light->on(); });
    fuzz::attempt([&] { light->dark(); });
  });
}
