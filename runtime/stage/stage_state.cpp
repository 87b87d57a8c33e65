#include "runtime/stage/stage_state.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "schema/built_for.hpp"
#include "schema/closest_names.hpp"
#include "schema/name_text.hpp"

namespace wale {
namespace {

/// Six digits: enough for a person.
std::string six_digits(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr};
}

std::string in_its_own_unit(const Parameter& parameter, double value) {
  const std::string number = six_digits(value / parameter.unit_in_si);
  return parameter.unit.empty() ? number : number + " " + parameter.unit;
}

constexpr const char* no_profile = "make the stage with a device, or with the profile of one";
constexpr const char* place_in_m = "give m from the workspace's centre, as in 0.02";

Error no_ticks() {
  return wrong_moment("patch", "the run serves no ticks", "ask again later; a loop of one's own must go on meanwhile");
}

std::string shown(glm::vec2 place) { return six_digits(place.x) + ", " + six_digits(place.y); }

bool is_finite(glm::vec2 place) { return std::isfinite(place.x) && std::isfinite(place.y); }

Result<> check_size(PatchSize size) {
  constexpr const char* lengths = "give lengths in m, as in 0.05";
  if (!(std::isfinite(size.width) && size.width > 0 && std::isfinite(size.height) && size.height > 0))
    return malformed("size", "the width and height of a patch must be positive and finite", lengths,
                     "a positive width and height", six_digits(size.width) + ", " + six_digits(size.height));
  if (!(std::isfinite(size.rim) && size.rim >= 0))
    return malformed("size", "the rim of a patch must be finite and not negative", lengths, "a rim of 0 or more",
                     six_digits(size.rim));
  return {};
}

Result<> check_layer(float layer) {
  if (std::isfinite(layer)) return {};
  return malformed("layer", "the layer of a patch must be finite", "give any number; the greatest is in front",
                   "a finite number", six_digits(layer));
}

}  // namespace

[[gnu::noinline]] Error malformed(std::string_view name, std::string_view sentence, std::string_view mend,
                                  std::string_view expected, std::string_view found) {
  Error error{.code = Code::malformed_value};
  error.sentence = sentence, error.mend = mend, error.expected = expected, error.found = found;
  error.place.name = name, error.place.text = found;
  return error;
}

[[gnu::noinline]] Error wrong_moment(std::string_view name, std::string_view sentence, std::string_view mend) {
  Error error{.code = Code::wrong_moment};
  error.sentence = sentence, error.mend = mend, error.place.name = name;
  return error;
}

Error stage_is_gone() {
  return wrong_moment("stage", "the stage is gone",
                      "keep the stage for as long as its patches, edits and loops are used");
}

Error stage_was_moved() {
  return wrong_moment("stage", "the stage was moved from", "use the stage that it was moved to");
}

Error another_run() {
  return wrong_moment("stage", "another run is under way on this stage", "wait for its end, or stop it first");
}

Error patch_is_gone() { return wrong_moment("patch", "the patch is not on the stage any more", "add it again"); }

Result<std::shared_ptr<StageState>> here(std::shared_ptr<StageState> stage, Error (*gone)()) {
  if (!stage) return gone();
  if (stage->home.is_here()) return stage;
  return wrong_moment("stage", "the stage is the parent process's, and this is a child of its fork",
                      "make a stage and a device of the child's own");
}

Result<std::size_t> index_of(const Program& program, std::string_view parameter) {
  if (auto named = is_name_text("parameter", parameter, "write the name of one of the program's parameters"); !named) return std::move(named).error();
  if (const auto index = program.parameter(parameter)) return *index;
  std::string names;
  std::vector<std::string> known;
  for (const Parameter& one : program.description().parameters) {
    names += (names.empty() ? "" : ", ") + one.name;
    known.push_back(one.name);
  }
  return Error{.code = Code::unknown_name,
               .sentence = program.description().material + " has no parameter " + std::string(parameter),
               .mend = names.empty() ? "it has no parameters" : "it has " + names,
               .place = {.name = "parameter", .text = std::string(parameter)},
               .nearest = closest_names(parameter, known)};
}

StageState::StageState(std::unique_ptr<Device> own, Device* others, const DeviceProfile& of, StageOptions how)
    : owned(std::move(own)), device(owned ? owned.get() : others), profile(of), options(std::move(how)) {
  if (!options.record || options.record->file.empty()) return;
  // The process may be in another folder when the run begins, and go to another one during it.
  std::error_code why;
  const std::filesystem::path whole = std::filesystem::absolute(options.record->file, why);
  if (!why) options.record->file = whole.string();
}

