#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/record/tick_sink.hpp"
#include "runtime/stage/acceleration_filter.hpp"
#include "runtime/stage/cost_meter.hpp"
#include "runtime/stage/exchange.hpp"
#include "runtime/stage/guards.hpp"
#include "runtime/stage/loop.hpp"
#include "runtime/stage/outlets.hpp"
#include "runtime/stage/placed_patches.hpp"
#include "runtime/stage/time_histogram.hpp"
#include "runtime/stage/velocity_filter.hpp"
#include "wale/memory.hpp"
#include "wale/run.hpp"

namespace wale {

/// One axis's estimates of velocity and acceleration, in counts and ticks.
class AxisFilters {
 public:
  explicit AxisFilters(const DeviceProfile& profile) : velocity_(profile), acceleration_(profile) {}

  struct Result {
    double velocity = 0, acceleration = 0;
    PlainDifferences::Result raw;
  };
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Result operator()(int counts, long periods) noexcept {
    return {velocity_(counts, periods), acceleration_(counts, periods), raw_(counts, periods)};
  }

 private:
  VelocityFilter velocity_;
  AccelerationFilter acceleration_;
  PlainDifferences raw_;
};

/// The real-time half of a stage: the work of one thread at each beat. Its end commands zero force.
class Player {
 public:
  /// `record` keeps the last `beats` beats, at least one, and `sink` receives each; a long one gets its room bit by bit, by
  /// `make_room`. `outlets` get its state, contacts
  /// and copies of memories. All outlive the player. `most_newton` is the largest force that the user allows; with
  /// `real_time`, the cost of each step is measured by the clock. Allocates.
  Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats,
         double most_newton = HUGE_VAL, bool real_time = false, TickSink* sink = nullptr, Outlets* outlets = nullptr);
  ~Player() { device_.command(Force(0)); }
  /// As `Guards::end_slewing_only_when_near`. Before the first tick.
  void end_slewing_only_when_near() noexcept { guards_.end_slewing_only_when_near(); }
  /// As `Guards::disregard_steps`. Before the first tick.
  void disregard_steps() noexcept { guards_.disregard_steps(); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Samples the device, filters its motion, takes the newest patches, finds the front-most under the hand, ticks its
  /// program (after entering it, if the hand was not on it before), guards, commands the force, records.
  /// Real-time: allocates nothing, takes no lock, makes no system call besides the device's own, does not throw.
  void serve(const Beat& beat) noexcept;

  /// Makes room for 20 000 more beats in the record, within a millisecond or so; false if it has all. From one thread
  /// besides that of the beats. If beats use up the room before, the record keeps the last ones that it has room for.
  bool make_room();

  /// The force that the actuator exerts since the last beat, where it is known only now. Real-time as `serve`.
  void exerted(Force force) noexcept;

  /// Call these after the last beat.
  Lateness lateness() const { return lateness_.summary(); }
  std::optional<TickCosts> costs() const { return costs_.summary(); }
  GuardCounts guards() const noexcept;
  long served() const { return static_cast<long>(served_); }
  /// Sorts the record by time, and cuts it to the beats served. Not while another thread makes room.
  void finish();

 private:
  /// The reading, with nothing that no device can mean; see `Device::sample`.
  Reading sound(Reading reading) noexcept;
  /// The hand at this beat, without its position on the patch.
  Hand hand(const Reading& reading, const Beat& beat) noexcept;
  /// Why there must be no force now, if there must be none.
  std::optional<Guards::Reason> reason_to_cut(const Reading& reading, const Beat& beat) const noexcept;
  /// The program's force, with the hand within the patch.
  Force feel(const PlacedPatch& patch, const Hand& hand) noexcept;
  /// The program's output and what the guards and the device made of it.
  struct Output {
    Force wanted{0};     ///< by the program
    Force commanded{0};  ///< after the guards
    Force exerted{0};    ///< by the actuator
  };
  /// Records the beat and publishes the progress. `before` has the guards' counts before this beat.
  void note(const Beat& beat, const Reading& reading, const Hand& hand, const Output& output,
            const GuardCounts& before) noexcept;
  /// Notes what began and ended to touch. `found` is under the hand now, `felt_` was at the last beat.
  void note_contacts(const PlacedPatch* found, const Reading& reading, const Hand& hand, Force force) noexcept;

  Device& device_;
  Exchange<PlacedPatches>& patches_;
  /// The place of the newest beat in the record. Real-time as `serve`.
  TickRecord& newest() noexcept { return ticks_[(served_ - 1) % ring_]; }

  Record& record_;
  TickRecord* ticks_ = nullptr;          // of the record
  std::size_t beats_, ring_;             // as many as it is to keep, and as it comes to keep
  std::atomic<std::size_t> room_ = 0;    // so many can be written
  TickSink* sink_;
  std::size_t served_ = 0;
  long missed_ = 0;
  double position_step_;  // m per count
  AxisFilters filters_x_, filters_y_;
  Guards guards_;
  /// What was under the hand at the last beat.
  struct FeltPatch {
    std::uint32_t number = RecordedTick::no_patch, generation = 0;
    std::uint64_t change = 0;
    glm::vec2 position{0};

    friend bool operator==(const FeltPatch&, const FeltPatch&) = default;
  };
  const Memory* inside_ = nullptr;  // the memory of that patch
  FeltPatch felt_;
  bool button_ = false;  // at the last beat
  glm::ivec2 counts_{0};  // at the last beat
  long restored_ = 0;
  TimeHistogram lateness_;
  CostMeter costs_;
  Outlets* outlets_;
  TickState state_;  // as last given to the outlets
};

}  // namespace wale
