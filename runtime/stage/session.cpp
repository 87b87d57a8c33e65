#include "runtime/stage/session.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <system_error>
#include <unordered_set>

#include "runtime/device/device_at_home.hpp"
#include "runtime/stage/device_figures.hpp"
#include "runtime/stage/devices_in_use.hpp"
#include "runtime/stage/patches_in_run.hpp"
#include "runtime/stage/scheduling.hpp"
#include "schema/name_text.hpp"

namespace wale {
namespace {

constexpr long longest_run = 1L << 24;
constexpr double endless = 0x1p53;  // ticks: the greatest number that a double counts exactly
constexpr double progress_seconds = 0.1;

/// A run begins after this time although some patches are not ready: a person takes longer to notice that nothing has
/// begun (Miller 1968: a control that is pressed answers within 0.1 s), and nearly all stages are ready by then.
constexpr auto patience_at_start = std::chrono::milliseconds(30);

std::string few_digits(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr};
}

}  // namespace

Error run_without_memory() {
  return {.code = Code::short_of_resources,
          .sentence = "there was no memory left for the run",
          .mend = "free some, and start it again",
          .place = {.name = "stage"}};
}

namespace {

struct RunLength {
  long ticks = 0;  ///< of the run, at least one
  long kept = 0;   ///< of its record, at least one
};

Result<RunLength> length_of(const RunOptions& options, double rate) {
  const auto asked = [](double seconds) { return "; asked for " + few_digits(seconds) + " s"; };
  if (!(options.seconds > 0))
    return malformed("seconds", "the length of a run must be positive" + asked(options.seconds),
                     "give seconds, as in 5", "a positive number of seconds", few_digits(options.seconds));
  if (!(options.kept_seconds > 0))
    return malformed("kept_seconds", "the length of a run's record must be positive" + asked(options.kept_seconds),
                     "leave it out to keep all of the run", "a positive number of seconds",
                     few_digits(options.kept_seconds));
  const double kept = std::min(options.seconds, options.kept_seconds);
  if (kept * rate > static_cast<double>(longest_run)) {
    const bool endless_run = kept < options.seconds;
    return malformed(endless_run ? "kept_seconds" : "seconds",
                     "a run keeps at most " + few_digits(static_cast<double>(longest_run) / rate) + " s at " +
                         few_digits(rate) + " Hz" + asked(kept),
                     endless_run ? "keep less" : "keep less of it: `kept_seconds`",
                     "at most " + few_digits(static_cast<double>(longest_run) / rate) + " s", few_digits(kept));
  }
  return RunLength{std::max(1L, std::lround(std::min(options.seconds * rate, endless))),
                   std::max(1L, std::lround(kept * rate))};
}

Error no_thread(const char* for_what, const std::system_error& error) {
  return {.code = Code::short_of_resources,
          .sentence = std::string("the system gives no thread for ") + for_what + ": " + error.what(),
          .mend = "end other programs, or raise the limit on processes (ulimit -u)",
          .place = {.name = "stage"}};
}

}  // namespace

Result<std::unique_ptr<Session>> Session::begin(std::shared_ptr<StageState> stage, const RunOptions& options,
                                                Clock clock, bool may_be_empty, Device& device) {
  const DeviceProfile& profile = stage->profile;
  if (auto sound = check_figures(profile); !sound) return std::move(sound).error();
  const Result<RunLength> length = length_of(options, profile.rate);
  if (!length) return length.error();
  const StageOptions& how = stage->options;
  if (!(how.max_force > 0))
    return malformed("max_force", "the largest force allowed must be positive", "give newtons, as in 2",
                     "a positive force", few_digits(how.max_force));
  if (how.priority && !(*how.priority >= 1 && *how.priority <= 99))
    return malformed("priority", "the priority of a loop must be in 1 .. 99", "the usual one is 80", "1 .. 99",
                     std::to_string(*how.priority));
  std::unique_ptr<Session> session(new Session(stage, options, clock, device));
  session->ticks_ = length->ticks;
  session->kept_ = length->kept;
  std::unique_lock lock(stage->mutex);
  const auto refuse = [&](Error error) -> Result<std::unique_ptr<Session>> {
    lock.unlock();
    return error;
  };
  if (stage->over) return refuse(stage_is_gone());
  if (stage->running) return refuse(another_run());
  if (!may_be_empty && stage->table.size() == 0)
    return refuse(wrong_moment("stage", "nothing is on the stage", "add a patch first"));
  const auto* const opened = dynamic_cast<const DeviceAtHome*>(&device);
  if (opened != nullptr && !opened->is_here())
    return refuse(wrong_moment("device", "the device is the parent process's, and this is a child of its fork",
                               "open it again in the child"));
  if (!take_device(device))
    return refuse(wrong_moment("device", "another stage runs on this device",
                               "wait for the end of its run or stop it, or give this stage a device of its own"));
  session->has_device_ = true;
  // The guards know what the device will not let through: the passivity observer would take it for an energy gain.
  session->most_ = opened != nullptr ? std::min(how.max_force, opened->most()) : how.max_force;
  if (auto begun = session->begin_recording(); !begun) return refuse(std::move(begun).error());
  session->has_stage_ = stage->running = stage->served = true;
  stage->told_to_stop = false;
  stage->outlives_its_device = clock == Clock::own;
  stage->caller_serves = clock == Clock::unreal;
  stage->table.begin(clock == Clock::unreal ? PatchTable::Manner::together : PatchTable::Manner::piecewise,
                     how.lock_memory);
  stage->outlets.state.store({});
  lock.unlock();
  session->player_.emplace(device, session->patches_, session->result_.record, static_cast<std::size_t>(session->kept_),
                           session->most_, clock == Clock::real, stage->recorder.get(), &stage->outlets);
  if (clock != Clock::unreal)
    if (auto started = session->start_preparing(); !started) return std::move(started).error();
  return session;
}

