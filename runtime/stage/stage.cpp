#include "wale/stage.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "runtime/record/record_writer.hpp"
#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/placement.hpp"
#include "runtime/stage/player.hpp"
#include "runtime/stage/recorded_run.hpp"
#include "runtime/stage/scheduling.hpp"

namespace wale {
namespace {

constexpr long longest_run = 1L << 24;
constexpr double endless = 0x1p53;  // ticks: the greatest number that a double counts exactly
constexpr double progress_seconds = 0.1;

/// Six digits: enough for a person.
std::string digits(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr};
}

std::string shown(const Parameter& parameter, float value) {
  const std::string number = digits(value / parameter.unit_in_si);
  return parameter.unit.empty() ? number : number + " " + parameter.unit;
}

/// Whether the profile has all that a loop needs.
Result<> complete(const DeviceProfile& profile) {
  struct Figure {
    const char* name;
    double value;
    bool needed;
  };
  const bool place = profile.has_position(), push = !profile.shaker;
  const std::array<Figure, 6> figures{{{"rate", profile.rate, true},
                                       {"workspace", profile.workspace_diameter, place},
                                       {"position counts", profile.position_counts, place},
                                       {"force", profile.force_newton, push},
                                       {"force counts", profile.force_counts, push},
                                       {"acceleration", profile.most(), !push}}};
  for (const auto& [name, value, needed] : figures) {
    if (needed && (!(value > 0) || !std::isfinite(value))) {
      return Error{.code = Code::unusable_device,
                   .sentence = "the device " + profile.name + " declares no positive " + name,
                   .mend = {},
                   .place = {.name = name, .text = digits(value)}};
    }
  }
  return {};
}

/// Checks that the program and the device both push or both vibrate. Error: `other_device`.
Result<> fits(const PatchProgram& program, const DeviceProfile& device) {
  if (program.vibrates() == device.shaker.has_value()) return {};
  return Error{.code = Code::other_device,
               .sentence = program.material + " was built for " + program.device.name +
                           (program.vibrates() ? ", which vibrates, and " : ", which pushes, and ") + device.name +
                           (program.vibrates() ? " pushes" : " only vibrates"),
               .mend = "build it for " + device.name};
}

/// The error for a wrong argument.
Error malformed(std::string name, std::string sentence) {
  return {.code = Code::malformed_value, .sentence = std::move(sentence), .place = {.name = std::move(name)}};
}

Error wrong_moment(std::string sentence) { return {.code = Code::wrong_moment, .sentence = std::move(sentence)}; }

struct RunLength {
  long ticks = 0;  ///< of the run, at least one
  long kept = 0;   ///< of its record, at least one
};

Result<RunLength> length_of(const RunOptions& options, double rate) {
  const auto asked = [](double seconds) { return "; asked for " + digits(seconds) + " s"; };
  if (!(options.seconds > 0))
    return malformed("seconds", "the length of a run must be positive" + asked(options.seconds));
  if (!(options.kept_seconds > 0))
    return malformed("kept_seconds", "the length of a run's record must be positive" + asked(options.kept_seconds));
  const double kept = std::min(options.seconds, options.kept_seconds);
  if (kept * rate > static_cast<double>(longest_run)) {
    const bool endless_run = kept < options.seconds;
    return malformed(endless_run ? "kept_seconds" : "seconds", "a run " + std::string(endless_run ? "keeps" : "lasts") +
                                                                   " at most " +
                                                                   digits(static_cast<double>(longest_run) / rate) +
                                                                   " s at " + digits(rate) + " Hz" + asked(kept));
  }
  return RunLength{std::max(1L, std::lround(std::min(options.seconds * rate, endless))),
                   std::max(1L, std::lround(kept * rate))};
}

bool is_set(const std::atomic<bool>* flag) noexcept { return flag != nullptr && flag->load(std::memory_order_relaxed); }

}  // namespace

struct Stage::Parts {
  Device& device;
  std::mutex mutex;  // never taken by the real-time thread while it ticks
  std::condition_variable news;
  std::vector<Placement> placements;
  std::vector<std::size_t> changed;   // placements, since they were last published
  std::vector<std::size_t> replaced;  // placements whose memories may have predecessors
  std::vector<std::size_t> movers;    // placements that have been moved, in rising order
  bool cleared = false;               // all placements are new since they were last published
  bool rearranged = false;            // since then a size may have changed, or a patch moved for the first time
  bool moved = false;                 // since then one of the movers has been moved
  bool finished = false;              // the real-time thread's last tick is done
  bool running = false;
  BankCache banks;
  PlacedPatches published;                 // belongs to the thread that publishes
  std::uint32_t revision = 0;              // how often the present run has handed over patches
  std::unique_ptr<RecordWriter> recorder;  // of the present run; called with the mutex held

