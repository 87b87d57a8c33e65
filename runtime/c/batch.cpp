#include "wale/batch.h"

#include <cmath>
#include <span>

#include "runtime/c/program.hpp"
#include "runtime/c/run.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/stage/front_most.hpp"
#include "schema/closest_names.hpp"
#include "schema/visible_text.hpp"
#include "wale/batch.hpp"

namespace wale::c {
namespace {

/// So many forces of a batch at most; they would be 512 GiB.
constexpr std::size_t most_forces = std::size_t{1} << 36;

Result<> is_sound(const WaleBatchOptions& given, const WaleVector* forces) {
  if (given.hands == 0 || given.ticks == 0)
    return about_argument("hands", "expected a hand and a tick at least", "set `hands` and `ticks`");
  if (given.ticks > most_forces || given.hands > most_forces / given.ticks)
    return about_argument("hands", "expected 2^36 forces at most", "run the batch in parts");
  if (given.position == nullptr)
    return about_argument("position", "expected an array, found NULL", "give a place for each hand and tick");
  if (given.setting_count > 0 && given.settings == nullptr)
    return about_argument("settings", "expected an array, found NULL", "set `setting_count` to 0");
  if (!(given.rim >= 0 && std::isfinite(given.rim)))
    return about_argument("rim", "expected a finite number that is not negative", "0 is no rim");
  if (given.time != nullptr)
    for (const double each : std::span(given.time, given.ticks))
      if (!std::isfinite(each)) return about_argument("time", "expected finite numbers", "give s for each tick");
  for (const WaleVector& each : std::span(given.position, given.hands * given.ticks))
    if (!std::isfinite(each.x) || !std::isfinite(each.y))
      return about_argument("position", "expected finite numbers", "give m from the patch's centre");
  struct Motion {
    const char* name;
    const WaleVector* rows;
    const char* mend;
  };
  const Motion motions[] = {{"velocity", given.velocity, "give m/s"},
                            {"raw_velocity", given.raw_velocity, "give m/s"},
                            {"acceleration", given.acceleration, "give m/s^2"},
                            {"raw_acceleration", given.raw_acceleration, "give m/s^2"},
                            {"workspace", given.workspace, "give m from the workspace's centre"}};
  for (const auto& [name, rows, mend] : motions)
    if (rows != nullptr)
      for (const WaleVector& each : std::span(rows, given.hands * given.ticks))
        if (!std::isfinite(each.x) || !std::isfinite(each.y))
          return about_argument(name, "expected finite numbers", mend);
  return is_given("forces", forces);
}

/// The parameters' values with the settings.
Result<std::vector<float>> parameters_of(const Program& program, const WaleBatchOptions& given) {
  std::vector<float> values = program.default_parameters();
  for (const WaleSetting& each : std::span(given.settings, given.setting_count)) {
    const auto name = read_name("settings", each.name, "write the name of one of the program's parameters");
    if (!name) return name.error();
    const auto index = program.parameter(*name);
    if (!index) {
      std::vector<std::string> known;
      std::string all;
      for (const Parameter& one : program.description().parameters) {
        known.push_back(one.name);
        all += (all.empty() ? "it has " : ", ") + one.name;
      }
      Error unknown = about_argument("settings", "the program has no parameter `" + visible_text(*name) + "`",
                                     all.empty() ? "it has no parameters" : all, Code::unknown_name);
      unknown.place.text = *name;
      unknown.nearest = closest_names(*name, known);
      return unknown;
    }
    if (!std::isfinite(each.value))
      return about_argument("settings", "expected a finite number for `" + *name + "`", "give it in SI units");
    values[*index] = static_cast<float>(each.value);
  }
  return values;
}

Result<PatchSize> size_of(const Program& program, const WaleBatchOptions& given) {
  if (given.width == 0 && given.height == 0) return program.default_size();
  constexpr const char* sides = "give m, as in 0.05; both sides 0 are the program's own size";
  for (const auto& [name, side] : {std::pair{"width", given.width}, std::pair{"height", given.height}})
    if (!(side > 0 && std::isfinite(side))) return about_argument(name, "expected a positive, finite side", sides);
  return PatchSize{given.width, given.height, given.rim};
}

/// The motions of a batch. What is not given is computed from the tick before.
class GivenMotions {
 public:
  GivenMotions(const WaleBatchOptions& given, double rate) : given_(given), rate_(rate) {}

