// Promise 3 for every map that can set a level, on every force device. The device's rule renders the percept, and the
// simulated hand explores it. The carrier's size is measured from the actuator's force, and the published law, written
// independently here, gives the level back within one step of the device's force.

#include "tests/promises/exploring.hpp"

namespace wale::promises::every_map_test {
namespace {

using std::numbers::pi;
using Ticks = std::vector<TickRecord>;

/// level = (size / one)^exponent. The source of each exponent stands beside it. `one` is the size of the percept's
/// reference stimulus (schema/percepts.wale) in SI units.
struct PublishedLaw {
  const char* map;
  const char* percept;
  double one, exponent;

  double level_of(double size) const { return std::pow(std::max(size, 0.0) / one, exponent); }
  double size_of(double level) const { return one * std::pow(level, 1 / exponent); }
};

const std::vector<PublishedLaw> laws = {
    {"minsky1995.figure19", "roughness", 194 * 10.0 / 512, 0.759593},  // Minsky 1995, figure 19 and table 6
    {"estimates.bumps", "bumpiness", 3, 0.76},                         // assumed equal to that of roughness
    {"estimates.crispness", "crispness", 8, 1},                        // assumed linear
    {"harper1964.squeezing", "hardness", 1000, 0.8},                   // Stevens's table, hardness
    {"smith1996.line", "stickiness", 1, 1},                            // linear, r = 0.85
    {"stevens1975.lifting", "heaviness", 0.2, 1.45},                   // Stevens's table, lifted weights
    {"stevens1975.vibration_60", "vibration", 2, 0.95},                // Stevens's table, 60 Hz
    {"verrillo1970.hand", "vibration", 2, 0.89},                       // Verrillo 1970
    {"stevens1964.stirring", "viscosity", 10, 0.44},                   // Stevens and Guirao 1964: 0.42 .. 0.46
    {"varadharajan2008.spring", "springiness", 200, 1},                // linear
};

/// Maps that set no level, with the reason. A map that is not tied to the reference stimulus only orders, and a map of
/// another quantity than the carrier has nothing to set. Maps of pads have no force at a handle;
/// tests/calibration/pads.cpp tests them.
const std::map<std::string, std::string> skipped = {
    {"minsky1995.without_earplugs", "not tied"},
    {"minsky1995.with_earplugs", "not tied"},
    {"kornbrot2007.groove", "not of the carrier"},
    {"lederman1972.finger_force", "not of the carrier"},
    {"unger2013.power", "not of the carrier"},
    {"lawrence2000.rate_hardness", "not of the carrier"},
    {"han_choi2010.extended_rate_hardness", "not of the carrier"},
    {"estimates.shaken_roughness", "of a pad"},
    {"estimates.shaken_vibration", "of a pad"},
};

std::string reason_to_skip(const Map& map) {
  if (map.from == "shaking") return "of a pad";
  return !map.of_carrier ? "not of the carrier" : !map.tied ? "not tied" : "";
}

TEST(EveryMap, IsTestedOrSkippedWithAReason) {
  std::size_t tested = 0;
  for (const Map* map : common_modules()->declarations.maps()) {
    const bool has_law = std::ranges::any_of(laws, [&](const auto& law) { return map->name == law.map; });
    EXPECT_EQ(has_law, reason_to_skip(*map).empty()) << map->name << " needs its law here";
    if (has_law) {
      ++tested;
    } else {
      EXPECT_EQ(skipped.count(map->name), 1u) << map->name;
      if (skipped.count(map->name)) {
        EXPECT_EQ(reason_to_skip(*map), skipped.at(map->name)) << map->name;
      }
    }
  }
  EXPECT_EQ(tested, laws.size());
  EXPECT_GE(force_devices().size(), 2u);
}

// How each carrier is explored.

constexpr double face = 20e-3;  // m, of the walls that `firm` and `crisp` put up

/// Half of the hand's range, in m: 40 mm on larger devices, and less on smaller ones.
double reach_on(const DeviceProfile& device) { return std::min(40e-3, 0.3 * device.workspace_diameter); }

/// The resistance to a hand at constant speed, from the settled part of each pass.
struct Steady {
  double force = 0, speed = 0;  // N against the motion, m/s by the encoder
};

Steady steadily(const Ticks& ticks, double half, double speed) {
  Steady steady;
  std::size_t passes = 0;
  for (std::size_t from = 0; from < ticks.size();) {
    // The part from 20 % to 80 % of the half range, in one direction.
    const double way = ticks[from].velocity.x > 0 ? 1 : -1;
    std::size_t to = from;
    while (to < ticks.size() && ticks[to].velocity.x * way > 0) ++to;
    double against = 0;
    std::size_t first = to, last = from, count = 0;
    for (std::size_t i = from; i < to; ++i)
      if (ticks[i].position.x * way > 0.2 * half && ticks[i].position.x * way < 0.8 * half) {
        first = std::min(first, i), last = i, ++count;
        against -= way * ticks[i].force.x;
      }
    if (count > 50) {
      steady.force += against / static_cast<double>(count);
      steady.speed +=
          std::abs(ticks[last].position.x - ticks[first].position.x) / (ticks[last].time - ticks[first].time);
      ++passes;
    }
    from = std::max(to, from + 1);
  }
  if (passes < 4) throw std::runtime_error("too few passes at " + std::to_string(speed) + " m/s");
  return {steady.force / static_cast<double>(passes), steady.speed / static_cast<double>(passes)};
}

/// The negated slope of force against a quantity of the hand, over the ticks that `counts`, by a fit with an intercept.
template <typename Of, typename Counts>
FeltSize resistance_to(const Ticks& ticks, Of of, Counts counts) {
  double n = 0, u = 0, f = 0, uu = 0, uf = 0;
  for (const TickRecord& tick : ticks)
    if (counts(tick)) {
      const double at = of(tick), force = tick.force.x;
      n += 1, u += at, f += force, uu += at * at, uf += at * force;
    }
  const double spread = (uu - u * u / n) / n;
  return {-(uf - u * f / n) / n / spread, 1 / std::sqrt(spread)};
}

/// The complex amplitude of the component at `rate` (Hz), over whole periods.
template <typename Of>
std::complex<double> component(const Ticks& ticks, double rate, Of of) {
  const double step = ticks[1].time - ticks[0].time;
  const double periods = std::floor(static_cast<double>(ticks.size()) * step * rate);
  const auto count = static_cast<std::size_t>(std::lround(periods / rate / step));
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += of(ticks[i]) * std::polar(1.0, -2 * pi * rate * ticks[i].time);
  return 2.0 * sum / static_cast<double>(count);
}

double force_x(const TickRecord& tick) { return tick.force.x; }
double position_x(const TickRecord& tick) { return tick.position.x; }

FeltSize felt_size(const PublishedLaw& law, const Program& program, const std::map<std::string, float>& set) {
  const std::string percept = law.percept;
  const double half = reach_on(program.description().device);
  const auto explore = [&](const Motion& motion, double seconds) { return explored(program, motion, seconds, set); };
  if (percept == "roughness" || percept == "bumpiness")
    return largest_force(explore(Lateral{half, 1}, 3.5), program.default_size());
  if (percept == "viscosity") {
    const Steady steady = steadily(explore(steady_strokes(half, 0.1, 6), 6), half, 0.1);
    return {steady.force / steady.speed, 1 / steady.speed};
  }
  if (percept == "stickiness") return {steadily(explore(steady_strokes(half, 0.25, 3), 3), half, 0.25).force, 1};
  if (percept == "springiness")
    return resistance_to(explore(Lateral{half, 1}, 2.5), position_x, [](const TickRecord&) { return true; });
  if (percept == "hardness")
    return resistance_to(explore(Lateral{half, 0.5}, 4.5), position_x,
                         [](const TickRecord& tick) { return tick.inside && tick.position.x > face; });
  if (percept == "crispness")
    return resistance_to(
        explore(Lateral{half, 1}, 3.5), [](const TickRecord& tick) { return tick.velocity.x; },
        [](const TickRecord& tick) { return tick.inside && tick.position.x > face && tick.velocity.x > 0; });
  if (percept == "heaviness") {
    const Ticks ticks = explore(Lateral{half, 1}, 4.5);
    const double acceleration = 4 * pi * pi * std::abs(component(ticks, 1, position_x));
    return {std::abs(component(ticks, 1, force_x)) / acceleration, 1 / acceleration};
  }
  if (percept == "vibration") {
    const double rate = std::string(law.map) == "stevens1975.vibration_60" ? 60 : 120;
    return {std::abs(component(explore(Rest{}, 1.5), rate, force_x)), 1};
  }
  throw std::runtime_error("there is no exploration for " + percept);
}

constexpr double by_default = 0.5;
/// Steps up to the largest force, as on the thesis's joystick. USB joysticks have sixteen times as many, but encoder
/// and rate do not resolve speeds and accelerations that finely.
constexpr double finest_steps = 2048;

std::string material_of(const PublishedLaw& law) {
  const std::string asked = std::string("perceptual { ") + law.percept + " 0.5, by " + law.map + " }";
  // The law at 60 Hz needs another rate than that of the device's rule.
  const bool other_rate = std::string(law.map) == "stevens1975.vibration_60";
  return "material m { " + asked + (other_rate ? "\nphysical { active 0.5 W\nforce = vibrate(rate: 60 Hz) }" : "") +
         " }\n";
}

TEST(EveryMap, GivesTheLevelBackFromTheForceAtTheHandle) {
  struct Case {
    const PublishedLaw* law;
    DeviceProfile device;
  };
  std::vector<Case> cases;
  for (const PublishedLaw& law : laws)
    for (const DeviceProfile& device : force_devices()) cases.push_back({&law, device});
  std::atomic<int> read = 0;
  on_two_threads(cases.size(), [&](std::size_t i) {
    const PublishedLaw& law = *cases[i].law;
    const DeviceProfile& device = cases[i].device;
    const auto declarations = common_modules();
    const Map* map = nullptr;
    for (const Map* each : declarations->declarations.maps())
      if (each->name == law.map) map = each;
    if (!map) return;
    const Program program = compiled_for(device.name, material_of(law));
    const double exerts = declarations->declarations.percepts.find(law.percept)->exerts;
    for (const double level : {0.2, 0.4, by_default, 0.6, 0.8, 1.0}) {
      const double size = law.size_of(level);
      if (size < map->valid_low || size > map->valid_high || size * exerts > device.force_newton) continue;
      std::map<std::string, float> set;
      if (level != by_default) set = {{law.percept, static_cast<float>(level)}};
      const FeltSize felt = felt_size(law, program, set);
      const double step = felt.per_newton * device.force_newton / std::min(device.force_counts, finest_steps);
      const double worth = std::max(law.level_of(size + step) - level, level - law.level_of(size - step));
      EXPECT_NEAR(law.level_of(felt.size), level, worth)
          << law.map << " on " << device.name << ": " << felt.size << " for " << size << ", a step " << step;
      ++read;
    }
  });
  EXPECT_GE(read, 70);
}

}  // namespace
}  // namespace wale::promises::every_map_test