  explicit Parts(Device& stages) : device(stages) {}

  std::optional<Placement> copy_placement(std::size_t patch) {
    const std::lock_guard lock(mutex);
    if (patch >= placements.size()) return std::nullopt;
    return placements[patch];
  }

  /// With the mutex held.
  Result<> has(std::size_t patch) const {
    if (patch < placements.size()) return {};
    if (placements.empty()) return malformed("patch", "nothing is placed on the stage");
    return malformed("patch", "patch " + std::to_string(patch) + " is not among the " +
                                  std::to_string(placements.size()) + " on the stage");
  }

  /// With the mutex held.
  void note_change(std::size_t patch) {
    changed.push_back(patch);
    news.notify_all();
  }

  /// With the mutex held.
  bool has_news() const { return !changed.empty() || moved; }

  /// With the mutex held: makes all patches stay where they are until one is moved.
  void begin_anew() {
    cleared = true;
    changed.clear();
    movers.clear();
    replaced.clear();
    moved = false;
    for (Placement& placement : placements) placement.moves = false;
  }

  /// Builds the patches that changed, and hands over all patches.
  void publish_change(Exchange<PlacedPatches>& patches) {
    std::unique_lock lock(mutex);
    if (!has_news()) return;
    if (std::exchange(cleared, false)) published = PlacedPatches();
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    std::vector<std::pair<std::size_t, Placement>> copies;
    for (const std::size_t patch : changed) copies.emplace_back(patch, placements[patch]);
    changed.clear();
    ++revision;
    if (recorder) recorder->publish(revision);
    for (const std::size_t patch : replaced) placements[patch].memory->forget_predecessor();
    const std::size_t count = placements.size();
    const bool arrange = std::exchange(rearranged, false) || published.patches().size() != count;
    const bool move = std::exchange(moved, false);
    std::vector<MovedPatch> moving;
    if (arrange || move)
      for (const std::size_t patch : movers) moving.push_back({patch, placements[patch].position});
    lock.unlock();  // building may take long, and the next `set` should not wait for it
    if (!copies.empty()) {
      PlacedPatches::Patches all = published.patches();
      all.resize(count);
      for (const auto& [patch, copy] : copies) {
        const auto prepared = banks.get({copy.program, copy.parameters, copy.size});
        prepared->sample();
        all[patch] = std::make_shared<PlacedPatch>(PlacedPatch{prepared->bank, copy.position, copy.memory, copy.layer,
                                                               static_cast<std::uint32_t>(patch),
                                                               prepared->potential_range(true)});
      }
      published.take(std::move(all));
    }
    if (arrange)
      published.arrange(moving);
    else if (move)
      published.move(moving);
    published.revision = revision;
    patches.publish(published);
  }

  /// With the mutex held: begins a recording, with the patches on the stage.
  Result<> begin_recording(const RunOptions& options);
  /// Why the recording ended before the run; empty if it did not.
  std::optional<Error> end_recording();
  TickSink* sink() { return recorder.get(); }

  /// Takes the stage for a run, and begins its recording.
  Result<> begin_run(const RunOptions& options);
  void end_run();
  /// Serves the ticks of a run, by the clock that the options ask for.
  Result<> play(Player& player, Exchange<PlacedPatches>& patches, long ticks, const RunOptions& options,
                RunResult& result);
  void play_recorded(Player& player, Exchange<PlacedPatches>& patches, RecordedRun& recorded, RunResult& result);
  void play_in_virtual_time(Player& player, Exchange<PlacedPatches>& patches, long ticks, const RunOptions& options,
                            RunResult& result);
  Result<> play_in_real_time(Player& player, Exchange<PlacedPatches>& patches, long ticks, const RunOptions& options,
                             RunResult& result);
  void attend(const Player& player, Exchange<PlacedPatches>& patches, const RunOptions& options);
};

Result<> Stage::Parts::begin_recording(const RunOptions& options) {
  if (!options.record_to) return {};
  const RecordingHeader header{.device = device.profile(),
                               .most_newton = options.most_newton,
                               .virtual_time = options.virtual_time,
                               .hand = options.record_to->hand};
  auto begun = RecordWriter::begin(options.record_to->file, header, options.virtual_time);
  if (!begun) return std::move(begun).error();
  recorder = *std::move(begun);
  for (const Placement& placement : placements)
    recorder->add(placement.program, placement.position, placement.size, placement.layer, placement.parameters);
  return {};
}

std::optional<Error> Stage::Parts::end_recording() {
  const std::lock_guard lock(mutex);
  if (!recorder) return std::nullopt;
  recorder->end();
  return recorder->ended_early();
}

