#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/device/hid_pid/force_gate.hpp"
#include "runtime/device/hid_pid/openffboard.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/pid_packets.hpp"
#include "runtime/device/outcome.hpp"
#include "wale/result.hpp"

namespace wale::hid {

/// The properties of an interface that the session needs.
struct HidInterface {
  std::uint8_t number = 0;
  std::uint16_t report_descriptor_bytes = 0;
  bool has_interrupt_out = true;  ///< otherwise output reports use the control endpoint
};

struct PidSessionOptions {
  ForceLimits limits;  ///< at the handle; every packet keeps within them
  /// s, after which a device stops by itself when no report reaches it any more, as after a kill; `endless`: never.
  /// Playing effects are started again each third of it.
  /// 0.2 s is below the 0.25 s within which every device is to be free of force; the starts are 30 packets a second for
  /// two effects, 3 % of what a full-speed endpoint takes, and a start may come 130 ms late before the force stutters.
  double effect_duration = 0.2;
  /// s without a command after which the force is none and effects are left to end: before a keeper takes the device
  /// for the same reason, after 0.1 s.
  double command_silence = 0.05;
  /// s without an input report after which the device is asked for one.
  double input_silence = 0.1;
  /// s between questions about its axes to a device that has OpenFFBoard's report for them, one number each; 0: none.
  double telemetry_period = 0.1;
  /// s between questions about the effect that was created last, by which a shared session notices a reset by another
  /// program; 0: never.
  double rival_check_period = 0.5;
  /// s from noticing that another program has stopped our effects to asking whether they still exist. A program that
  /// has reset the device creates its own effects within this time.
  double rival_patience = 0.25;
  /// Whether other programs may use the device at the same time. Then it is not told to stop all effects nor to disable
  /// its actuators on leaving, and a change of our effects by another program ends the session.
  bool is_shared = false;
  /// Whether setting up begins with a reset of the device, which also ends the effects of other programs.
  bool resets = true;
  int most_in_flight = 2;   ///< output reports on their way at once, 1 .. MayHold::most_on_their_way
  int most_bad_inputs = 8;  ///< in a row, after which the device is lost
};

/// A transfer that the session asks its caller to make.
struct Transfer {
  enum class Kind : std::uint8_t { control_in, control_out, interrupt_out };
  enum class Purpose : std::uint8_t { step, force, refresh, poll, telemetry, look };

  Kind kind = Kind::interrupt_out;
  Purpose purpose = Purpose::step;  ///< the session's own
  /// Of a control transfer (USB 2.0, section 9.3); `length` bytes come in, or those of `data` go out.
  std::uint8_t request_type = 0, request = 0;
  std::uint16_t value = 0, index = 0, length = 0;
  bool pushes = false;  ///< set by the transport: the device may push once it has this
  Packet data;
  std::size_t effect = 0;  ///< of a force: whose it is
};

using wale::Outcome;

/// How two axes share the device's effects.
enum class Arrangement : std::uint8_t {
  by_direction,  ///< an effect for each axis, turned to it: hosts usually send this, so devices do it best
  by_axis,       ///< an effect for each axis, enabled on it: for devices that know no directions
  combined       ///< one effect, turned to each new direction of the force: for devices with room for only one
};

/// For people: "one effect for each axis, by direction".
std::string_view in_words(Arrangement arrangement) noexcept;

/// What a session has done since it was made.
struct PidSessionCounts {
  std::array<long, 2> forces_sent{};  ///< Set Constant Force packets while running, per effect
  long directions_sent = 0;           ///< Set Effect packets that turned the combined effect
  long overwritten = 0;               ///< commands that a newer one replaced before any of it was sent
  long refreshes = 0;                 ///< effects started again
  long inputs = 0;                    ///< good input reports
  long other_reports = 0;             ///< input reports that are not about position
  long bad_inputs = 0;                ///< too short or of no known report
  long polls = 0;                     ///< input reports asked for
  long silences = 0;                  ///< times that no command came
  long looks = 0;                     ///< times that the device was asked about its effects
  long states = 0;                    ///< reports of the device's state
};

/// The protocol of a force-feedback joystick of USB's PID class, without USB: it gives the next transfer and takes its
/// outcome. Transfers of setting up and leaving are made one by one, because a device's endpoints are not ordered
/// relative to each other; while it runs, up to `most_in_flight` output reports and one poll are under way.
///
/// At most one force is pending: `next` takes the newest command, so no old force queues. Effects play for a finite
/// time and are refreshed, so that a device that honours durations stops when the process is killed. After a failure
/// the session tells the device to stop, as far as that is possible, and is over.
///
/// One thread at a time. Times are microseconds of any steady clock.
class PidSession {
 public:
  enum class State : std::uint8_t {
    setting_up,
    running,
    leaving,  ///< stops the device
    over      ///< ended: `was_lost` and `reason` say why
  };

