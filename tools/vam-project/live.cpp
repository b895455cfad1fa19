// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/live.hpp"

#include <cstddef>
#include <numeric>

#include "device/open/open.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/process.hpp"

namespace vam::project {

Live::Live(const LiveOptions& options, const std::string& output, const device::DisplayMode& wanted)
    : options_(options), log_(options.log), clock_(device::real_clock()) {
  if (options.with_parent) device::end_with_parent();
  relay_ = device::open_relay(options.relay, &guardian_);
  if (relay_ != nullptr) log_("relay", relay_->identify());
  if (!options.light.empty()) light_ = device::open_light(options.light, options.max_led_current_percent, &guardian_);
  display_ = device::open_display(output, wanted, clock_, &guardian_);
  const auto mode = display_->mode();
  log_("display", {{"device", output}, {"columns", mode.columns}, {"rows", mode.rows}, {"hz", mode.hz}});
  if (light_ == nullptr) return;
  light_->prepare();  // after the display: a DLPC900 looks for its image
  log_("light", light_->identify());
}

void Live::add(const GreyImage& levels) {
  device::check_interrupted();
  display_->add(levels);
  ++frames_;
}

void Live::offer(Offer frames) {
  auto offer = std::make_unique<Offer>(std::move(frames));
  {
    const std::lock_guard lock(offering_);
    offer_.swap(offer);
  }
  note_unused(offer.get(), "others took their place");
}

void Live::note_unused(const Offer* offer, const std::string& why) {
  if (offer == nullptr || offer->taken) return;
  log_("frames-refused",
       {{"message", "the frames of " + offer->facts.value("sinogram", "") + " were not shown: " + why}});
}

// The screen does not wait for a thread that just offers others: these come a turn later.
int Live::take_offer(int turn) {
  const std::unique_lock lock(offering_, std::try_to_lock);
  if (!lock.owns_lock() || offer_ == nullptr || offer_->taken) return 0;
  if (offer_->from_turn > turn) return 0;
  offer_->taken = true;
  if (offer_->from_turn > 0 && offer_->from_turn < turn) {
    log_("frames-refused",
         {{"message", "the frames of turn " + std::to_string(offer_->from_turn) + " came too late"}, {"turn", turn}});
    return 0;
  }
  display_->exchange(offer_->frames);
  Json facts{{"turn", turn}};
  facts.update(offer_->facts);
  log_("frames", facts);
  return offer_->turns;
}

// From here on each flip is a heartbeat. The log's threads begin before the print hurries.
void Live::begin() {
  log_.write_aside();
  keeper_.emplace(std::vector{options_.log});
  device::hurry(device::Urgency::driver);
  if (relay_ != nullptr) relay_->close();
}

device::Lamp* Live::lamp() {
  if (relay_ == nullptr) return light_.get();
  return &relayed_.emplace(light_.get(), *relay_);
}

device::PlayTally Live::play(int frames_per_turn, double speed_deg_s, int turns) {
  const auto angles = options_.follow.empty() ? device::elapsed_angle(speed_deg_s, clock_)
                                              : device::followed_angle(options_.follow, clock_, 360.0 * turns);
  begin();
  device::PlayPlan plan;
  plan.frames_per_turn = frames_per_turn;
  plan.frames = frames_;
  plan.turns = turns;
  plan.from_deg = options_.from_deg;
  plan.latency_s = 1e-3 * options_.latency_ms.value_or(0);
  plan.allowed_missed = options_.allowed_missed;
  plan.allowed_missed_lit = options_.allowed_missed_lit;
  plan.next_turn = [this](int turn) { return take_offer(turn); };
  return ended(device::play(*display_, lamp(), *angles, clock_, plan, logger()));
}

device::PlayTally Live::play_through(double hold_s, bool forever, std::vector<int> order) {
  if (order.empty()) {
    order.resize(static_cast<std::size_t>(frames_));
    std::iota(order.begin(), order.end(), 0);
  }
  begin();
  return ended(device::play_through(*display_, lamp(), clock_, order, hold_s, forever, logger()));
}

device::PlayTally Live::ended(const device::PlayTally& tally) {
  if (relay_ != nullptr) relay_->open();
  std::unique_ptr<Offer> last;
  {
    const std::lock_guard lock(offering_);
    offer_.swap(last);
  }
  note_unused(last.get(), "the print ended before");
  log_("end", {{"flips", tally.flips}, {"lit", tally.lit}, {"missed", tally.missed}});
  log_.sync();
  return tally;
}

std::function<void(const device::FlipRecord&)> Live::logger() {
  return [this](const device::FlipRecord& record) {
    guardian_.beat();
    if (relay_ != nullptr) relay_->beat();
    log_.at(record.flip.time_s, "flip", device::to_json(record));
  };
}

}  // namespace vam::project
