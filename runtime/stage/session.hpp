#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "runtime/stage/exchange.hpp"
#include "runtime/stage/player.hpp"
#include "runtime/stage/stage_state.hpp"

namespace wale {

/// The error of a run for which there was no memory.
Error run_without_memory();

/// One run of a stage, from its beginning to its end. The stage is taken for it as long as it exists.
class Session {
 public:
  enum class Clock { real, unreal, own };  ///< `unreal` is virtual time; `own`: the program serves the ticks itself

  /// Takes the stage, and begins its recording. Errors as for `Stage::run`.
  static Result<std::unique_ptr<Session>> begin(std::shared_ptr<StageState> stage, const RunOptions& options,
                                                Clock clock, bool may_be_empty, Device& device);
  ~Session();

  /// Serves all ticks, and gives the figures.
  Result<RunResult> play();

  /// For ticks that the program serves itself: hands over changes on a thread of its own. Error: `short_of_resources`.
  Result<> attend_apart();
  Player& player() { return *player_; }

 private:
  Session(std::shared_ptr<StageState> stage, const RunOptions& options, Clock clock, Device& device)
      : stage_(std::move(stage)), options_(options), clock_(clock), device_(device) {}

  Result<> begin_recording();
  Result<> start_preparing();
  void stop_threads() noexcept;
  /// The run has failed, so its last tick says nothing about a force any more. No thread serves ticks.
  void tell_no_force() noexcept;
  /// A thread of the run has no memory for its work: the run ends, and a `Loop` gives no force any more.
  void fail() noexcept;
  /// The thread that prepares banks.
  void prepare();
  /// Waits until all banks are ready, but not for long, and hands over what is ready.
  void hand_over_first();
  void serve_in_virtual_time();
  Result<> serve_in_real_time();
  /// Hands over changes until the ticks have ended.
  void attend();
  void publish();
  bool is_stopped() const noexcept;

  std::shared_ptr<StageState> stage_;
  RunOptions options_;
  Clock clock_;
  Device& device_;
  bool has_device_ = false;  // no other run uses it
  bool has_stage_ = false;   // no other run is under way on it
  bool has_begun_ = false;   // ticks may have been served
  bool has_ended_well_ = false;  // `play` gives the figures
  std::atomic<bool> has_failed_ = false;
  double most_ = HUGE_VAL;   // N, the largest force that the user allows, by the stage's options or the device's
  long ticks_ = 0, kept_ = 0;
  Exchange<PlacedPatches> patches_;
  RunResult result_;
  std::optional<Player> player_;
  bool finished_ = false;         // the last tick is served; with the stage's mutex
  bool prepared_enough_ = false;  // the thread that prepares is to end; with the stage's mutex
  std::thread preparing_, attending_;
};

}  // namespace wale
