#pragma once

#include "runtime/stage/exchange.hpp"
#include "runtime/stage/guards.hpp"
#include "runtime/stage/lateness.hpp"
#include "runtime/stage/latest.hpp"
#include "runtime/stage/loop.hpp"
#include "runtime/stage/velocity_filter.hpp"
#include "wale/stage.hpp"

namespace wale {

/// A patch at its parameters and its place on the workspace (m from its centre): what the control side hands over.
struct PlacedPatch {
  Bank bank;
  glm::vec2 position;
};

/// The real-time half of a stage: what one thread does at each beat. The device is without force once it is gone.
class Player {
 public:
  /// `record` gets a tick for each beat and has room for `beats`. All outlive the player. Allocates.
  Player(Device& device, Exchange<PlacedPatch>& patches, Record& record, std::size_t beats);
  ~Player() { device_.command(Force(0)); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Samples the device, filters velocity, takes the newest patch, ticks its program if the hand is within, guards,
  /// commands the force, records.
  /// Real-time: allocates nothing, takes no lock, makes no system call besides the device's own, does not throw.
  void serve(const Beat& beat) noexcept;

  /// From any thread.
  Progress progress() const { return latest_.load(); }

  /// After the last beat.
  Lateness lateness() const { return lateness_.summary(); }
  const GuardCounts& guards() const { return guards_.counts(); }
  /// Cuts the record to the beats served.
  void finish();

 private:
  Device& device_;
  Exchange<PlacedPatch>& patches_;
  Record& record_;
  std::size_t served_ = 0;
  long missed_ = 0;
  double position_step_;  // m per count
  VelocityFilter filter_x_, filter_y_;
  Guards guards_;
  bool inside_ = false;
  LatenessHistogram lateness_;
  Latest<Progress> latest_;
};

}  // namespace wale