Result<> StageState::has(PatchName name) const {
  if (over) return stage_is_gone();
  if (table.wanted(name) != nullptr) return {};
  if (table.is_reserved(name))
    return wrong_moment("patch", "the patch is not on the stage before the edit that adds it is committed",
                        "commit the edit first, or change the patch by calls of that edit");
  return patch_is_gone();
}

Result<> StageState::fits(const PatchProgram& program) const {
  const bool same_kind = program.vibrates() == profile.shaker.has_value();
  if (same_kind && program.device.name == profile.name) {
    auto built = is_built_for(program, profile);
    if (built) return built;
    Error error = std::move(built).error();
    error.place.name = "program";
    return error;
  }
  std::string sentence = program.material + " was built for " + program.device.name;
  const bool is_nameless = profile.name.empty() && (device != nullptr || has_profile);
  if (is_nameless)
    sentence += ", and the profile of the stage's device has no name";
  else if (same_kind)
    sentence += profile.name.empty() ? ", and the stage has no device" : ", and the device is " + profile.name;
  else
    sentence += std::string(program.vibrates() ? ", which vibrates, and " : ", which pushes, and ") + profile.name +
                (program.vibrates() ? " pushes" : " only vibrates");
  return Error{.code = Code::other_device,
               .sentence = std::move(sentence),
               .mend = is_nameless            ? "name the profile as the declaration that programs are built for"
                       : profile.name.empty() ? no_profile
                                              : "build it for " + profile.name,
               .place = {.name = "program", .text = program.device.name},
               .expected = profile.name.empty() ? std::string() : "a program for " + profile.name,
               .found = "one for " + program.device.name};
}

Result<WantedPatch> StageState::wanted(const Program& program, const PatchOptions& patch) const {
  if (auto fit = fits(program.description()); !fit) return std::move(fit).error();
  if (!is_finite(patch.at)) 
    return malformed("at", "the place of a patch must be finite", place_in_m, "two finite numbers", shown(patch.at));
  if (patch.size)
    if (auto good = check_size(*patch.size); !good) return std::move(good).error();
  if (auto good = check_layer(patch.layer); !good) return std::move(good).error();
  return WantedPatch(program, patch.at, patch.size.value_or(WantedPatch::own_size(program, patch.shape)), patch.layer,
                   patch.shape);
}

Result<> StageState::change(PatchName name, const Change& change) {
  const std::lock_guard lock(mutex);
  if (auto there = has(name); !there) return there;
  WantedPatch placement = *table.wanted(name);
  if (auto done = change(placement); !done) return done;
  std::vector<PatchTable::Wish> wishes;
  wishes.emplace_back(name, std::move(placement));
  want(std::move(wishes));
  return {};
}

void StageState::want(std::vector<PatchTable::Wish> wishes) {
  table.want(std::move(wishes));
  if (!running) return;
  news.notify_all();
  if (table.is_waiting()) work.notify_all();
}

Result<Bank> StageState::bank(PatchName name) const {
  std::optional<BankKey> key;
  {
    const std::lock_guard lock(mutex);
    if (auto there = has(name); !there) return std::move(there).error();
    key = table.wanted(name)->key();
  }
  return banks.get(*key)->bank;
}

Result<Placement> StageState::placement(PatchName name) const {
  const std::lock_guard lock(mutex);
  if (auto there = has(name); !there) return std::move(there).error();
  return table.wanted(name)->told();
}

Result<Placement> StageState::published(PatchName name) const {
  const std::lock_guard lock(mutex);
  if (auto there = has(name); !there) return std::move(there).error();
  const PatchTable::Felt felt = table.felt(name);
  // A run that has just begun has not had it yet.
  if (const WantedPatch* const as = felt.as != nullptr ? felt.as : felt.before) return as->told();
  return wrong_moment("patch", "no run has had the patch yet", "ask `placement` how it is wanted, or ask during a run");
}

Now StageState::now() const noexcept {
  const TickState state = outlets.state.load();
  Now now{.time = state.time,
          .ticks_run = state.ticks_run,
          .ticks_missed = state.ticks_missed,
          .lateness = state.lateness,
          .position = state.position,
          .velocity = state.velocity,
          .force = state.force,
          .inside = state.inside,
          .revision = state.revision,
          .guards = state.guards};
  if (state.inside)
    now.patch = Patch(std::const_pointer_cast<StageState>(shared_from_this()), state.number, state.generation);
  return now;
}

