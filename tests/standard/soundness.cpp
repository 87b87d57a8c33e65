// The closed loop of the simulated joystick, with its quantisation and sampling, in the normal hand. Materials that
// hold a hand must leave it at rest.
#include "runtime/stage/velocity_filter.hpp"
#include "tests/standard/standard.hpp"
#include "wale/library.hpp"
#include "wale/simulated.hpp"

namespace wale::standard::soundness_test {
namespace {

struct Rested {
  double fastest = 0;    // m/s
  double wandering = 0;  // m
  glm::dvec2 place{0};
  double force = 0;  // N, at the end
};

/// A hand that moves from the centre to `there` (m) within half a second and then stays. It runs three seconds and
/// measures the last.
Rested rested(const Program& program, glm::dvec2 there) {
  const Library library;
  DeviceProfile profile;
  for (const auto& device : library.devices())
    if (device.profile.name == default_device) profile = device.profile;
  const auto person = *library.person();
  std::vector<TracePoint> way;
  for (int i = 0; i <= 50; ++i) {
    TracePoint point{};
    point.time = 0.01 * i;
    point.position = there * (0.02 * i);
    point.velocity = i < 50 ? there * 2.0 : glm::dvec2(0);
    way.push_back(point);
  }
  SimulatedJoystick stick(profile, person.hand, Motion(Trace{way, true}));
  VelocityFilter right(profile), up(profile);
  const double count = profile.workspace_diameter / profile.position_counts;
  Bank bank(program);
  Memory memory(program);
  Rested result;
  glm::dvec2 low(1), high(-1);
  for (int i = 0; i < 3 * 900; ++i) {
    stick.elapse(1);
    const Reading reading = stick.sample();
    Hand hand;
    hand.position = glm::dvec2(reading.counts) * count;
    hand.velocity = glm::dvec2(right(reading.counts.x, 1), up(reading.counts.y, 1)) * count * 900.0;
    hand.time = i * seconds_per_tick;
    if (i == 0) memory.enter(bank, hand);
    const Force force = tick(bank, memory, hand);
    stick.command(force);
    result.force = glm::length(force);
    if (i < 2 * 900) continue;
    result.fastest = std::max(result.fastest, glm::length(stick.velocity()));
    low = glm::min(low, stick.position());
    high = glm::max(high, stick.position());
  }
  result.wandering = glm::distance(low, high);
  result.place = stick.position();
  return result;
}

class AtRest : public testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {};

TEST_P(AtRest, TheHandIsStill) {
  const auto [module, name, parameters] = GetParam();
  for (const glm::dvec2 there : {glm::dvec2(0.03, 0.012), {0.026, -0.03}, {-0.035, 0.004}}) {
    const Rested at = rested(made(module, name, parameters), there);
    EXPECT_LT(at.fastest, 0.004) << there.x << " " << there.y;
    EXPECT_LT(at.wandering, 2e-4) << there.x << " " << there.y;  // four counts
  }
}

INSTANTIATE_TEST_SUITE_P(
    Standard, AtRest,
    testing::Values(std::tuple{"std.friction", "coulomb_friction", "coulomb: 2 N, stiffness: 700 N/m"},
                    std::tuple{"std.friction", "karnopp_friction", "static: 3 N, coulomb: 1.5 N, stiffness: 700 N/m"},
                    std::tuple{"std.friction", "dahl_friction", "coulomb: 2 N, stiffness: 700 N/m"},
                    std::tuple{"std.friction", "stribeck_friction", "static: 3 N, stiffness: 700 N/m"},
                    std::tuple{"std.nap", "napped_cloth", "against: 3 N, stiffness: 700 N/m"},
                    std::tuple{"std.nap", "brushed_pile", ""}, std::tuple{"std.paper", "crushable_paper", ""},
                    std::tuple{"std.wall", "wall", "stiffness: 1500 N/m, damping: 8 N s/m"},
                    std::tuple{"std.wall", "wall", "stiffness: 1500 N/m, damping: 0 N s/m"},
                    std::tuple{"std.wall", "post", ""}, std::tuple{"std.wall", "room", "width: 50 mm"},
                    std::tuple{"std.solid", "solid_noise", ""},
                    std::tuple{"std.detent", "detents", "strength: 3 N, spacing: 10 mm"},
                    std::tuple{"std.desktop", "menu", ""}, std::tuple{"std.desktop", "window_edge", ""},
                    std::tuple{"std.desktop", "push_button", ""}, std::tuple{"std.vibration", "fizz", ""},
                    std::tuple{"std.vibration", "grit", ""}, std::tuple{"std.weave", "plain_cloth", ""},
                    std::tuple{"std.mesh", "wire_mesh", ""}, std::tuple{"std.masonry", "bricks", ""}),
    [](const auto& each) { return std::string(std::get<1>(each.param)) + std::to_string(each.index); });

TEST(HeldBack, AWallStopsTheHandWhereItsSpringSays) {
  // The arm's 135 N/m pulls the hand to 40 mm; the wall's 900 N/m stops it behind 20 mm.
  const Rested at = rested(made("std.wall", "wall"), {0.04, 0});
  EXPECT_NEAR(at.place.x, 0.02 + 0.02 * 135 / (135 + 900), 4e-4);
}

TEST(HeldBack, FrictionKeepsTheHandShortOfItsTarget) {
  const Rested at = rested(made("std.friction", "coulomb_friction", "coulomb: 1.5 N"), {0.03, 0});
  EXPECT_GT(0.03 - at.place.x, 0.001);
  EXPECT_LT(0.03 - at.place.x, (1.5 + 0.2) / 135);
  EXPECT_GT(at.force, 0.1);
}

}  // namespace
}  // namespace wale::standard::soundness_test
