#include "runtime/device/hid_pid/report_transport.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>

namespace wale {
namespace {

hid::PidSessionOptions within(hid::PidSessionOptions options, const ReportChannel& channel) {
  options.most_in_flight = std::clamp(options.most_in_flight, 1, std::max(1, channel.most_under_way()));
  return options;
}

PidTransport::Ranges ranges_of(const hid::PidLayout& layout) {
  return {layout.input.x.minimum, layout.input.x.maximum, layout.input.y.minimum, layout.input.y.maximum,
          layout.set_constant_force.full()};
}

}  // namespace

Result<std::unique_ptr<PidTransport>> ReportTransport::open(PidTransportKind kind, const Channel& channel,
                                                            const PidTransportOptions& options) {
  std::unique_ptr<ReportTransport> transport(new ReportTransport(kind, channel, options));
  if (Result<> running = transport->wait_until_running(); !running) return std::move(running).error();
  if (Result<> kept = transport->get_keeper(options.keeper); !kept) return std::move(kept).error();
  return transport;
}

ReportTransport::ReportTransport(PidTransportKind kind, const Channel& channel, const PidTransportOptions& options)
    : kind_(kind),
      now_(options.now),
      channel_(channel(*this)),
      session_(channel_->interface(), within(options.session, *channel_)) {
  writer_ = std::thread([this] { write_forces(); });
  if (options.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = options.priority;
    pthread_setschedparam(writer_.native_handle(), SCHED_FIFO, &parameters);
  }
  const std::lock_guard lock(mutex_);
  pump();
}

ReportTransport::~ReportTransport() {
  stop_waiting();
  writer_.join();
  {
    std::unique_lock lock(mutex_);
    session_.stop();
    pump();
    // Each of its last transfers ends, at the latest after its timeout. The session waits at most `rival_patience`.
    constexpr std::chrono::milliseconds between_looks(10);
    while (session_.state() != hid::PidSession::State::over) {
      changed_.wait_for(lock, between_looks);
      pump();
    }
    closes_ = true;
  }
  channel_->close();
  end_keeper();  // now that nothing is sent any more
}

/// Waits until the device runs and has sent a position, or is lost.
Result<> ReportTransport::wait_until_running() {
  using State = hid::PidSession::State;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return session_.state() == State::running || session_.state() == State::over; });
  // A device that reports only changes is asked after `input_silence`.
  changed_.wait_for(lock, std::chrono::seconds(1),
                    [&] { return session_.state() != State::running || session_.input().has_value(); });
  if (session_.state() != State::running) return Error{session_.why(), std::string(session_.reason())};
  if (!session_.input()) return Error{Code::unlike_device, "it sends no position"};
  ranges_ = ranges_of(*session_.layout());
  return {};
}

/// While the device pushes nothing yet.
Result<> ReportTransport::get_keeper(const std::optional<KeeperOptions>& options) {
  if (!options) return {};
  LetGoPlan plan;
  {
    const std::lock_guard lock(mutex_);
    plan = channel_->let_go_plan(session_.leaving());
  }
  auto keeper = Keeper::start(plan, channel_->descriptor(), *options);
  if (!keeper) return std::move(keeper).error();
  set_keeper(*std::move(keeper));
  return {};
}

/// Before packets are made. Under the lock.
void ReportTransport::heed_keeper() {
  if (!keeper()) return;
  const Keeper::Verdict verdict = keeper()->look();
  switch (verdict) {
    case Keeper::Verdict::good: break;
    case Keeper::Verdict::late: session_.hush(); break;
    case Keeper::Verdict::stalled:
    case Keeper::Verdict::slept:
    case Keeper::Verdict::gone: session_.lose(keeper()->why(verdict), Outcome::failed, Code::lost_device); break;
    case Keeper::Verdict::latched: session_.give_up(keeper()->why(verdict)); break;
  }
}

/// The last look before a packet goes; whoever asks is about to make the system call.
bool ReportTransport::may_go(const hid::Transfer& transfer) const noexcept {
  if (!keeper()) return true;
  if (transfer.pushes) keeper()->note_push();
  const Keeper::Verdict verdict = keeper()->look();
  return verdict == Keeper::Verdict::good || (verdict != Keeper::Verdict::latched && !transfer.pushes);
}

/// Packs the session's input for the loop, and says when the device is lost. Under the lock.
void ReportTransport::publish() {
  if (const auto& input = session_.input()) show(input->x, input->y, input->button);
  if (session_.was_lost()) show_lost();
  changed_.notify_all();
}

/// The writer's thread.
void ReportTransport::write_forces() {
  constexpr std::int64_t patience = 20'000;  // microseconds; the longest wait between checks for refreshes and silence
  while (true) {
    const auto wanted = wait_for_command(patience);
    if (is_ending()) return;
    const std::lock_guard lock(mutex_);
    if (wanted) session_.command(*wanted, now_());
    pump();
  }
}

/// Submits the transfers that the session asks for. Under the lock.
void ReportTransport::pump() {
  using State = hid::PidSession::State;
  heed_keeper();
  while (auto transfer = session_.next(now_())) {
    transfer->pushes = session_.state() == State::running && session_.holds_force();
    const bool may_go = this->may_go(*transfer);
    const Outcome outcome =
        may_go ? channel_->submit(*transfer, session_.state() == State::setting_up) : Outcome::failed;
    if (outcome != Outcome::done) session_.finish(*transfer, outcome, {}, now_());
  }
  if (keeper() && session_.is_slack()) keeper()->note_slack();
  if (!listens_ && session_.state() == State::running) {
    listens_ = true;
    if (const Outcome outcome = channel_->listen(); outcome != Outcome::done) {
      session_.lose(outcome == Outcome::gone ? "it was unplugged" : "its position cannot be read", outcome);
    }
  }
  publish();
}

void ReportTransport::ended(const hid::Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer) {
  const std::lock_guard lock(mutex_);
  session_.finish(transfer, outcome, answer, now_());
  if (closes_) {
    publish();
  } else {
    pump();
  }
}

void ReportTransport::received(std::span<const std::uint8_t> report, bool is_old) {
  const std::lock_guard lock(mutex_);
  if (closes_ || session_.state() == hid::PidSession::State::over) return;
  session_.receive(report, now_(), is_old);
  pump();
}

void ReportTransport::silenced(std::string_view reason, Outcome outcome) {
  const std::lock_guard lock(mutex_);
  if (closes_) return;
  session_.lose(reason, outcome);
  pump();
}

std::string ReportTransport::reason() const {
  const std::lock_guard lock(mutex_);
  return std::string(session_.reason());
}

hid::PidSessionCounts ReportTransport::counts() const {
  const std::lock_guard lock(mutex_);
  return session_.counts();
}

std::optional<hid::Telemetry> ReportTransport::telemetry() const {
  const std::lock_guard lock(mutex_);
  return session_.telemetry();
}

hid::Arrangement ReportTransport::arrangement() const {
  const std::lock_guard lock(mutex_);
  return session_.arrangement();
}

}  // namespace wale
