#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/record/tick_sink.hpp"
#include "runtime/stage/acceleration_filter.hpp"
#include "runtime/stage/cost_meter.hpp"
#include "runtime/stage/exchange.hpp"
#include "runtime/stage/front_most.hpp"
#include "runtime/stage/guards.hpp"
#include "runtime/stage/latest.hpp"
#include "runtime/stage/loop.hpp"
#include "runtime/stage/time_histogram.hpp"
#include "runtime/stage/velocity_filter.hpp"
#include "wale/memory.hpp"
#include "wale/stage.hpp"

namespace wale {

/// A patch with its parameters and its position (m from the workspace's centre), as the control side hands it over. The
/// memory belongs to the bank's program, and patches that differ only in parameters share it. Only the thread that
/// plays the patch uses the memory; the control side frees it.
struct PlacedPatch {
  Bank bank;
  glm::vec2 position;
  std::shared_ptr<Memory> memory;
  float layer = 0;
  std::uint32_t number = 0;           ///< on the stage
  double potential_range = HUGE_VAL;  ///< J, of the bank's force; infinite: its energy is not limited
};

/// The position of a patch that has been moved.
struct MovedPatch {
  std::size_t number = 0;
  glm::vec2 position{0};  ///< m from the workspace's centre
};

/// All patches on the workspace, as the control side hands them over. Successive values share the patches that did not
/// change. Only the real-time thread uses the patches; the control side frees them. Patches that have been moved are
/// searched separately from those that stay, so the cost of a move does not grow with the number of the others.
class PlacedPatches {
 public:
  using Patches = std::vector<std::shared_ptr<PlacedPatch>>;

  /// No patch.
  PlacedPatches();
  /// One patch alone.
  explicit PlacedPatches(PlacedPatch patch);

  std::uint32_t revision = 0;  ///< the number of this hand-over in the run, from 1 on

  const Patches& patches() const noexcept { return *patches_; }

  /// Replaces the patches; their index is their number. Call `arrange` before the next `at` when a patch is new or has
  /// another size: until then `at` searches the previous outlines.
  void take(Patches patches) { patches_ = std::make_shared<const Patches>(std::move(patches)); }
  /// Prepares the search for all patches, in time proportional to their number. `moving` has the moved patches in the
  /// order of their numbers.
  void arrange(std::span<const MovedPatch> moving);
  /// Prepares the search for the moved patches only. They are the same patches as at the last `arrange`.
  void move(std::span<const MovedPatch> moving);

  /// The front-most patch under a point (m from the workspace's centre) and where it is, or null.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  struct Found {
    PlacedPatch* patch = nullptr;
    glm::vec2 position{0};

    friend bool operator==(const Found&, const Found&) = default;
  };
  Found at(glm::dvec2 point) const noexcept;

 private:
  std::shared_ptr<const Patches> patches_;
  std::shared_ptr<const FrontMost> staying_;  // by their indices in `patches_`
  std::vector<MovedPatch> moved_;
  std::shared_ptr<const FrontMost> moving_;  // by their indices in `moved_`; null where there are none
};

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
  /// `record` keeps the last `beats` beats, at least one, and `sink` receives each. All outlive the player.
  /// `most_newton` is the largest force that the user allows; with `real_time`, the cost of each step is measured by
  /// the clock. Allocates.
  Player(Device& device, Exchange<PlacedPatches>& patches, Record& record, std::size_t beats,
         double most_newton = HUGE_VAL, bool real_time = false, TickSink* sink = nullptr);
  ~Player() { device_.command(Force(0)); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Samples the device, filters its motion, takes the newest patches, finds the front-most under the hand, ticks its
  /// program (after entering it, if the hand was not on it before), guards, commands the force, records.
  /// Real-time: allocates nothing, takes no lock, makes no system call besides the device's own, does not throw.
  void serve(const Beat& beat) noexcept;

  /// From any thread.
  Progress progress() const { return latest_.load(); }

  /// Call these after the last beat.
  Lateness lateness() const { return lateness_.summary(); }
  std::optional<TickCosts> costs() const { return costs_.summary(); }
  GuardCounts guards() const noexcept;
  long served() const { return static_cast<long>(served_); }
  /// Sorts the record by time, and cuts it to the beats served.
  void finish();

 private:
  /// The hand at this beat, without its position on the patch.
  Hand hand(const Reading& reading, const Beat& beat) noexcept;
  /// Why there must be no force now, if there must be none.
  std::optional<Guards::Reason> reason_to_cut(const Reading& reading, const Beat& beat) const noexcept;
  /// The program's force, with the hand within the patch.
  Force feel(PlacedPatch& patch, const Hand& hand) noexcept;
  /// The program's output and what the guards and the device made of it.
  struct Output {
    Force wanted{0};     ///< by the program
    Force commanded{0};  ///< after the guards
    Force exerted{0};    ///< by the actuator
  };
  /// Records the beat and publishes the progress. `before` has the guards' counts before this beat.
  void note(const Beat& beat, const Reading& reading, const Hand& hand, const Output& output,
            const GuardCounts& before) noexcept;

  Device& device_;
  Exchange<PlacedPatches>& patches_;
  Record& record_;
  TickSink* sink_;
  std::size_t served_ = 0;
  long missed_ = 0;
  double position_step_;  // m per count
  AxisFilters filters_x_, filters_y_;
  Guards guards_;
  const Memory* inside_ = nullptr;  // the memory of the patch under the hand at the last beat
  PlacedPatches::Found felt_;       // that patch and its position
  long restored_ = 0;
  TimeHistogram lateness_;
  CostMeter costs_;
  Latest<Progress> latest_;
};

}  // namespace wale