  Hand hand(std::size_t row, std::size_t tick) const {
    const std::size_t at = row * given_.ticks + tick;
    const std::size_t since = tick > 0 ? at - 1 : at, before = tick > 1 ? at - 2 : since;
    const WaleVector* const raw = given_.raw_velocity;
    const glm::vec2 raw_velocity = raw != nullptr ? of(raw, at) : change(given_.position, since, at);
    const glm::vec2 raw_before = raw != nullptr ? of(raw, since)
                                 : tick > 1     ? change(given_.position, before, since)
                                                : glm::vec2(0);
    const glm::vec2 raw_acceleration =
        tick > 0 ? (raw_velocity - raw_before) * static_cast<float>(rate_) : glm::vec2(0);
    Hand hand{.position = of(given_.position, at), .raw_velocity = raw_velocity, .raw_acceleration = raw_acceleration};
    hand.velocity = given_.velocity != nullptr ? of(given_.velocity, at) : change(given_.position, since, at);
    if (given_.raw_acceleration != nullptr) hand.raw_acceleration = of(given_.raw_acceleration, at);
    hand.acceleration = given_.acceleration != nullptr ? of(given_.acceleration, at)
                        : given_.velocity != nullptr   ? change(given_.velocity, since, at)
                                                       : raw_of_positions(tick, before, since, at);
    hand.workspace = given_.workspace != nullptr ? of(given_.workspace, at) : hand.position;
    hand.time = given_.time != nullptr ? given_.time[tick] : static_cast<double>(tick) / rate_;
    hand.button = given_.button != nullptr && given_.button[at] != 0;
    return hand;
  }

 private:
  static glm::vec2 of(const WaleVector* all, std::size_t at) { return {all[at].x, all[at].y}; }
  /// What one tick changes, per second.
  glm::vec2 change(const WaleVector* all, std::size_t from, std::size_t to) const {
    return (of(all, to) - of(all, from)) * static_cast<float>(rate_);
  }
  /// The acceleration by the positions alone.
  glm::vec2 raw_of_positions(std::size_t tick, std::size_t before, std::size_t since, std::size_t at) const {
    if (tick == 0) return glm::vec2(0);
    const glm::vec2 earlier = tick > 1 ? change(given_.position, before, since) : glm::vec2(0);
    return (change(given_.position, since, at) - earlier) * static_cast<float>(rate_);
  }

  const WaleBatchOptions& given_;
  double rate_;
};

}  // namespace
}  // namespace wale::c

using namespace wale::c;

WaleCode wale_batch(const WaleProgram* program, const WaleBatchOptions* options, WaleVector* forces,
                    WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto given = is_given("options", options); !given) return given;
    const auto given = read_sized("options", options);
    if (!given) return given.error();
    if (auto sound = is_sound(*given, forces); !sound) return sound;
    const auto parameters = parameters_of(program->program, *given);
    if (!parameters) return parameters.error();
    const auto size = size_of(program->program, *given);
    if (!size) return size.error();
    const wale::Bank bank(program->program, *parameters, *size);
    const GivenMotions motions(*given, program->program.description().device.rate);
    const std::size_t ticks = given->ticks;
    const bool has_edge = program->program.description().device.has_position();
    wale::run_batch(bank, given->hands, static_cast<long>(ticks),
                    [&](std::size_t first, long tick, std::span<const wale::Force> last, std::span<wale::Hand> hands) {
                      const auto now = static_cast<std::size_t>(tick);
                      for (std::size_t i = 0; now > 0 && i < last.size(); ++i) {
                        const std::size_t at = (first + i) * ticks + now - 1;
                        const glm::vec2 hand(given->position[at].x, given->position[at].y);
                        const bool touches = !has_edge || wale::PatchOutline::holds(bank.size().width, bank.size().height, hand);
                        forces[at] = touches ? vector_of(last[i]) : WaleVector{};
                      }
                      for (std::size_t i = 0; now < ticks && i < hands.size(); ++i)
                        hands[i] = motions.hand(first + i, now);
                    });
    return {};
  });
}
