#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/stage/recorded_run.hpp"
#include "schema/sentence.hpp"
#include "wale/recording.hpp"
#include "wale/stage.hpp"

namespace wale {
namespace {

/// A device that gives the recorded answers.
class RecordedDevice final : public Device {
 public:
  explicit RecordedDevice(const DeviceProfile& profile) : profile_(profile) {}

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override {
    return {.counts = tick_.counts, .interaction = tick_.interaction, .button = tick_.button, .contact = tick_.contact};
  }
  Force command(Force) noexcept override { return tick_.force; }

  void become(const RecordedTick& tick) noexcept { tick_ = tick; }

 private:
  DeviceProfile profile_;
  RecordedTick tick_;
};

/// A part of a tick, as recorded and as replayed.
struct Compared {
  std::string_view what;
  glm::dvec2 recorded, replayed;

  /// Bit for bit, not-a-number included.
  bool same(int axis) const noexcept {
    return std::bit_cast<std::uint64_t>(recorded[axis]) == std::bit_cast<std::uint64_t>(replayed[axis]);
  }
  bool same() const noexcept { return same(0) && same(1); }
  /// The component that differs more.
  int worse() const noexcept {
    if (same(0) || same(1)) return same(0) ? 1 : 0;
    return std::abs(recorded.y - replayed.y) > std::abs(recorded.x - replayed.x) ? 1 : 0;
  }
};

/// Changes a stage as recorded, and compares what its ticks give.
class Replaying final : public RecordedRun {
 public:
  Replaying(const Recording& recording, RecordedDevice& device, Stage& stage)
      : recording_(recording), device_(device), stage_(stage), programs_(recording.programs().size()) {}

  /// Makes all changes of the stage up to the hand-over of `revision`. Throws `Error`, which `replay` returns.
  void act_until(std::uint32_t revision) {
    while (revision_ < revision && acted_ < recording_.events().size()) act(recording_.events()[acted_++]);
  }

  std::optional<Beat> next() override {
    if (replay_.ticks == recording_.ticks()) return std::nullopt;
    tick_ = recording_.tick(replay_.ticks);
    act_until(tick_.revision);
    device_.become(tick_);
    return Beat{.period = static_cast<long>(tick_.period),
                .elapsed = static_cast<long>(tick_.elapsed),
                .skipped = static_cast<long>(tick_.skipped),
                .lateness = tick_.lateness};
  }

  void append(const RecordedTick& now) noexcept override {
    const std::array<Compared, 5> parts{{
        {"patch under the hand", {tick_.patch, tick_.inside}, {now.patch, now.inside}},
        {"filtered velocity", tick_.velocity, now.velocity},
        {"program's output", tick_.wanted, now.wanted},
        {"commanded output", tick_.commanded, now.commanded},
        {"set of guards that stepped in", {tick_.guards, 0}, {now.guards, 0}},
    }};
    const auto part = std::find_if(parts.begin(), parts.end(), [](const Compared& each) { return !each.same(); });
    if (part != parts.end()) {
      ++replay_.differing;
      const int axis = part->worse();
      if (!replay_.first) replay_.first = {replay_.ticks, part->what, part->recorded[axis], part->replayed[axis]};
      const glm::dvec2 apart = glm::dvec2(tick_.commanded) - glm::dvec2(now.commanded);
      replay_.largest_force = std::max({replay_.largest_force, std::abs(apart.x), std::abs(apart.y)});
    }
    ++replay_.ticks;
  }

  const Replay& result() const { return replay_; }

 private:
  static void require(const Result<>& done) {
    if (!done) throw done.error();
  }

  const Program& program(std::size_t number) {
    std::optional<Program>& known = programs_[number];
    if (!known) {
      auto loaded = Program::load(recording_.programs()[number].bytes);
      if (!loaded) {
        Error error = std::move(loaded).error();
        error.sentence = sentence("program ", number, " of the recording cannot be run: ", error.sentence);
        throw error;
      }
      known = *std::move(loaded);
    }
    return *known;
  }

  void set(std::size_t patch, std::size_t parameter, float value) {
    if (patch >= placed_.size()) damaged("a parameter of patch ", patch, " was set, but there is no such patch");
    const auto& parameters = program(placed_[patch]).description().parameters;
    if (parameter >= parameters.size())
      damaged("parameter ", parameter, " of patch ", patch, " was set, but the patch has ", parameters.size());
    require(stage_.set(patch, parameters[parameter].name, value));
  }

  void act(const RecordedEvent& event) {
    switch (event.kind) {
      case RecordedEvent::Kind::place:
        stage_.place(program(event.program), event.position, event.size);
        placed_ = {event.program};
        return;
      case RecordedEvent::Kind::add: {
        const Program& added = program(event.program);
        const std::vector<float> defaults = added.default_parameters();
        if (defaults.size() != event.parameters.size())
          damaged("patch ", placed_.size(), " was placed with ", event.parameters.size(),
                  " parameters, but its program has ", defaults.size());
        stage_.add(added, event.position, event.size, event.layer);
        placed_.push_back(event.program);
        for (std::size_t i = 0; i < defaults.size(); ++i)
          if (event.parameters[i] != defaults[i]) set(placed_.size() - 1, i, event.parameters[i]);
        return;
      }
      case RecordedEvent::Kind::replace:
        require(stage_.replace(event.patch, program(event.program)));
        placed_[event.patch] = event.program;
        return;
      case RecordedEvent::Kind::set: set(event.patch, event.parameter, event.value); return;
      case RecordedEvent::Kind::move: require(stage_.move(event.patch, event.position)); return;
      case RecordedEvent::Kind::publish: revision_ = event.revision; return;
      case RecordedEvent::Kind::end: return;
    }
  }

  const Recording& recording_;
  RecordedDevice& device_;
  Stage& stage_;
  std::vector<std::optional<Program>> programs_;  // each is loaded at its first use
  std::vector<std::size_t> placed_;               // the program of each patch
  std::size_t acted_ = 0;                         // events
  std::uint32_t revision_ = 0;
  RecordedTick tick_;
  Replay replay_;
};

}  // namespace

Result<Replay> replay(const Recording& recording) {
  if (recording.ticks() == 0) return Replay{};
  const RecordingHeader& header = recording.header();
  RecordedDevice device(header.device);
  Stage stage(device);
  Replaying replaying(recording, device, stage);
  try {
    replaying.act_until(1);  // the patches that were there when the run began
    const auto run = stage.run({.seconds = 1, .most_newton = header.most_newton, .recorded = &replaying});
    if (!run) return run.error();
  } catch (const Error& error) {
    return error;
  }
  return replaying.result();
}

}  // namespace wale
