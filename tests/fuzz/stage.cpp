// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of a stage's controller, FUZZ_STAGE, to all that may be asked and ordered.
#include "device/os/clock.hpp"
#include "device/stage/stage_backends.hpp"
#include "fuzz/answers.hpp"
#include "fuzz/drive.hpp"

namespace {

using namespace vam;
using namespace vam::device;

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
      [&] { fuzz::drive(*FUZZ_STAGE(std::make_unique<fuzz::Answers>(fuzz::text_of(bytes, size), clock), clock)); });
}
