#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "runtime/record/record_writer.hpp"
#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/outlets.hpp"
#include "runtime/stage/patch_table.hpp"
#include "schema/home_process.hpp"
#include "wale/stage.hpp"

namespace wale {

/// The error for a wrong argument: what it should be, and its value as a text.
Error malformed(std::string_view name, std::string_view sentence, std::string_view mend, std::string_view expected,
                std::string_view found);
Error wrong_moment(std::string_view name, std::string_view sentence, std::string_view mend);
Error stage_is_gone();
Error stage_was_moved();
Error another_run();
Error patch_is_gone();

/// What to do about a `RecordTo::hand` that is no line of text.
inline constexpr const char* record_hand_mend = "write what moves the handle in one line, as in \"simulated, lateral\"";

/// What a stage, its handles and its runs share. It lives as long as the stage or a run of it.
struct StageState : std::enable_shared_from_this<StageState> {
  StageState(std::unique_ptr<Device> own, Device* others, const DeviceProfile& of, StageOptions how);

  const HomeProcess home;
  std::unique_ptr<Device> owned;
  Device* device;  // null where the program serves the ticks itself
  DeviceProfile profile;
  bool has_profile = false;  // it was given, though there is no device
  StageOptions options;

  mutable std::mutex mutex;      // never taken by the thread that serves the ticks
  std::condition_variable news;  // for the thread that hands over changes, and who waits for a run's end
  std::condition_variable work;  // for the thread that prepares banks
  mutable BankCache banks;       // safe from any thread
  PatchTable table{banks};
  std::unique_ptr<RecordWriter> recorder;  // of the present run; called with the mutex held
  bool running = false;                    // a run is under way, or ends
  bool outlives_its_device = false;        // the program serves the ticks, without the stage's device
  bool over = false;                       // the stage is gone
  bool served = false;                     // some thread serves ticks
  std::thread::id caller;                  // of `run`, which calls `progress`
  bool caller_serves = false;              // it also serves the ticks: virtual time
  std::atomic<bool> told_to_stop = false;  // by `stop` or the destructor

  Outlets outlets;

  std::mutex starting;                       // of `start` and `stop`
  std::thread thread;                        // of `start`
  std::optional<Result<RunResult>> outcome;  // of `start`'s run; with `mutex`

  std::mutex polling;
  std::atomic<std::thread::id> poller;  // who polls now, so that a receiver may call `poll` and `on_contact`
  std::shared_ptr<const std::function<void(const ContactEvent&)>> receive;  // with `polling`

  mutable std::mutex asking;  // one copy of a memory at a time

  /// A change of one patch, or the reason against it.
  using Change = std::function<Result<>(WantedPatch&)>;
  Result<> change(PatchName name, const Change& change);
  /// All wishes at once.
  void want(std::vector<PatchTable::Wish> wishes);
  /// With the mutex held: whether the name is a patch's.
  Result<> has(PatchName name) const;
  /// A placement for a new patch.
  Result<WantedPatch> wanted(const Program& program, const PatchOptions& options) const;
  Result<> fits(const PatchProgram& program) const;

  Result<Bank> bank(PatchName name) const;
  Result<Placement> placement(PatchName name) const;
  Result<Placement> published(PatchName name) const;
  Result<Snapshot> snapshot(PatchName name);
  Now now() const noexcept;

  /// The stage of a handle.
  static const std::weak_ptr<StageState>& of(const Patch& patch) { return patch.stage_; }
  static PatchName name_of(const Patch& patch) { return {patch.number_, patch.generation_}; }
};

/// The index of a parameter. Errors: `unknown_name`, and those of a text that is no name.
Result<std::size_t> index_of(const Program& program, std::string_view parameter);

/// A stage that a call may use. Errors: `gone` for null; `wrong_moment` in a child of `fork`, whose parent has made it.
Result<std::shared_ptr<StageState>> here(std::shared_ptr<StageState> stage, Error (*gone)());

/// The changes that `Patch` and `StageEdit` make.
namespace changes {
StageState::Change set(std::string parameter, double value);
StageState::Change move(glm::vec2 to);
StageState::Change resize(PatchSize size);
StageState::Change enable(bool enabled);
/// `order` gives the order of an arrival in a layer; it is called with the stage's mutex held.
StageState::Change bring(float layer, PatchTable& orders);
StageState::Change replace(Program program, const StageState& stage);
}  // namespace changes

}  // namespace wale
