// Each pure prototype reads as itself and nothing else.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/compiler/compiling.hpp"
#include "tests/truth/reading_of.hpp"
#include "tests/truth/truth.hpp"

namespace wale::truth {
namespace {

struct Prototype {
  const char* name;
  const char* statements;
  std::vector<std::pair<Cue, Expected>> cues;
};

const std::vector<Prototype>& prototypes() {
  using enum Cue;
  static const std::vector<Prototype> all{
      {"texture",
       "force = vector(1 N * sin(2 * pi * x / 2.5 mm), 0 N)",
       {{amplitude, valued(1)}, {period, valued(2.5e-3)}, {orientation, valued(0)}, {roughness, valued(1)}}},
      {"bumps",
       "let s = (fract(x / 25 mm) - 0.5) / 0.1\n    force = vector(1 N * s * exp(0.5 - s^2 / 2), 0 N)",
       {{amplitude, valued(1)}, {period, valued(25e-3)}, {orientation, valued(0)}, {bumpiness, valued(1)}}},
      {"spring", "force = -50 N/m * hand", {{stiffness, valued(50)}}},
      {"wall",
       "force = vector(-600 N/m * max(0 mm, x - 20 mm), 0 N)",
       {{wall_stiffness, valued(600)}, {face, valued(20e-3)}}},
      {"viscosity", "force = -3 N s/m * velocity", {{viscosity, valued(3)}}},
      {"friction", "force = hold(-200 N s/m * velocity, 0.8 N)", {{friction, valued(0.8)}, {breakaway, open}}},
      {"mass", "force = -0.2 kg * acceleration", {{mass, valued(0.2)}}},
      {"vibration",
       "active 20 W\n    force = vector(1 N * sin(2 * pi * 120 Hz * time), 0 N)",
       {{vibration, valued(1)}, {vibration_rate, valued(120)}}},
      {"sway",
       "active 20 W\n    force = vector(1 N * sin(2 * pi * 2 Hz * time), 0 N)",
       {{sway, valued(1)}, {sway_rate, valued(2)}}},
      {"hill",
       "let from_top = hand / 8 mm\n    force = 2 N * exp(0.5 - dot(from_top, from_top) / 2) * from_top",
       {{bumpiness, some}, {amplitude, open}, {roughness, open}, {orientation, open}, {constant, open}}},
      {"constant", "force = vector(1 N, 0 N)", {{constant, valued(1)}}},
  };
  return all;
}

/// Those that do not read as themselves and nothing else today. Whoever mends one takes its name away.
const std::set<std::string>& known_to_be_mixed() {
  static const std::set<std::string> names{};
  return names;
}

TEST(Truth, EachPrototypeReadsAsItselfAndNothingElse) {
  std::string matrix = fmt::format("{:<12}", "");
  for (const CueRule& rule : cue_rules()) matrix += fmt::format("{:>12}", rule.name);
  for (const Prototype& prototype : prototypes()) {
    Truth truth;
    truth.waves.reset();
    for (const auto& [cue, expected] : prototype.cues) truth[cue] = expected;
    const Reading reading = reading_of(compiling::compiled(std::string("    ") + prototype.statements));
    const Judgement judgement = judge(truth, reading);
    matrix += fmt::format("\n{:<12}", prototype.name);
    for (std::size_t i = 0; i < cue_count; ++i) {
      const auto& value = reading.cues[i];
      const std::string text = value ? fmt::format("{:.3g}", cue_rules()[i].scale * *value) : ".";
      matrix += fmt::format("{:>12}", text + (judgement.verdicts[i] == Verdict::wrong ? " !" : "  "));
    }
    const bool mixed = known_to_be_mixed().contains(prototype.name);
    EXPECT_EQ(!judgement.right(), mixed) << prototype.name << (mixed ? " is pure now: take it off the list" : "");
  }
  fmt::print("{}\n! is not what the prototype has\n", matrix);
}

}  // namespace
}  // namespace wale::truth
