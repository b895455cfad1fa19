// The answers of a stage's controller, FUZZ_STAGE, to all that may be asked and ordered.
#include "device/os/clock.hpp"
#include "device/stage/gcs_stage.hpp"
#include "device/stage/grbl_stage.hpp"
#include "device/stage/zaber_stage.hpp"
#include "fuzz/drive.hpp"

namespace {

using namespace vam;
using namespace vam::device;

// Says what it was told to say, a line or a few bytes at a time, whatever it is asked. When there is nothing left, the
// time-out passes.
class Answers final : public Port {
 public:
  Answers(std::string bytes, VirtualClock& clock) : bytes_(std::move(bytes)), clock_(clock) {}
  void write(std::string_view) override {}
  std::string read(double timeout_s) override {
    if (at_ >= bytes_.size()) {
      clock_.sleep_until(clock_.now_s() + timeout_s);
      return "";
    }
    clock_.sleep_until(clock_.now_s() + 0.001);
    const std::size_t end = bytes_.find('\n', at_);
    const std::size_t size = end == std::string::npos ? 1 : end + 1 - at_;
    const std::string part = bytes_.substr(at_, size);
    at_ += size;
    return part;
  }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
  VirtualClock& clock_;
  std::string name_ = "port";
};

[[maybe_unused]] std::unique_ptr<Stage> gcs(std::unique_ptr<Port> port, Clock& clock) {
  return make_gcs_stage(std::move(port), clock, {}, "1", nullptr);
}
[[maybe_unused]] std::unique_ptr<Stage> grbl(std::unique_ptr<Port> port, Clock& clock) {
  return make_grbl_stage(std::move(port), clock, 0, nullptr);
}
[[maybe_unused]] std::unique_ptr<Stage> zaber(std::unique_ptr<Port> port, Clock& clock) {
  return make_zaber_stage(std::move(port), clock, {}, nullptr);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  VirtualClock clock;
  return fuzz::attempt(
      [&] { fuzz::drive(*FUZZ_STAGE(std::make_unique<Answers>(fuzz::text_of(bytes, size), clock), clock)); });
}