void Stage::Parts::play_recorded(Player& player, Exchange<PlacedPatches>& patches, RecordedRun& recorded,
                                 RunResult& result) {
  result.scheduling = "replayed";
  while (const auto beat = recorded.next()) {
    publish_change(patches);
    player.serve(*beat);
    result.ticks_missed += beat->skipped;
  }
}

void Stage::Parts::play_in_virtual_time(Player& player, Exchange<PlacedPatches>& patches, long ticks,
                                        const RunOptions& options, RunResult& result) {
  const double rate = device.profile().rate;
  const long every = std::max(1L, std::lround(rate * progress_seconds));
  VirtualClock clock;
  result.scheduling = "virtual time";
  result.ticks_missed = run_loop(
      clock, rate, ticks, [&]() noexcept { return is_set(options.stop); },
      [&](const Beat& beat) {
        publish_change(patches);
        player.serve(beat);
        if (options.progress && (beat.period + 1) % every == 0) options.progress(player.progress());
      });
}

Result<> Stage::Parts::play_in_real_time(Player& player, Exchange<PlacedPatches>& patches, long ticks,
                                         const RunOptions& options, RunResult& result) {
  std::atomic<bool> abandoned = false;
  finished = false;
  const auto loop = [&] {
    {
      const RealTimeClaim claim;
      result.scheduling = claim.status();
      MonotonicClock clock;
      result.ticks_missed = run_loop(
          clock, device.profile().rate, ticks, [&]() noexcept { return is_set(options.stop) || is_set(&abandoned); },
          [&](const Beat& beat) noexcept { player.serve(beat); });
      device.command(Force(0));  // at once, without waiting for the other thread
    }
    const std::lock_guard lock(mutex);
    finished = true;
    news.notify_all();
  };
  std::thread thread;
  try {
    thread = std::thread(loop);
  } catch (const std::system_error& error) {
    return Error{.code = Code::short_of_resources,
                 .sentence = std::string("the system gives no thread for the loop: ") + error.what()};
  }
  struct Joiner {
    std::thread& thread;
    std::atomic<bool>& abandoned;
    ~Joiner() {
      abandoned = true;  // matters only when `progress` threw
      thread.join();
    }
  } joiner{thread, abandoned};
  attend(player, patches, options);
  return {};
}

/// The control thread's part while the real-time thread ticks.
void Stage::Parts::attend(const Player& player, Exchange<PlacedPatches>& patches, const RunOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(progress_seconds));
  for (auto next_progress = Clock::now() + interval;;) {
    {
      std::unique_lock lock(mutex);
      news.wait_until(lock, next_progress, [&] { return finished || has_news(); });
      if (finished) return;
    }
    publish_change(patches);
    if (Clock::now() < next_progress) continue;
    patches.collect();
    if (options.progress) options.progress(player.progress());
    next_progress = Clock::now() + interval;
  }
}

Stage::Stage(Device& device) : parts_(std::make_unique<Parts>(device)) {}

Stage::~Stage() = default;

void Stage::place(const Program& program, glm::vec2 position) { place(program, position, program.default_size()); }

void Stage::place(const Program& program, glm::vec2 position, PatchSize size) {
  Placement placement(program, position, size, 0);
  const std::lock_guard lock(parts_->mutex);
  if (parts_->recorder) parts_->recorder->place(program, position, size);
  parts_->placements.clear();
  parts_->placements.push_back(std::move(placement));
  parts_->begin_anew();
  parts_->note_change(0);
}

std::size_t Stage::add(const Program& program, glm::vec2 position, PatchSize size, float layer) {
  Placement placement(program, position, size, layer);
  const std::lock_guard lock(parts_->mutex);
  if (parts_->recorder) parts_->recorder->add(program, position, size, layer, placement.parameters);
  const std::size_t number = parts_->placements.size();
  parts_->placements.push_back(std::move(placement));
  parts_->note_change(number);
  return number;
}

Result<> Stage::replace(std::size_t patch, const Program& program) {
  const std::lock_guard lock(parts_->mutex);
  if (auto there = parts_->has(patch); !there) return there;
  if (parts_->recorder) parts_->recorder->replace(patch, program);
  parts_->placements[patch] = Placement(parts_->placements[patch], program);
  parts_->rearranged = true;
  if (std::ranges::find(parts_->replaced, patch) == parts_->replaced.end()) parts_->replaced.push_back(patch);
  parts_->note_change(patch);
  return {};
}