Session::~Session() {
  if (!has_stage_) {
    if (has_device_) give_device_back(device_);
    return;
  }
  stop_threads();
  player_.reset();  // commands zero force
  if (has_begun_ && (has_failed_ || (clock_ != Clock::own && !has_ended_well_))) tell_no_force();
  if (has_device_) give_device_back(device_);
  const std::lock_guard lock(stage_->mutex);
  if (stage_->recorder && clock_ == Clock::own && has_begun_) stage_->recorder->end();
  if (stage_->recorder && !has_begun_) stage_->recorder->discard();  // so that another try finds no file
  stage_->table.end();
  stage_->recorder.reset();
  stage_->running = stage_->served = stage_->caller_serves = false;
  stage_->caller = {};
  stage_->news.notify_all();
}

void Session::tell_no_force() noexcept {
  TickState state = stage_->outlets.state.load();
  state.force = Force(0);
  state.inside = false;
  stage_->outlets.state.store(state);
}

void Session::stop_threads() noexcept {
  {
    const std::lock_guard lock(stage_->mutex);
    finished_ = prepared_enough_ = true;
    stage_->news.notify_all();
    stage_->work.notify_all();
  }
  if (attending_.joinable()) attending_.join();
  if (preparing_.joinable()) preparing_.join();
}

void Session::fail() noexcept {
  has_failed_ = true;
  if (clock_ == Clock::own) stage_->told_to_stop = true;
  const std::lock_guard lock(stage_->mutex);
  stage_->news.notify_all();
}

Result<> Session::begin_recording() {
  const std::optional<RecordTo>& to = stage_->options.record;
  if (!to) return {};
  if (to->file.empty())
    return malformed("record", "the recording has no file", "name one, as in \"run.wrec\", or leave `record` out",
                     "the path of a file", "an empty text");
  if (!to->hand.empty())
    if (auto text = is_name_text("record_hand", to->hand, record_hand_mend); !text) return text;
  const RecordingHeader header{.device = stage_->profile,
                               .most_newton = most_,
                               .virtual_time = clock_ == Clock::unreal,
                               .hand = to->hand};
  auto begun = RecordWriter::begin(to->file, header, clock_ == Clock::unreal);
  if (!begun) return std::move(begun).error();
  stage_->recorder = *std::move(begun);
  return {};
}

Result<> Session::start_preparing() {
  try {
    preparing_ = std::thread([this]() noexcept {
      try {
        prepare();
      } catch (...) {
        fail();
      }
    });
  } catch (const std::system_error& error) {
    return no_thread("banks", error);
  }
  return {};
}

void Session::prepare() {
  take_ordinary_priority();  // the ticks must not wait for a bank
  StageState& stage = *stage_;
  std::unique_lock lock(stage.mutex);
  while (!prepared_enough_) {
    const TickState state = stage.outlets.state.load();
    std::optional<PatchTable::Work> work = stage.table.next_work({state.position, state.velocity});
    if (stage.table.has_news()) stage.news.notify_all();
    if (!work) {
      stage.work.wait(lock);
      continue;
    }
    lock.unlock();
    const bool done = work->run(stage.banks, stage.table.hurry());
    lock.lock();
    stage.table.finish(*std::move(work), done);
    stage.news.notify_all();
  }
}

void Session::publish() {
  stage_->table.publish(patches_, stage_->recorder.get());
  stage_->work.notify_one();
}

