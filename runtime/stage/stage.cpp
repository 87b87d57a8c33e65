#include "wale/stage.hpp"

#include <utility>

#include "runtime/stage/session.hpp"
#include "schema/home_process.hpp"

namespace wale {
namespace {

Error no_device() {
  return wrong_moment("stage", "the stage has no device", "make it with a device, or serve its ticks by a `Loop`");
}

/// Ends the run that `start` began, and waits for its end; false if it began none. Allocates nothing.
bool end_started_run(StageState& state) {
  if (!state.thread.joinable()) return false;
  {
    const std::lock_guard lock(state.mutex);
    if (!state.outcome) state.told_to_stop = true;  // a run that failed has ended, and another may be under way
  }
  state.thread.join();
  return true;
}

}  // namespace

Stage::Stage(std::unique_ptr<Device> device, StageOptions options) {
  const DeviceProfile profile = device ? device->profile() : DeviceProfile();
  state_ = std::make_shared<StageState>(std::move(device), nullptr, profile, std::move(options));
}

Stage::Stage(Device& device, StageOptions options)
    : state_(std::make_shared<StageState>(nullptr, &device, device.profile(), std::move(options))) {}

Stage::Stage(const DeviceProfile& profile, StageOptions options)
    : state_(std::make_shared<StageState>(nullptr, nullptr, profile, std::move(options))) {
  state_->has_profile = true;
}

Stage::Stage(Stage&&) noexcept = default;

Stage& Stage::operator=(Stage&& other) noexcept {
  Stage ended(std::move(other));
  std::swap(state_, ended.state_);
  return *this;
}

Stage::~Stage() {
  if (!state_) return;
  if (!state_->home.is_here()) {
    abandon(std::move(state_));
    return;
  }
  {
    const std::lock_guard starting(state_->starting);
    end_started_run(*state_);
  }
  std::unique_lock lock(state_->mutex);
  state_->over = true;
  state_->told_to_stop = true;
  if (state_->running && (state_->outlives_its_device || state_->caller == std::this_thread::get_id())) return;
  state_->news.wait(lock, [&] { return !state_->running; });
}

Result<Patch> Stage::add(const Program& program, const PatchOptions& options) {
  if (auto there = here(state_, stage_was_moved); !there) return std::move(there).error();
  Result<WantedPatch> placement = state_->wanted(program, options);
  if (!placement) return std::move(placement).error();
  const std::lock_guard lock(state_->mutex);
  placement->order = state_->table.next_order();
  std::vector<PatchTable::Wish> wishes;
  wishes.emplace_back(PatchName(), *std::move(placement));
  const PatchName name = state_->table.reserve();
  wishes.front().first = name;
  try {
    state_->want(std::move(wishes));
  } catch (...) {
    state_->table.release(name);
    throw;
  }
  return Patch(state_, name.number, name.generation);
}

StageEdit Stage::edit() { return StageEdit(state_); }

std::size_t Stage::size() const {
  if (!here(state_, stage_was_moved)) return 0;
  const std::lock_guard lock(state_->mutex);
  return state_->table.size();
}

bool Stage::is_running() const {
  if (!here(state_, stage_was_moved)) return false;
  const std::lock_guard lock(state_->mutex);
  return state_->running;
}

Result<RunResult> Stage::run(const RunOptions& options) {
  const auto there = here(state_, stage_was_moved);
  if (!there) return there.error();
  const std::shared_ptr<StageState> state = *there;  // the stage may be destroyed in `progress`
  if (state->device == nullptr) return no_device();
  auto session = Session::begin(state, options, options.virtual_time ? Session::Clock::unreal : Session::Clock::real,
                                false, *state->device);
  if (!session) return std::move(session).error();
  return (*session)->play();
}

Result<> Stage::start() {
  const auto there = here(state_, stage_was_moved);
  if (!there) return there.error();
  const std::shared_ptr<StageState> state = *there;
  const std::lock_guard starting(state->starting);
  if (state->device == nullptr) return no_device();
  if (state->thread.joinable()) return another_run();
  auto session = Session::begin(state, {.seconds = HUGE_VAL, .kept_seconds = 1 / state->profile.rate},
                                Session::Clock::real, true, *state->device);
  if (!session) return std::move(session).error();
  state->outcome.reset();
  Result<RunResult> ended_early = run_without_memory();  // made now, while there is memory
  try {
    state->thread = std::thread([state = state.get(), session = *std::move(session),
                                 result = std::move(ended_early)]() mutable noexcept {
      try {
        result = session->play();
        if (result) result->record.ticks.clear();
      } catch (...) {
      }
      {
        const std::lock_guard lock(state->mutex);
        state->outcome.emplace(std::move(result));
      }
      session.reset();
    });
  } catch (const std::system_error& error) {
    return Error{.code = Code::short_of_resources,
                 .sentence = std::string("the system gives no thread for the run: ") + error.what(),
                 .mend = "end other programs, or raise the limit on processes (ulimit -u)",
                 .place = {.name = "stage"}};
  }
  return {};
}

Result<RunResult> Stage::stop() {
  if (auto there = here(state_, stage_was_moved); !there) return std::move(there).error();
  const std::lock_guard starting(state_->starting);
  if (!end_started_run(*state_)) return wrong_moment("stage", "no run was started on this stage", "start one first");
  return *std::exchange(state_->outcome, std::nullopt);
}

Now Stage::now() const noexcept {
  // What a thread of the parent was writing at the fork stays half written.
  return state_ && state_->home.is_here() ? state_->now() : Now{};
}

void Stage::on_contact(std::function<void(const ContactEvent&)> receive) {
  if (!here(state_, stage_was_moved)) return;
  std::unique_lock polling(state_->polling, std::defer_lock);
  if (state_->poller != std::this_thread::get_id()) polling.lock();
  state_->outlets.wants_contacts = receive != nullptr;
  state_->receive = std::make_shared<const std::function<void(const ContactEvent&)>>(std::move(receive));
}

std::size_t Stage::poll() {
  if (!here(state_, stage_was_moved)) return 0;
  const std::shared_ptr<StageState> state = state_;  // a receiver may destroy the stage
  if (state->poller == std::this_thread::get_id()) return 0;
  const std::lock_guard polling(state->polling);
  struct Polling {
    explicit Polling(std::atomic<std::thread::id>& of) : poller(of) { poller = std::this_thread::get_id(); }
    ~Polling() { poller = std::thread::id(); }
    std::atomic<std::thread::id>& poller;
  } const now(state->poller);
  NotedContact contact;
  while (state->outlets.contacts.pop(contact)) {
    const auto receive = state->receive;  // it may name another one
    if (!receive || !*receive) continue;
    (*receive)({.kind = contact.kind,
                .patch = Patch(state, contact.number, contact.generation),
                .time = contact.time,
                .position = contact.position,
                .velocity = contact.velocity,
                .force = contact.force});
  }
  return state->outlets.contacts.take_dropped();
}

}  // namespace wale
