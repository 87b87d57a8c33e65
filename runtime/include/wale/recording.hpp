#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wale/device.hpp"
#include "wale/program.hpp"
#include "wale/shape.hpp"
#include "wale/record.hpp"

namespace wale {

/// The guards that stepped in on a tick, as a set of bits; `GuardCounts` counts them.
enum class GuardBit : std::uint32_t {
  not_a_number = 1 << 0,
  device_limit = 1 << 1,
  user_limit = 1 << 2,
  energy = 1 << 3,
  passivity = 1 << 4,
  slew = 1 << 5,
  overrun = 1 << 6,
  stale = 1 << 7,
  lost = 1 << 8,
  restored = 1 << 9,
  heat = 1 << 10,
};

/// One tick: the inputs, the program's force, and the outputs.
struct RecordedTick {
  static constexpr std::uint32_t no_patch = 0xffffffff;
  /// `counts` are within this, either way: a reading beyond it is a lost one (`Device::sample`).
  static constexpr int most_counts = 1 << 29;

  std::int64_t period = 0;          ///< its number since the run began, from 0
  std::int64_t lateness = 0;        ///< ns after its deadline
  std::uint32_t elapsed = 0;        ///< periods since the previous tick; for the first tick since period 0
  std::uint32_t skipped = 0;        ///< periods just before that nobody served
  glm::ivec2 counts{0};             ///< encoder, from the workspace's centre
  Contact contact = Contact::good;  ///< of the device
  bool button = false;
  bool inside = false;             ///< the hand was within a patch
  std::uint32_t patch = no_patch;  ///< its number
  std::uint32_t revision = 0;      ///< how often the patches on the stage had been handed over to the loop
  std::uint32_t guards = 0;        ///< `GuardBit`s
  glm::vec2 velocity{0};           ///< m/s, filtered
  Force wanted{0};                 ///< N, the program's; on a pad m/s^2 and Hz, as for the next two
  Force commanded{0};              ///< after the guards
  Force force{0};                  ///< exerted by the actuator
  Force interaction{0};            ///< N, from hand to handle over the period before; not-a-number where unknown
};

/// A change of the stage, and its position among the ticks.
struct RecordedEvent {
  enum class Kind : std::uint8_t {
    place,    ///< version 1: one patch replaces all patches: `program`, `position`, `size`
    add,      ///< version 1: one more patch: the same, and `layer`, `parameters`
    replace,  ///< version 1: another program for a patch: `patch`, `program`
    set,      ///< a parameter's value: `patch`, `parameter`, `value`
    move,     ///< another position for a patch: `patch`, `position`
    put,      ///< a patch as a whole, new or changed: all fields below but `parameter`, `value` and `revision`
    remove,   ///< `patch`
    bound,    ///< whether the bound of a patch's energy is the sampled one: `patch`, `sampled`
    publish,  ///< hands all changes so far over to the loop as `revision`
    end,      ///< the run is over: `ticks` in all
  };
  Kind kind = Kind::end;
  std::uint64_t ticks = 0;  ///< ticks done before it; it takes effect at the first tick of its revision
  std::uint32_t patch = 0;  ///< its number
  std::size_t program = 0;  ///< among `Recording::programs`
  glm::vec2 position{0};    ///< m
  PatchSize size;           ///< m
  float layer = 0;
  std::vector<float> parameters;  ///< SI, as the program lists them
  std::uint32_t parameter = 0;    ///< its index in the program
  float value = 0;                ///< SI
  std::uint32_t revision = 0;
  std::uint64_t order = 0;  ///< of the patch's arrival in its layer
  bool enabled = true;      ///< otherwise it is there and not felt
  bool changed = true;      ///< its program, parameters or size changed, so the force slews
  bool renewed = true;      ///< it has a new memory, which succeeds the one before if there is one
  bool sampled = true;      ///< otherwise its energy has the trivial bound until `bound` says so
  Shape shape;
};

/// A program of a recording.
struct RecordedProgram {
  std::uint64_t hash = 0;            ///< FNV-1a, 64 bits, of its bytes
  std::span<const std::byte> bytes;  ///< a `.wpp` file's
};

/// The conditions of a recorded run.
struct RecordingHeader {
  DeviceProfile device;    ///< with the rate and the filters' settings
  double most_newton = 0;  ///< the largest force that the user allowed; infinite without a limit
  bool virtual_time = false;
  std::string hand;  ///< what moved the handle, "simulated, lateral"; empty if that is not known
};

/// A file that a run made (`StageOptions::record`), complete or up to the moment when its process was killed.
/// Immutable; copies share it; any number of threads may use it at once. The format is runtime/record/RECORDING.md.
class Recording {
 public:
  /// Maps the file and checks its first `most_ticks` ticks and all events. Errors: `unreadable_file`, `newer_file`, and
  /// `damaged_file` for a file that is no recording, or that is damaged or cut short before that tick; the place is the
  /// file and the byte.
  static Result<Recording> open(const std::string& path, std::size_t most_ticks = SIZE_MAX);
  /// How many ticks of a file can be opened: all of a whole one, and of one that is damaged or cut short those before
  /// that place. For the `most_ticks` of `open` after `damaged_file`. The first 320 KiB hold the conditions and the first
  /// events: of a file cut there nothing is left. Reads the whole file. Errors: `unreadable_file`,
  /// `newer_file`, and `damaged_file` for a file that is no recording.
  static Result<std::size_t> intact(const std::string& path);
  /// The same for any bytes in memory. Errors call them `name`.
  static Result<Recording> read(std::vector<std::byte> bytes, const std::string& name,
                                std::size_t most_ticks = SIZE_MAX);

