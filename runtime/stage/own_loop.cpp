#include <algorithm>

#include "runtime/record/format.hpp"
#include "runtime/stage/session.hpp"
#include "schema/home_process.hpp"
#include "wale/loop.hpp"

namespace wale {
namespace {

/// More count as so many, which a recording can hold.
constexpr long most_periods_missed = 0x7fffffff;

}  // namespace

struct Loop::Parts {
  /// A device whose readings the program gives, and whose commands it takes.
  class HandedDevice final : public Device {
   public:
    explicit HandedDevice(const DeviceProfile& profile) : profile_(profile) {}

    const DeviceProfile& profile() const noexcept override { return profile_; }
    void elapse(long) noexcept override {}
    Reading sample() noexcept override { return reading; }
    Force command(Force force) noexcept override { return commanded = force; }

    Reading reading;
    Force commanded{0};

   private:
    DeviceProfile profile_;
  };

  explicit Parts(const DeviceProfile& profile) : device(profile) {}

  HandedDevice device;
  std::shared_ptr<StageState> stage;
  std::unique_ptr<Session> session;  // ends before the device
  long period = -1;
};

Loop::Loop(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Loop::Loop(Loop&&) noexcept = default;
Loop& Loop::operator=(Loop&& other) noexcept {
  Loop ended(std::move(other));
  std::swap(parts_, ended.parts_);
  return *this;
}
Loop::~Loop() {
  if (parts_ && !parts_->stage->home.is_here()) abandon(std::move(parts_));
}

Result<Loop> Loop::begin(Stage& stage) {
  const auto there = here(stage.state_, stage_was_moved);
  if (!there) return there.error();
  const std::shared_ptr<StageState>& state = *there;
  if (state->device == nullptr && !state->has_profile)
    return wrong_moment("stage", "the stage has no device", "make it with a device, or with the profile of one");
  auto parts = std::make_unique<Parts>(state->profile);
  auto session = Session::begin(state, {.seconds = HUGE_VAL, .kept_seconds = 1 / state->profile.rate},
                                Session::Clock::own, true, parts->device);
  if (!session) return std::move(session).error();
  parts->session = *std::move(session);
  parts->stage = state;
  if (auto attended = parts->session->attend_apart(); !attended) return std::move(attended).error();
  return Loop(std::move(parts));
}

Force Loop::step(const Reading& reading, long periods) noexcept {
  if (!parts_ || !parts_->stage->home.is_here()) return Force(0);
  Parts& parts = *parts_;
  const bool first = parts.period < 0;
  const long elapsed = first ? 0 : std::clamp(periods, 1L, most_periods_missed);
  // Time stays where it is after a million years, and what is missed still counts.
  parts.period = std::min<long>(parts.period + (first ? 1 : elapsed), recording_format::most_periods);
  parts.device.reading = reading;
  if (parts.stage->told_to_stop.load(std::memory_order_relaxed)) parts.device.reading.contact = Contact::stale;
  parts.session->player().serve(
      {.period = parts.period, .elapsed = elapsed, .skipped = std::max(0L, elapsed - 1), .lateness = 0});
  return parts.device.commanded;
}

void Loop::exerted(Force force) noexcept {
  if (parts_ && parts_->stage->home.is_here()) parts_->session->player().exerted(force);
}

}  // namespace wale
