#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/device/falcon/torque_gate.hpp"
#include "runtime/device/outcome.hpp"

namespace wale::falcon {

/// The chip between USB and the Falcon's serial line.
constexpr std::uint16_t vendor = 0x0403, product = 0xcb48;
constexpr std::uint8_t out_endpoint = 0x02, in_endpoint = 0x81;
/// The size of the chip's packets; a read must not ask for more.
constexpr std::size_t most_usb_bytes = 64;
/// The chip's only interface.
constexpr std::uint8_t first_interface = 0;

/// A transfer that the session asks its caller to make.
struct Transfer {
  enum class Kind : std::uint8_t {
    control,  ///< request type 0x40 (vendor, out), index 0, no data
    write,    ///< bulk, to `out_endpoint`
    read      ///< bulk, `most_usb_bytes` at most from `in_endpoint`
  };

  Kind kind = Kind::control;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::array<std::uint8_t, most_usb_bytes> bytes{};
  std::uint8_t size = 0;

  std::span<const std::uint8_t> view() const noexcept { return {bytes.data(), size}; }
};

struct FalconSessionOptions {
  /// The bytes of the user's own firmware, loaded if the device runs none. Empty: there is none.
  std::vector<std::uint8_t> firmware;
  TorqueGate gate;  ///< every packet keeps within it; without limits no packet has torque
  /// s without a command after which the motors are let go: before a keeper does it for the same reason, after 0.1 s.
  double command_silence = 0.05;
  double answer_silence = 0.03;  ///< s without an answer after which the device is asked again
  int most_silences = 10;        ///< in a row; then the device is lost
  double stale_after = 0.02;  ///< s after which an answer no longer says where the handle is: then there is no torque
};

/// What a session has done since it was made.
struct FalconSessionCounts {
  long commands_sent = 0;     ///< packets with torques, homing included
  long answers = 0;           ///< valid answers
  long skipped_bytes = 0;     ///< bytes that belong to no answer
  long silences = 0;          ///< times that no answer came
  long overwritten = 0;       ///< commands that a newer one replaced before it was sent
  long command_silences = 0;  ///< times that no command came
  long firmware_chunks = 0;   ///< chunks sent and echoed
};

/// The protocol of a Novint Falcon, without USB: it gives the next transfers and takes their results. If the device
/// runs no firmware, it loads one. Then the encoders find their zeros, for which a person moves the handle through the
/// whole workspace. Then torques and encoder counts alternate strictly. There is no torque before all three encoders
/// are homed, without commands, and in the last packets.
///
/// The protocol knows no durations, so a Falcon whose process and keeper are killed together may keep pushing until it
/// is opened again or loses its power. The first packet that it gets here is therefore without torque.
///
/// One thread at a time. Times are microseconds of any steady clock.
class FalconSession {
 public:
  enum class State : std::uint8_t {
    setting_up,
    homing,  ///< it answers, and waits for somebody to move the handle
    running,
    leaving,  ///< sets the torques to 0
    over      ///< ended: `was_lost` and `reason` say why
  };

  explicit FalconSession(FalconSessionOptions options = {});

  State state() const noexcept { return state_; }
  /// Whether it ended, or is ending, for another reason than `stop`.
  bool was_lost() const noexcept { return lost_; }
  /// Why it was lost, a literal; empty while it is not.
  std::string_view reason() const noexcept { return reason_; }
  /// Whether it was lost because the device runs no firmware and none was given.
  bool wants_firmware() const noexcept { return wants_firmware_; }

  const FalconSessionCounts& counts() const noexcept { return counts_; }
  const std::optional<Answer>& answer() const noexcept { return answer_; }  ///< the newest
  std::int64_t heard() const noexcept { return heard_; }                    ///< when that came

  /// The transfer to make now, if any; the caller gives each to `finish` once it has ended. At most one write and one
  /// read are under way. Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  std::optional<Transfer> next(std::int64_t now) noexcept;

  /// `came_in` has the bytes of a read, the chip's two bytes of status included. Real-time.
  void finish(const Transfer& transfer, Outcome outcome, std::span<const std::uint8_t> came_in,
              std::int64_t now) noexcept;

  /// The torques from now on. Ignored unless running. Real-time.
  void command(const Torques& torques, std::int64_t now) noexcept;

  /// No command comes any more for now: no torque. Ends with the next command. Real-time.
  void hush() noexcept;

  /// Sends no torque, and ends the session then. Real-time.
  void stop() noexcept;

  /// Sends nothing more: another owns the device now. `reason` outlives the session. Real-time.
  void give_up(std::string_view reason) noexcept;
  /// The device cannot be used any more: it is let go, and the session ends. `reason` outlives the session. Real-time.
  void lose(std::string_view reason, Outcome outcome) noexcept;

  /// Whether the newest packet to the device, on its way or taken, has torques; and whether it has taken one without,
  /// after which none is on its way. Real-time.
  bool holds_force() const noexcept { return holds_force_; }
  bool is_slack() const noexcept { return !holds_force_ && !pending_ && !write_under_way_; }

 private:
  enum class Step : std::uint8_t {
    normal_mode,    // sets the serial line for the firmware
    probe,          // does any firmware answer?
    firmware_mode,  // sets the line for the loader
    hello,
    fast_mode,
    letter,
    chunk,
    normal_again,
    probe_again,
    loop,
    leave,
    none
  };

  std::span<const std::uint8_t> expected() const noexcept;
  bool is_loading() const noexcept { return step_ == Step::hello || step_ == Step::letter || step_ == Step::chunk; }
  bool take_echo(std::span<const std::uint8_t> bytes) noexcept;
  bool take_answers(std::span<const std::uint8_t> bytes, std::int64_t now) noexcept;
  Transfer written(std::int64_t now) noexcept;
  Torques allowed_torques(std::int64_t now) const noexcept;
  void answered(std::int64_t now) noexcept;
  void unanswered() noexcept;
  void go_to(Step step) noexcept;

  FalconSessionOptions options_;
  State state_ = State::setting_up;
  Step step_ = Step::normal_mode;
  std::size_t at_ = 0;       // of the step's control requests, or of the firmware's bytes
  std::size_t matched_ = 0;  // bytes of the expected answer
  bool control_under_way_ = false, write_under_way_ = false, read_under_way_ = false, expects_ = false;
  bool lost_ = false, wants_firmware_ = false, garbage_ = false;
  int silences_ = 0, farewells_ = 0;
  std::string_view reason_;

  Torques torques_{};
  bool pending_ = false, silent_ = true, holds_force_ = false;
  std::int64_t commanded_ = 0, asked_ = 0, heard_ = 0;
  AnswerReader reader_;
  std::optional<Answer> answer_;
  FalconSessionCounts counts_;
};

}  // namespace wale::falcon
