#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/record/format.hpp"
#include "runtime/stage/device_figures.hpp"
#include "runtime/stage/session.hpp"
#include "schema/sentence.hpp"
#include "wale/recording.hpp"

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

/// Changes patches as recorded, and compares what the ticks give.
class Replaying final : public TickSink {
 public:
  explicit Replaying(const Recording& recording) : recording_(recording), programs_(recording.programs().size()) {
    table_.begin(PatchTable::Manner::together);
  }

  /// Serves all ticks. Throws `Error`, which `replay` returns.
  void run() {
    const RecordingHeader& header = recording_.header();
    RecordedDevice device(header.device);
    Record record;
    act_until(1);  // the patches that were there when the run began
    Player player(device, patches_, record, 1, header.most_newton, false, this);
    if (recording_.version() < recording_format::slewing_ends_when_passed) player.end_slewing_only_when_near();
    if (recording_.version() < recording_format::limit_counts_steps) player.disregard_steps();
    while (replay_.ticks < recording_.ticks()) {
      tick_ = recording_.tick(replay_.ticks);
      act_until(tick_.revision);
      device.become(tick_);
      player.serve({.period = static_cast<long>(tick_.period),
                    .elapsed = static_cast<long>(tick_.elapsed),
                    .skipped = static_cast<long>(tick_.skipped),
                    .lateness = tick_.lateness});
    }
  }

  void append(const RecordedTick& now) noexcept override {
    const auto known = number_of_slot_.find(now.patch);
    const std::uint32_t patch = known == number_of_slot_.end() ? now.patch : known->second;
    const std::array<Compared, 5> parts{{
        {"patch under the hand", {tick_.patch, tick_.inside}, {patch, now.inside}},
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
  using Kind = RecordedEvent::Kind;

  /// Makes all changes up to the hand-over of `revision`.
  void act_until(std::uint32_t revision) {
    while (revision_ < revision && acted_ < recording_.events().size()) act(recording_.events()[acted_++]);
  }

  const Program& program(std::size_t number) {
    std::optional<Program>& known = programs_[number];
    if (known) return *known;
    auto loaded = Program::load(recording_.programs()[number].bytes);
    if (!loaded) {
      Error error = std::move(loaded).error();
      error.sentence = sentence("program ", number, " of the recording cannot be run: ", error.sentence);
      throw error;
    }
    if (loaded->description().vibrates() != recording_.header().device.shaker.has_value())
      throw Error{
          .code = Code::other_device,
          .sentence = sentence("program ", number, " of the recording was built for ",
                               loaded->description().device.name, ", not for ", recording_.header().device.name),
          .mend = "copy the recording again; if it is as it was made, no replay is possible"};
    known = *std::move(loaded);
    return *known;
  }

  /// The patch of a recorded number.
  PatchName named(std::uint32_t number, const char* deed) const {
    const auto known = names_.find(number);
    if (known == names_.end()) damaged(deed, number, ", but there is no such patch");
    return known->second;
  }

  void want(PatchName name, std::optional<WantedPatch> placement) {
    std::vector<PatchTable::Wish> wishes;
    wishes.emplace_back(name, std::move(placement));
    table_.want(std::move(wishes));
  }

  /// Makes a change of a patch, which then counts as changed.
  void change(PatchName name, const StageState::Change& change, bool renew = false) {
    WantedPatch placement = *table_.wanted(name);
    if (auto done = change(placement); !done) throw std::move(done).error();
    want(name, std::move(placement));
    table_.touch(name, renew);
    table_.loosen(name, false);
  }

  void set(const RecordedEvent& event) {
    const PatchName name = named(event.patch, "a parameter was set of patch ");
    const auto& parameters = table_.wanted(name)->program.description().parameters;
    if (event.parameter >= parameters.size())
      damaged("parameter ", event.parameter, " of patch ", event.patch, " was set, but the patch has ",
              parameters.size());
    change(name, changes::set(parameters[event.parameter].name, event.value));
  }

  /// A patch as version 1 placed it.
  void add(const RecordedEvent& event) {
    WantedPatch placement(program(event.program), event.position, event.size, event.layer);
    if (event.kind == Kind::add) placement.parameters = parameters_of(event, placement.program);
    placement.order = table_.next_order();
    place(static_cast<std::uint32_t>(names_.size()), std::move(placement));
  }

  std::vector<float> parameters_of(const RecordedEvent& event, const Program& program) const {
    if (const std::size_t count = program.description().parameters.size(); count != event.parameters.size())
      damaged("a patch was placed with ", event.parameters.size(), " parameters, but its program has ", count);
    return event.parameters;
  }

  PatchName place(std::uint32_t number, WantedPatch placement) {
    const PatchName name = table_.reserve();
    names_[number] = name;
    number_of_slot_[name.number] = number;
    want(name, std::move(placement));
    return name;
  }

  void put(const RecordedEvent& event) {
    WantedPatch placement(program(event.program), event.position, event.size, event.layer, event.shape);
    placement.parameters = parameters_of(event, placement.program);
    placement.order = event.order;
    placement.enabled = event.enabled;
    const auto known = names_.find(event.patch);
    PatchName name;
    if (known == names_.end()) {
      name = place(event.patch, std::move(placement));
    } else {
      name = known->second;
      want(name, std::move(placement));
      if (event.changed || event.renewed) table_.touch(name, event.renewed);
    }
    table_.loosen(name, !event.sampled);
  }

  void remove(std::uint32_t number) {
    want(named(number, "a patch was removed that has the number "), std::nullopt);
    names_.erase(number);
  }

  void act(const RecordedEvent& event) {
    switch (event.kind) {
      case Kind::place:
        while (!names_.empty()) remove(names_.begin()->first);
        add(event);
        return;
      case Kind::add: add(event); return;
      case Kind::replace: {
        const Program& replacing = program(event.program);
        const PatchName name = named(event.patch, "a program was replaced of patch ");
        const auto replace = [&](WantedPatch& patch) -> Result<> {
          patch.replace(replacing);
          return {};
        };
        change(name, replace, true);
        return;
      }
      case Kind::set: set(event); return;
      case Kind::move: {
        const PatchName name = named(event.patch, "there was a move of patch ");
        WantedPatch placement = *table_.wanted(name);
        if (auto done = changes::move(event.position)(placement); !done) throw std::move(done).error();
        want(name, std::move(placement));
        return;
      }
      case Kind::put: put(event); return;
      case Kind::remove: remove(event.patch); return;
      case Kind::bound: table_.loosen(named(event.patch, "there was a bound of patch "), !event.sampled); return;
      case Kind::publish:
        table_.publish(patches_, nullptr);
        revision_ = event.revision;
        return;
      case Kind::end: return;
    }
  }

  const Recording& recording_;
  std::vector<std::optional<Program>> programs_;  // each is loaded at its first use
  BankCache banks_;
  PatchTable table_{banks_};
  Exchange<PlacedPatches> patches_;
  std::map<std::uint32_t, PatchName> names_;                         // by the recorded number
  std::unordered_map<std::uint32_t, std::uint32_t> number_of_slot_;  // the recorded number of a slot's patch
  std::size_t acted_ = 0;                                            // events
  std::uint32_t revision_ = 0;
  RecordedTick tick_;
  Replay replay_;
};

}  // namespace

Result<Replay> replay(const Recording& recording) {
  if (recording.ticks() == 0) return Replay{};
  if (auto sound = check_recorded_figures(recording.header().device); !sound) return std::move(sound).error();
  try {
    Replaying replaying(recording);
    replaying.run();
    return replaying.result();
  } catch (const Error& error) {
    return error;
  }
}

}  // namespace wale