Result<> Stage::move(std::size_t patch, glm::vec2 position) {
  const std::lock_guard lock(parts_->mutex);
  if (auto there = parts_->has(patch); !there) return there;
  if (!std::isfinite(position.x) || !std::isfinite(position.y))
    return malformed("position", "the position to which a patch is moved must be finite");
  if (parts_->recorder) parts_->recorder->move(patch, position);
  Placement& placement = parts_->placements[patch];
  placement.position = position;
  if (!std::exchange(placement.moves, true)) {
    parts_->movers.insert(std::ranges::upper_bound(parts_->movers, patch), patch);
    parts_->rearranged = true;
  }
  parts_->moved = true;
  parts_->news.notify_all();
  return {};
}

Result<> Stage::set(std::string_view parameter, float value) { return set(0, parameter, value); }

Result<> Stage::set(std::size_t patch, std::string_view parameter, float value) {
  const std::lock_guard lock(parts_->mutex);
  if (auto there = parts_->has(patch); !there) return there;
  Placement& placement = parts_->placements[patch];
  const Program& program = placement.program;
  const std::vector<Parameter>& known = program.description().parameters;
  const std::optional<std::size_t> index = program.parameter(parameter);
  if (!index) {
    std::string names;
    for (const Parameter& one : known) names += (names.empty() ? "" : ", ") + one.name;
    return Error{.code = Code::unknown_name,
                 .sentence = program.description().material + " has no parameter " + std::string(parameter),
                 .mend = names.empty() ? "it has no parameters" : "it has " + names,
                 .place = {.name = std::string(parameter)}};
  }
  const Parameter& range = known[*index];
  if (!(value >= range.low && value <= range.high)) {
    return malformed(range.name, range.name + " = " + shown(range, value) + " is not in its range " +
                                     shown(range, range.low) + " .. " + shown(range, range.high));
  }
  if (parts_->recorder) parts_->recorder->set(patch, *index, value);
  placement.parameters[*index] = value;
  parts_->note_change(patch);
  return {};
}

std::optional<Bank> Stage::bank(std::size_t patch) const {
  const std::optional<Placement> placement = parts_->copy_placement(patch);
  if (!placement) return std::nullopt;
  return placement->bank();
}

Result<> Stage::Parts::begin_run(const RunOptions& options) {
  const std::lock_guard lock(mutex);
  if (placements.empty()) return wrong_moment("nothing is placed on the stage");
  if (running) return wrong_moment("another run is under way on this stage");
  for (const Placement& placement : placements)
    if (auto fit = fits(placement.program.description(), device.profile()); !fit) return fit;
  if (auto begun = begin_recording(options); !begun) return begun;
  running = true;
  revision = 0;
  begin_anew();  // every run begins with banks and memories of its own
  for (std::size_t patch = 0; patch < placements.size(); ++patch) {
    placements[patch].memory = std::make_shared<Memory>(placements[patch].program);
    changed.push_back(patch);
  }
  return {};
}

void Stage::Parts::end_run() {
  const std::lock_guard lock(mutex);
  running = false;
  recorder.reset();
}

Result<> Stage::Parts::play(Player& player, Exchange<PlacedPatches>& patches, long ticks, const RunOptions& options,
                            RunResult& result) {
  if (options.recorded != nullptr)
    play_recorded(player, patches, *options.recorded, result);
  else if (options.virtual_time)
    play_in_virtual_time(player, patches, ticks, options, result);
  else
    return play_in_real_time(player, patches, ticks, options, result);
  return {};
}

Result<RunResult> Stage::run(const RunOptions& options) {
  const DeviceProfile& profile = parts_->device.profile();
  if (auto whole = complete(profile); !whole) return std::move(whole).error();
  const Result<RunLength> length = length_of(options, profile.rate);
  if (!length) return length.error();
  if (!(options.most_newton > 0)) return malformed("most_newton", "the largest force allowed must be positive");
  if (auto begun = parts_->begin_run(options); !begun) return std::move(begun).error();
  struct Ending {
    Parts& parts;
    ~Ending() { parts.end_run(); }
  } ending{*parts_};

  RunResult result;
  Exchange<PlacedPatches> patches;
  parts_->publish_change(patches);
  TickSink* const sink = options.recorded != nullptr ? options.recorded : parts_->sink();
  const bool real_time = !options.virtual_time && options.recorded == nullptr;
  Player player(parts_->device, patches, result.record, static_cast<std::size_t>(length->kept), options.most_newton,
                real_time, sink);
  if (auto played = parts_->play(player, patches, length->ticks, options, result); !played)
    return std::move(played).error();
  player.finish();
  result.ticks_run = player.served();
  result.record_problem = parts_->end_recording();
  result.lateness = player.lateness();
  result.costs = player.costs();
  result.guards = player.guards();
  return result;
}

}  // namespace wale