void Session::hand_over_first() {
  std::unique_lock lock(stage_->mutex);
  stage_->news.wait_for(lock, patience_at_start, [&] { return !stage_->table.is_waiting(); });
  publish();
}

bool Session::is_stopped() const noexcept {
  return has_failed_.load(std::memory_order_relaxed) || (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) ||
         stage_->told_to_stop.load(std::memory_order_relaxed);
}

void Session::serve_in_virtual_time() {
  const double rate = stage_->profile.rate;
  has_begun_ = true;
  const long every = std::max(1L, std::lround(rate * progress_seconds));
  VirtualClock clock;
  result_.scheduling = "virtual time";
  result_.ticks_missed = run_loop(
      clock, rate, ticks_, [&]() noexcept { return is_stopped(); },
      [&](const Beat& beat) {
        {
          const std::lock_guard lock(stage_->mutex);
          stage_->table.publish(patches_, stage_->recorder.get());
        }
        if (beat.period % 1000 == 0) player_->make_room();  // for more beats than that
        player_->serve(beat);
        if (options_.progress && (beat.period + 1) % every == 0) options_.progress(stage_->now());
      });
}

Result<> Session::serve_in_real_time() {
  std::atomic<bool> abandoned = false;
  hand_over_first();
  if (stage_->options.lock_memory) lock_pages(&*player_, sizeof *player_);
  GrantedClaim granted;
  const auto loop = [&]() noexcept {
    {
      const RealTimeClaim claim(stage_->options);
      granted = claim.granted();
      MonotonicClock clock;
      result_.ticks_missed = run_loop(
          clock, stage_->profile.rate, ticks_,
          [&]() noexcept { return is_stopped() || abandoned.load(std::memory_order_relaxed); },
          [&](const Beat& beat) noexcept { player_->serve(beat); });
      device_.command(Force(0));  // at once, without waiting for the other thread
    }
    const std::lock_guard lock(stage_->mutex);
    finished_ = true;
    stage_->served = false;
    stage_->news.notify_all();
  };
  std::thread thread;
  try {
    thread = std::thread(loop);
  } catch (const std::system_error& error) {
    return no_thread("the loop", error);
  }
  has_begun_ = true;
  struct Joiner {
    std::thread& thread;
    std::atomic<bool>& abandoned;
    ~Joiner() {
      abandoned = true;  // matters only when `progress` threw, or there was no memory
      if (thread.joinable()) thread.join();
    }
  } joiner{thread, abandoned};
  attend();
  thread.join();
  if (has_failed_) return run_without_memory();
  result_.scheduling = granted.in_words();
  return {};
}

void Session::attend() {
  using Ticking = std::chrono::steady_clock;
  const auto interval = std::chrono::duration_cast<Ticking::duration>(std::chrono::duration<double>(progress_seconds));
  for (auto next_progress = Ticking::now() + interval;;) {
    const bool more_room = player_->make_room();
    {
      std::unique_lock lock(stage_->mutex);
      stage_->news.wait_until(lock, more_room ? Ticking::now() : next_progress, [&] { return finished_ || stage_->table.has_news(); });
      if (finished_) return;
      if (stage_->table.has_news()) publish();
    }
    if (Ticking::now() < next_progress) continue;
    patches_.collect();
    if (options_.progress) options_.progress(stage_->now());
    next_progress = Ticking::now() + interval;
  }
}

Result<> Session::attend_apart() {
  hand_over_first();
  try {
    attending_ = std::thread([this]() noexcept {
      try {
        attend();
      } catch (...) {
        fail();
      }
    });
  } catch (const std::system_error& error) {
    return no_thread("changes", error);
  }
  has_begun_ = true;
  return {};
}

Result<RunResult> Session::play() {
  {
    const std::lock_guard lock(stage_->mutex);
    stage_->caller = std::this_thread::get_id();
  }
  if (clock_ == Clock::unreal)
    serve_in_virtual_time();
  else if (auto served = serve_in_real_time(); !served)
    return std::move(served).error();
  player_->finish();
  result_.ticks_run = player_->served();
  std::unordered_set<std::uint32_t> changes;
  for (const TickRecord& tick : result_.record.ticks)
    if (tick.inside) changes.insert(tick.change);
  {
    const std::lock_guard lock(stage_->mutex);
    result_.patches = std::make_shared<const PatchesInRun>(stage_, stage_->table.published(changes));
    if (stage_->recorder) {
      stage_->recorder->end();
      result_.record_problem = stage_->recorder->ended_early();
    }
  }
  result_.lateness = player_->lateness();
  result_.costs = player_->costs();
  result_.guards = player_->guards();
  has_ended_well_ = true;
  return std::move(result_);
}

}  // namespace wale