  explicit PidSession(const HidInterface& interface, const PidSessionOptions& options = {});

  State state() const noexcept { return state_; }
  /// Whether it ended, or is ending, without `stop`.
  bool was_lost() const noexcept { return lost_; }
  /// Why it was lost; empty otherwise.
  std::string_view reason() const noexcept { return reason_; }
  /// The code of that error.
  Code why() const noexcept { return why_; }

  /// Known once the descriptor has been read.
  const std::optional<PidLayout>& layout() const noexcept { return layout_; }
  /// Known once it runs.
  Arrangement arrangement() const noexcept { return arrangement_; }
  const PidSessionCounts& counts() const noexcept { return counts_; }
  const std::optional<InputState>& input() const noexcept { return input_; }
  /// Empty if the device has no report for it.
  const std::optional<Telemetry>& telemetry() const noexcept { return telemetry_; }

  /// The transfer to make now, if any; each is given to `finish` once it has ended.
  /// Real-time while running and leaving: allocates nothing, takes no lock, makes no system call, does not throw.
  std::optional<Transfer> next(std::int64_t now) noexcept;

  /// `answer` has the bytes that came in. Real-time as `next` is; allocates while setting up.
  void finish(const Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> answer, std::int64_t now);

  /// An input report has come on the interrupt endpoint. An old one was held back while the device was set up: the
  /// states that it tells are those that the set-up passed through, such as disabled actuators after its reset.
  /// Real-time.
  void receive(std::span<const std::uint8_t> report, std::int64_t now, bool is_old = false) noexcept;

  /// The force to exert from now on, as shares -1 .. 1 of the device's full force along its own axes (y to the user).
  /// Not-a-number gives no force. Ignored unless running. Real-time.
  void command(glm::dvec2 force, std::int64_t now) noexcept;

  /// No command comes any more for now: the force is none, and effects are left to end. Ends with the next command.
  /// Real-time.
  void hush() noexcept;

  /// No force, all effects stopped and freed, the device reset and its actuators disabled: then the session is over.
  /// With other users only what is its own is stopped. Real-time.
  void stop() noexcept;

  /// Sends nothing more, not even to stop: another owns the device now, or its state is not known any more. Effects
  /// that still play end with their duration. `reason` outlives the session. Real-time.
  void give_up(std::string_view reason) noexcept;

  /// Whether the newest packets to the device, on their way or taken, let it push. Real-time.
  bool holds_force() const noexcept { return gate_.holds_force(); }
  /// Whether it has taken all that it is to take, and pushes nothing. Real-time.
  bool is_slack() const noexcept { return !holds_force() && !pending_ && in_flight_ == 0; }

  /// The packets by which another process lets the device go, in their order: those before `farewell` may be repeated,
  /// those from there on are for when this process is dead. Call it while the session runs.
  struct Leaving {
    std::array<Packet, 8> packets;
    std::size_t size = 0, farewell = 0;
    bool have_ids = true;  ///< the first byte of each is its report's number
  };
  Leaving leaving() const noexcept;

  /// The transport has failed: as after a transfer with that outcome. `reason` outlives the session. Real-time.
  void lose(std::string_view reason, Outcome outcome) noexcept;
  void lose(std::string_view reason, Outcome outcome, Code why) noexcept;