  const RecordingHeader& header() const;
  std::uint32_t version() const;  ///< of the file's format: what was recorded then replays by the rules of then
  std::size_t ticks() const;
  /// `number` below `ticks()`.
  RecordedTick tick(std::size_t number) const;
  /// In their order.
  const std::vector<RecordedEvent>& events() const;
  const std::vector<RecordedProgram>& programs() const;
  /// Whether the run came to its end. Otherwise its process was killed, or the disk was full.
  bool complete() const;

 private:
  struct Contents;
  explicit Recording(std::shared_ptr<const Contents> contents) : contents_(std::move(contents)) {}
  std::shared_ptr<const Contents> contents_;
};

/// The first difference between a replay and its recording.
struct ReplayDifference {
  std::size_t tick = 0;   ///< its number, from 0
  std::string_view what;  ///< "program's output": the first part of the tick that differs
  /// The values of the component, x or y, that differs more; either may be not-a-number.
  double recorded = 0, replayed = 0;
};

struct Replay {
  std::size_t ticks = 0;      ///< replayed
  std::size_t differing = 0;  ///< ticks that are not bit for bit as recorded
  std::optional<ReplayDifference> first;
  double largest_force = 0;  ///< the largest difference of the commanded force, N or m/s^2
};

/// Runs the recorded programs on the recorded counts, changes the stage at the recorded ticks, and compares bit for
/// bit: patch, filtered velocity, the program's force, the commanded force, the guards. The device gives its recorded
/// answers: counts, contact, and the actuator's force for each command. Errors: those of `Program::load` for the
/// recorded programs, and those of the stage for the recorded changes.
Result<Replay> replay(const Recording& recording);

/// The columns of `write_csv(Record)`, then those that only a recording has: raw counts, the program's force, the
/// force commanded, patch, revision, contact, and which guards stepped in, in words.
void write_csv(std::ostream& out, const Recording& recording);

/// The force as sound: WAV, 44.1 kHz, two channels of 32-bit floats, x on the left and y on the right, each tick's
/// force held until the next; 1 is the device's peak force. For a pad both channels are the vibration itself: a sine of
/// its amplitude and frequency, where 1 is its greatest acceleration. Error: `unwritable_file` if the sound is longer
/// than a WAV file holds (4 GiB); then nothing is written. The caller checks whether `out` took the bytes.
Result<> write_wav(std::ostream& out, const Recording& recording);

}  // namespace wale