Result<Snapshot> StageState::snapshot(PatchName name) {
  using Clock = std::chrono::steady_clock;
  constexpr auto patience = std::chrono::milliseconds(200);
  constexpr auto pause = std::chrono::microseconds(300);
  const std::lock_guard one_at_a_time(asking);
  const auto began = Clock::now();
  for (std::uint32_t seen = 0;;) {
    PatchTable::Felt felt;
    std::optional<Placement> placed;
    {
      const std::lock_guard lock(mutex);
      if (auto there = has(name); !there) return std::move(there).error();
      felt = table.felt(name);
      if (felt.as != nullptr) placed = felt.as->told();
      const bool untouched = !served || (caller_serves && caller == std::this_thread::get_id()) || !felt.memory ||
                             (!felt.is_placed && seen >= felt.withdrawn && felt.withdrawn > 0);
      if (untouched) {
        const BankKey key = table.wanted(name)->key();
        const bool same = felt.memory && felt.bank && &felt.memory->program().decoded() == &key.program.decoded();
        if (same) {
          Memory copy(key.program);
          copy.copy_from(*felt.memory, 0, felt.memory->cells().size());
          return Snapshot{felt.bank->bank, std::move(copy), *std::move(placed)};
        }
        return Snapshot{banks.get(key)->bank, Memory(key.program), table.wanted(name)->told()};
      }
    }
    MemoryRequest request(name.number, name.generation, felt.memory->program());
    outlets.desk.ask(request);
    while (request.outcome.load(std::memory_order_acquire) == MemoryRequest::Outcome::open) {
      const bool ended = [&] {
        const std::lock_guard lock(mutex);
        return !served;
      }();
      if ((ended || Clock::now() - began > patience) && outlets.desk.take_back(request)) {
        if (ended) break;
        return no_ticks();
      }
      std::this_thread::sleep_for(pause);
    }
    if (request.outcome == MemoryRequest::Outcome::copied) return Snapshot{felt.bank->bank, std::move(request.copy), *std::move(placed)};
    seen = request.revision;
    if (Clock::now() - began > patience) return no_ticks();
    std::this_thread::sleep_for(pause);
  }
}

namespace changes {

StageState::Change set(std::string parameter, double value) {
  return [parameter = std::move(parameter), value](WantedPatch& patch) -> Result<> {
    const auto index = index_of(patch.program, parameter);
    if (!index) return index.error();
    const Parameter& range = patch.program.description().parameters[*index];
    const auto wanted = static_cast<float>(value);  // the range is one of floats
    if (!(wanted >= range.low && wanted <= range.high))
      return malformed(
          "value",
          range.name + " = " + in_its_own_unit(range, value) + " is not in its range " +
              in_its_own_unit(range, range.low) + " .. " + in_its_own_unit(range, range.high),
          range.si_unit.empty() ? "give a number in this range" : "give a value in this range, in " + range.si_unit,
          in_its_own_unit(range, range.low) + " .. " + in_its_own_unit(range, range.high),
          in_its_own_unit(range, value));
    patch.parameters[*index] = wanted;
    return {};
  };
}

StageState::Change move(glm::vec2 to) {
  return [to](WantedPatch& patch) -> Result<> {
    if (!is_finite(to))
      return malformed("to", "the position to which a patch is moved must be finite", place_in_m, "two finite numbers",
                       shown(to));
    patch.position = to;
    return {};
  };
}

StageState::Change resize(PatchSize size) {
  return [size](WantedPatch& patch) -> Result<> {
    if (auto good = check_size(size); !good) return good;
    patch.size = size;
    return {};
  };
}

StageState::Change enable(bool enabled) {
  return [enabled](WantedPatch& patch) -> Result<> {
    patch.enabled = enabled;
    return {};
  };
}

StageState::Change bring(float layer, PatchTable& orders) {
  return [layer, &orders](WantedPatch& patch) -> Result<> {
    if (auto good = check_layer(layer); !good) return good;
    patch.layer = layer;
    patch.order = orders.next_order();
    return {};
  };
}

StageState::Change replace(Program program, const StageState& stage) {
  return [program = std::move(program), &stage](WantedPatch& patch) -> Result<> {
    if (auto fit = stage.fits(program.description()); !fit) return fit;
    patch.replace(program);
    return {};
  };
}

}  // namespace changes
}  // namespace wale
