#include "runtime/device/falcon/falcon_session.hpp"

#include <algorithm>
#include <utility>

namespace wale::falcon {
namespace {

struct Control {
  std::uint8_t request;
  std::uint16_t value;
};

// Requests of the FTDI chip: 0 reset (1: purge what comes in, 2: what goes out), 1 modem lines (value's upper byte:
// which are meant), 2 flow control, 3 baud rate (divisors), 4 data format, 9 latency (ms after which received bytes are
// passed on). libnifalcon, src/comm/FalconCommLibUSB.cpp: setNormalMode and setFirmwareMode.
constexpr Control normal_mode[] = {{9, 1}, {3, 0x0002}, {0, 1}, {0, 2}};
constexpr Control firmware_mode[] = {{0, 1},      {0, 2},        // purge
                                     {9, 16},                    // ms
                                     {3, 0x4138}, {4, 8},        // 9600 baud, 8 bits, no parity, one stop bit
                                     {2, 0},                     // no flow control
                                     {1, 0x0200},                // RTS low
                                     {1, 0x0100}, {1, 0x0101}};  // DTR low, then high: resets it
constexpr Control fast_mode[] = {{1, 0x0100}, {3, 0x0015}};      // DTR low, 140000 baud

constexpr std::uint8_t hello[] = {0x0a, 0x43, 0x0d}, hello_answer[] = {0x0a, 0x44, 0x2c, 0x0d}, letter[] = {0x41};
constexpr std::size_t chunk_bytes = 62;

constexpr int most_probes = 5, most_greetings = 30, most_farewell_silences = 3, farewells = 2;

std::int64_t in_microseconds(double seconds) noexcept { return static_cast<std::int64_t>(seconds * 1e6); }

}  // namespace

FalconSession::FalconSession(FalconSessionOptions options) : options_(std::move(options)) {}

std::optional<Transfer> FalconSession::next(std::int64_t now) noexcept {
  if (state_ == State::over || control_under_way_) return std::nullopt;
  std::span<const Control> controls;
  switch (step_) {
    case Step::normal_mode:
    case Step::normal_again: controls = normal_mode; break;
    case Step::firmware_mode: controls = firmware_mode; break;
    case Step::fast_mode: controls = fast_mode; break;
    default: break;
  }
  if (!controls.empty()) {
    // Waits for transfers under way, whose bytes belong to the previous mode.
    if (write_under_way_ || read_under_way_) return std::nullopt;
    Transfer transfer;
    transfer.request = controls[at_].request;
    transfer.value = controls[at_].value;
    control_under_way_ = true;
    return transfer;
  }
  if (step_ == Step::leave && !write_under_way_ && (farewells_ >= farewells || silences_ >= most_farewell_silences)) {
    go_to(Step::none);
    state_ = State::over;
    return std::nullopt;
  }
  if (!expects_ && !write_under_way_) {
    expects_ = write_under_way_ = true;
    asked_ = now;
    return written(now);
  }
  if (expects_ && !read_under_way_) {
    read_under_way_ = true;
    Transfer transfer;
    transfer.kind = Transfer::Kind::read;
    return transfer;
  }
  return std::nullopt;
}

/// The write transfer of the present step.
Transfer FalconSession::written(std::int64_t now) noexcept {
  Transfer transfer;
  transfer.kind = Transfer::Kind::write;
  const auto put = [&](std::span<const std::uint8_t> bytes) {
    std::copy(bytes.begin(), bytes.end(), transfer.bytes.begin());
    transfer.size = static_cast<std::uint8_t>(bytes.size());
  };
  Command command;
  matched_ = 0;
  switch (step_) {
    case Step::hello: put(hello); return transfer;
    case Step::letter: put(letter); return transfer;
    case Step::chunk: put(expected()); return transfer;
    case Step::leave: command.keeps_homing = false; break;
    case Step::loop:
      if (state_ == State::running) {
        if (now - commanded_ > in_microseconds(options_.command_silence)) hush();
        command.torques = allowed_torques(now);
        pending_ = false;
      }
      command.light = state_ == State::running ? Light::green : Light::red;
      break;
    default: command.light = Light::red; break;
  }
  put(encode(command));
  holds_force_ = command.torques != Torques{};
  ++counts_.commands_sent;
  return transfer;
}

/// The only torques that a packet gets: those commanded, as far as the limits allow them where the handle is now.
Torques FalconSession::allowed_torques(std::int64_t now) const noexcept {
  if (!answer_ || now - heard_ > in_microseconds(options_.stale_after)) return {};
  return options_.gate.within(torques_, answer_->encoders);
}

/// The answer that the loader should give now; while the firmware is loaded, the echo of it.
std::span<const std::uint8_t> FalconSession::expected() const noexcept {
  switch (step_) {
    case Step::hello: return hello_answer;
    case Step::letter: return letter;
    case Step::chunk: {
      const std::span<const std::uint8_t> rest = std::span(options_.firmware).subspan(at_);
      return rest.first(std::min(chunk_bytes, rest.size()));
    }
    default: return {};
  }
}

void FalconSession::finish(const Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> came_in,
                           std::int64_t now) noexcept {
  switch (transfer.kind) {
    case Transfer::Kind::control: control_under_way_ = false; break;
    case Transfer::Kind::write: write_under_way_ = false; break;
    case Transfer::Kind::read: read_under_way_ = false; break;
  }
  if (state_ == State::over) return;
  if (outcome == Outcome::gone) return lose("it was unplugged", outcome);
  if (step_ == Step::leave) {
    // A device that takes fewer bytes than it was sent is not usable.
    if (outcome != Outcome::done && transfer.kind == Transfer::Kind::write) ++silences_, expects_ = false;
  } else if (transfer.kind == Transfer::Kind::control) {
    if (outcome == Outcome::timed_out) return lose("it does not answer in time", outcome);
    if (outcome != Outcome::done) return lose("it refuses to be set up", outcome);
    ++at_;
    switch (step_) {
      case Step::normal_mode:
        if (at_ == std::size(normal_mode)) go_to(Step::probe);
        break;
      case Step::firmware_mode:
        if (at_ == std::size(firmware_mode)) go_to(Step::hello);
        break;
      case Step::fast_mode:
        if (at_ == std::size(fast_mode)) go_to(Step::letter);
        break;
      case Step::normal_again:
        if (at_ == std::size(normal_mode)) go_to(Step::probe_again);
        break;
      default: break;
    }
    return;
  } else if (transfer.kind == Transfer::Kind::write) {
    if (outcome == Outcome::timed_out) return lose("it does not answer in time", outcome);
    if (outcome != Outcome::done) return lose("it takes no packets", outcome);
    return;
  }
  if (transfer.kind != Transfer::Kind::read) return;
  if (outcome != Outcome::done && outcome != Outcome::timed_out) {
    if (step_ != Step::leave) return lose("its answers cannot be read", outcome);
    ++silences_;
    expects_ = false;
    return;
  }
  if (!expects_) return;
  const auto bytes = payload(came_in);
  if (is_loading() && !bytes.empty()) asked_ = now;  // the answer is coming
  const bool is_answered = is_loading() ? take_echo(bytes) : take_answers(bytes, now);
  if (state_ == State::over || !expects_) return;
  if (is_answered) return answered(now);
  if (now - asked_ > in_microseconds(options_.answer_silence)) unanswered();
}

/// Takes the loader's bytes; true once the expected answer is complete.
bool FalconSession::take_echo(std::span<const std::uint8_t> bytes) noexcept {
  for (const std::uint8_t byte : bytes) {
    const auto wanted = expected();
    if (matched_ < wanted.size() && byte == wanted[matched_]) {
      ++matched_;
    } else if (step_ == Step::hello) {
      matched_ = byte == wanted[0] ? 1 : 0;  // other bytes may come before it
    } else {
      lose("its loader does not repeat what it is given", Outcome::failed);
      return false;
    }
    if (step_ == Step::hello && matched_ == wanted.size()) return true;
  }
  return matched_ == expected().size();
}

/// Takes the firmware's bytes; true once an answer is complete.
bool FalconSession::take_answers(std::span<const std::uint8_t> bytes, std::int64_t now) noexcept {
  bool is_answered = false;
  for (const std::uint8_t byte : bytes) {
    garbage_ = true;
    if (const auto answer = reader_.take(byte)) {
      answer_ = *answer;
      is_answered = true;
      heard_ = now;
      garbage_ = false;
      ++counts_.answers;
    }
  }
  counts_.skipped_bytes = reader_.skipped();
  return is_answered;
}

void FalconSession::answered(std::int64_t now) noexcept {
  expects_ = false;
  silences_ = 0;
  switch (step_) {
    case Step::probe:
    case Step::probe_again:
      go_to(Step::loop);
      state_ = State::homing;
      break;
    case Step::hello: go_to(Step::fast_mode); break;
    case Step::letter: go_to(Step::chunk); break;
    case Step::chunk:
      at_ += expected().size();
      ++counts_.firmware_chunks;
      if (at_ == options_.firmware.size()) go_to(Step::normal_again);
      break;
    case Step::loop:
      if (state_ == State::homing && answer_->is_homed()) {
        state_ = State::running;
        commanded_ = now;
      } else if (state_ == State::running && !answer_->is_homed()) {
        lose("its encoders have lost their zeros", Outcome::failed);
      }
      break;
    case Step::leave: ++farewells_; break;
    default: break;
  }
}

/// Asks again after a while without an answer, a limited number of times.
void FalconSession::unanswered() noexcept {
  expects_ = false;
  ++silences_;
  ++counts_.silences;
  switch (step_) {
    case Step::probe:
      if (silences_ < most_probes) break;
      wants_firmware_ = options_.firmware.empty();
      if (wants_firmware_) return lose("it runs no firmware", Outcome::failed);
      go_to(Step::firmware_mode);
      break;
    case Step::hello:
      if (silences_ == most_greetings) lose("its loader does not answer", Outcome::failed);
      break;
    case Step::letter:
    case Step::chunk: lose("its loader does not repeat what it is given", Outcome::failed); break;
    case Step::probe_again:
      if (silences_ == most_greetings) lose("it does not answer with this firmware", Outcome::failed);
      break;
    case Step::loop:
      if (silences_ < options_.most_silences) break;
      lose(garbage_ ? "what it answers is nonsense" : "it does not answer in time", Outcome::timed_out);
      break;
    default: break;
  }
}

void FalconSession::go_to(Step step) noexcept {
  step_ = step;
  at_ = 0;
  silences_ = 0;
  expects_ = false;
}

void FalconSession::lose(std::string_view reason, Outcome outcome) noexcept {
  if (state_ == State::over) return;
  const bool is_gone = outcome == Outcome::gone;
  if (!lost_ && (state_ != State::leaving || is_gone)) {
    lost_ = true;
    reason_ = reason;
  }
  if (is_gone) {
    go_to(Step::none);
    state_ = State::over;
  } else {
    stop();
  }
}

void FalconSession::stop() noexcept {
  if (state_ == State::over || state_ == State::leaving) return;
  torques_ = {};
  // Only running firmware pushes: before it answers there is no torque to end.
  const bool may_push = step_ == Step::probe || step_ == Step::probe_again || step_ == Step::loop;
  go_to(may_push && !wants_firmware_ ? Step::leave : Step::none);
  state_ = may_push && !wants_firmware_ ? State::leaving : State::over;
}

void FalconSession::give_up(std::string_view reason) noexcept {
  if (state_ == State::over) return;
  lost_ = true;
  reason_ = reason;
  go_to(Step::none);
  state_ = State::over;
}

void FalconSession::hush() noexcept {
  if (silent_) return;
  silent_ = true;
  torques_ = {};
  ++counts_.command_silences;
}

void FalconSession::command(const Torques& torques, std::int64_t now) noexcept {
  if (state_ != State::running) return;
  if (pending_) ++counts_.overwritten;
  torques_ = torques;
  pending_ = true;
  silent_ = false;
  commanded_ = now;
}

}  // namespace wale::falcon