 private:
  enum class Step : std::uint8_t {
    read_descriptor,
    read_pool,
    reset,
    enable,
    gain,
    create,
    load,
    set,
    zero,
    start,
    run,
    leave_wait,
    leave_look,
    leave_zero,
    leave_stop,
    leave_stop_all,
    leave_free,
    leave_reset,
    leave_disable,
    none
  };

  /// Kinds of reports (HID 1.11, section 7.2.1).
  static constexpr std::uint8_t input_report = 1, output_report = 2, feature_report = 3;

  static constexpr std::int64_t microseconds(double seconds) noexcept {
    return static_cast<std::int64_t>(seconds * 1e6);
  }

  std::optional<Transfer> step_transfer() noexcept;
  void finish_step(Outcome outcome, std::span<const std::uint8_t> answer, std::int64_t now);
  void finish_load(Outcome outcome, std::span<const std::uint8_t> answer);
  void learn(std::span<const std::uint8_t> descriptor);
  void advance(std::int64_t now) noexcept;
  std::optional<Transfer> running_transfer(std::int64_t now) noexcept;
  std::optional<Transfer> force_transfer() noexcept;
  std::optional<Transfer> telemetry_transfer(std::int64_t now) noexcept;
  bool take_telemetry(std::span<const std::uint8_t> report) noexcept;
  std::optional<Transfer> look_transfer(std::int64_t now) noexcept;
  void take_state(const DeviceState& state, std::int64_t now) noexcept;
  void take_old_state(const DeviceState& state) noexcept;
  void take_look(std::span<const std::uint8_t> answer) noexcept;
  bool still_owns(std::span<const std::uint8_t> answer) const noexcept;
  void dispossess() noexcept { give_up("another program has reset it or stopped its effects"); }
  void dispossess_for_now(std::int64_t now) noexcept;
  void open_gate() noexcept;
  bool is_ours(std::uint8_t block) const noexcept;
  Packet turned_effect(std::size_t effect, double direction) const noexcept;
  Packet effect_packet(std::size_t effect) const noexcept;
  Transfer output(const Packet& packet, Transfer::Purpose purpose) const noexcept;
  Transfer get_report(std::uint8_t kind, const PacketShape& shape, Transfer::Purpose purpose) const noexcept;
  std::size_t effects() const noexcept { return arrangement_ == Arrangement::combined ? 1 : 2; }
  void refuse(Error error);

  HidInterface interface_;
  PidSessionOptions options_;
  State state_ = State::setting_up;
  Step step_ = Step::read_descriptor;
  std::size_t effect_ = 0;  // that the step is about
  std::size_t created_ = 0;
  bool lost_ = false, step_under_way_ = false, step_is_void_ = false, out_failed_ = false, poll_under_way_ = false,
       look_under_way_ = false;
  int in_flight_ = 0, load_attempts_ = 0, failures_leaving_ = 0, bad_inputs_ = 0;
  std::string_view reason_;
  std::string refusal_;  // what `reason_` sees where it is not a literal
  Code why_ = Code::failed_transfer;

  std::optional<PidLayout> layout_;
  std::array<std::uint8_t, 256> input_bytes_{};  // by report id; 0: no such report
  Arrangement arrangement_ = Arrangement::by_direction;
  std::array<std::uint8_t, 2> blocks_{};
  double duration_ = 0;  // s; endless, or within the range of the device's field

  glm::dvec2 wanted_{0};
  ForceGate gate_;
  bool pending_ = false;
  std::int64_t commanded_ = 0, heard_ = 0;  // when
  bool silent_ = false;
  std::array<std::int64_t, 2> refresh_at_{};
  std::array<std::int64_t, 2> started_{};
  std::int64_t look_at_ = 0;     // when to look for rivals, or for what they have left of ours
  std::uint8_t last_load_ = 0;   // the block that was given out last, as far as is known
  bool actuators_seen_ = false;  // enabled, in a report of the device's state
  std::array<bool, 2> plays_seen_{};
  std::optional<InputState> input_;
  std::optional<Telemetry> telemetry_;
  std::int64_t telemetry_at_ = 0;  // time of the next question
  PidSessionCounts counts_;
};

}  // namespace wale::hid
