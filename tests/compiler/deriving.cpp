// Materials made from materials: instances, `like`, `between` and blends.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "compiler/measure/measure.hpp"
#include "tests/compiler/compiling.hpp"

namespace wale::compiling::deriving_test {
namespace {

const char* const base = R"(wale 1
material ribbed {
  representative { kind fabric.woven }
  perceptual { roughness 0.6 }
  physical {
    param wale = 2.5 mm in 1 mm .. 5 mm
    param drag = 2 N s/m in 0 N s/m .. 8 N s/m
    height ribs = grating(x, period: wale)
    force texture = lateral(ribs)
    force syrup = viscous(drag)
  }
}
)";

Hand somewhere(std::mt19937& random) {
  const auto uniform = [&] { return static_cast<float>(random() / 2147483648.0 - 1); };
  return {{0.06f * uniform(), 0.06f * uniform()}, {0.3f * uniform(), 0.3f * uniform()}};
}

/// Expects the same force of both programs, in N, at 500 random hands.
void expect_same(const Program& a, const Program& b, double tolerance = 0) {
  Bank one(a), other(b);
  std::mt19937 random(7);
  for (int i = 0; i < 500; ++i) {
    const Hand hand = somewhere(random);
    const Force p = tick(one, hand), q = tick(other, hand);
    ASSERT_NEAR(p.x, q.x, tolerance);
    ASSERT_NEAR(p.y, q.y, tolerance);
  }
}

/// Expects that material `name` of `base` and `more` has the same force as the only material of `written_out`.
void expect_means(const std::string& more, const std::string& name, const std::string& written_out,
                  double tolerance = 0) {
  const Compiled made(std::string(base) + more), plain("wale 1\n" + written_out);
  expect_same(made.programs.at(name), plain.only(), tolerance);
}

TEST(Instances, AreTheSameWithOtherDefaults) {
  expect_means("material fine = ribbed(wale: 1.2 mm, drag: 0 N s/m)", "fine", R"(material m {
  perceptual { roughness 0.6 }
  physical {
    param wale = 1.2 mm in 1 mm .. 5 mm
    force = lateral(grating(x, period: wale)) + viscous(0 N s/m)
  }
})");
  const Compiled made(std::string(base) + "material fine = ribbed(wale: 1.2 mm)");
  const auto& parameters = made.programs.at("fine").description().parameters;
  EXPECT_FLOAT_EQ(parameters[0].value, 1.2e-3f);
  EXPECT_FLOAT_EQ(parameters[0].high, 5e-3f);
}

TEST(Instances, MayBlocksFollow) {
  expect_means("material soft = ribbed(drag: 1 N s/m) { perceptual { roughness 0.3 } }", "soft", R"(material m {
  perceptual { roughness 0.3 }
  physical { force = lateral(grating(x, period: 2.5 mm)) + viscous(1 N s/m) }
})");
}

TEST(Like, ReplacesTheDeclarationsThatItRepeats) {
  expect_means(R"(material crossed {
  representative { like ribbed }
  perceptual { roughness 0.5 }
  physical {
    param tilt = 30 deg in 0 deg .. 90 deg
    height ribs = grating(rotate(hand, tilt).y, period: wale)
    force syrup = viscous(2 * drag)
    force wind = vector(0.1 N, 0 N)
  }
})",
               "crossed", R"(material m {
  perceptual { roughness 0.5 }
  physical {
    force = lateral(grating(rotate(hand, 30 deg).y, period: 2.5 mm)) + viscous(4 N s/m) + vector(0.1 N, 0 N)
  }
})",
               2e-5);
}

TEST(Like, AWholeForceReplacesAllLayers) {
  expect_means(R"(material bare {
  representative { like ribbed }
  physical { force = lateral(ribs) }
})",
               "bare", R"(material m {
  perceptual { roughness 0.6 }
  physical { force = lateral(grating(x, period: 2.5 mm)) }
})");
}

TEST(Like, TakesOverTheKind) {
  const Compiled made(std::string(base) + "material other { representative { like ribbed } }");
  const auto& entries = made.programs.at("other").description().layers.representative;
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].first, "kind");
  EXPECT_EQ(entries[0].second.front(), "fabric.woven");
}

TEST(Between, LeadsFromOneSettingToAnother) {
  const Compiled made(std::string(base) + R"(
material fine = ribbed(wale: 1 mm, drag: 0 N s/m) { perceptual { roughness 0.2 } }
material middle = between(fine, ribbed, 0.25)
material again = between(middle, ribbed, 0.5)
)");
  const auto& parameters = made.programs.at("middle").description().parameters;
  EXPECT_FLOAT_EQ(parameters[0].value, 1.375e-3f);
  EXPECT_FLOAT_EQ(parameters[1].value, 0.5f);
  EXPECT_FLOAT_EQ(parameters[2].value, 0.3f);  // the level
  EXPECT_FLOAT_EQ(made.programs.at("again").description().parameters[0].value, 1.9375e-3f);
}

TEST(Blends, AddForcesByWeight) {
  expect_means(R"(
material a { physical { param k = 20 N/m in 1 N/m .. 50 N/m
 force = spring(k) + viscous(3 N s/m) } }
material b { physical { param k = 8 N/m in 1 N/m .. 50 N/m
 force = lateral(grating(y, period: 3 mm), amplitude: 1.5 N) - k * hand } }
material mixed = 0.7 a + 30 % b
)",
               "mixed", R"(material m { physical {
  force = 0.7 * (spring(20 N/m) + viscous(3 N s/m)) + 0.3 * (lateral(grating(y, period: 3 mm), amplitude: 1.5 N) - 8 N/m * hand)
} })",
               2e-5);
  const Compiled made(std::string(base) + R"(
material a { physical { param k = 20 N/m in 1 N/m .. 50 N/m
 force = spring(k) } }
material b { physical { param k = 8 N/m in 1 N/m .. 50 N/m
 force = spring(k) } }
material mixed = 0.7 a + 0.3 * b(k: 9 N/m)
)");
  const auto& parameters = made.programs.at("mixed").description().parameters;
  std::vector<std::string> names;
  for (const auto& parameter : parameters) names.push_back(parameter.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a_weight", "b_weight", "k", "b_k"}));
  EXPECT_FLOAT_EQ(parameters[3].value, 9);
}

TEST(Blends, MixOpenTexturesAndSolveTheirAmplitudeAgain) {
  const Compiled made(std::string(base) + R"(
material ringed { perceptual { roughness 0.2 }
 physical { height rings = 1 mm * grating(length(hand), period: 4 mm)
  force = lateral(rings) } }
material mixed = 0.75 ribbed + 0.25 ringed
)");
  const Program& mixed = made.programs.at("mixed");
  // Percepts mix in magnitude, in which levels are linear: 0.75 * 0.6 + 0.25 * 0.2 = 0.5.
  // The amplitude is that of the level: (F / 194 pu)^0.759593 = 0.5, F at the 99th percentile over the patch.
  std::vector<float> values = mixed.default_parameters();
  values[*mixed.parameter("drag")] = 0;
  Bank bank(mixed, values, mixed.default_size());
  EXPECT_NEAR(predict(bank, 0, wale::amplitude(bank, 0)).level, 0.5, 1e-5);
  const double amplitude = 194 * 10.0 / 512 * std::pow(0.5, 1 / 0.759593);
  EXPECT_NEAR(wale::amplitude(bank, 0), amplitude, 2e-4 * amplitude);
  EXPECT_NEAR(measure(bank).p99_newton, amplitude, 0.02 * amplitude);
  // Its shape is that of both textures' forces, each by its weight in units of its own amplitude.
  Bank ribs(made.programs.at("ribbed"), std::vector<float>{2.5e-3f, 0, 0.6f}, mixed.default_size());
  Bank rings(made.programs.at("ringed"));
  const double rib_amplitude = wale::amplitude(ribs, 0), ring_amplitude = wale::amplitude(rings, 0);
  std::mt19937 random(3);
  double scale = 0;
  for (int i = 0; i < 300; ++i) {
    Hand hand = somewhere(random);
    hand.velocity = {};
    const Force sum = tick(ribs, hand) * static_cast<float>(0.75 / rib_amplitude) +
                      tick(rings, hand) * static_cast<float>(0.25 / ring_amplitude);
    const Force force = tick(bank, hand);
    if (glm::length(sum) > 0.7 || glm::length(sum) < 0.2) continue;  // not limited, and well above rounding
    if (scale == 0) scale = glm::length(force) / glm::length(sum);
    // Where one of the textures is limited, the sum of the limited forces differs a little.
    EXPECT_NEAR(force.x, scale * sum.x, 0.06) << i;
    EXPECT_NEAR(force.y, scale * sum.y, 0.06) << i;
  }
}

/// Weights and levels set at run time give the same force and level as a file with these weights and levels.
TEST(Blends, FollowWeightsAndComponentLevelsAtRunTime) {
  const std::string parts = std::string(base) + R"(
material ringed { perceptual { roughness 0.2 }
 physical { height rings = 1 mm * grating(length(hand), period: 4 mm)
  force = lateral(rings) + viscous(2 N s/m) } }
material pulled { physical { force = spring(30 N/m) } }
)";
  const Compiled live(parts +
                      "material mixed = 0.5 ribbed + 0.4 ringed + 0.1 pulled\nmaterial all = mixed + 0.2 ribbed");
  const Compiled written(parts + R"(
material soft = ringed { perceptual { roughness 0.3 } }
material mixed = 0.1 ribbed + 0.25 soft + 0.9 pulled
material own = 0.1 ribbed + 0.25 soft + 0.9 pulled { perceptual { roughness 0.4 } }
material all = 0.5 mixed + 0.7 ribbed
)");
  const auto turned = [&](const char* name, const std::vector<std::pair<const char*, float>>& dials) {
    const Program& program = live.programs.at(name);
    std::vector<float> values = program.default_parameters();
    for (const auto& [dial, value] : dials) {
      const auto index = program.parameter(dial);
      EXPECT_TRUE(index) << dial;
      if (index) values[*index] = value;
    }
    return Bank(program, values, program.default_size());
  };
  const auto expect_same = [](Bank one, Bank other) {
    EXPECT_NEAR(wale::amplitude(one, 0), wale::amplitude(other, 0), 1e-4f * wale::amplitude(other, 0));
    std::mt19937 random(11);
    for (int i = 0; i < 300; ++i) {
      const Hand hand = somewhere(random);
      const Force a = tick(one, hand), b = tick(other, hand);
      EXPECT_NEAR(a.x, b.x, 2e-3) << i;
      EXPECT_NEAR(a.y, b.y, 2e-3) << i;
    }
  };
  const std::vector<std::pair<const char*, float>> dials{
      {"ribbed_weight", 0.1f}, {"ringed_weight", 0.25f}, {"pulled_weight", 0.9f}, {"ringed_roughness", 0.3f}};
  Bank mixed = turned("mixed", dials);
  expect_same(mixed, Bank(written.programs.at("mixed")));
  EXPECT_NEAR(predict(mixed, 0, wale::amplitude(mixed, 0)).level, (0.1 * 0.6 + 0.25 * 0.3) / (0.1 + 0.25 + 0.9), 1e-4);
  const PerceptRecord& record = live.programs.at("mixed").description().percepts.front();
  EXPECT_TRUE(record.blended);
  EXPECT_FALSE(record.parameter);
  // A level of the blend's own does not follow the weights.
  const Program& own = written.programs.at("own");
  EXPECT_FLOAT_EQ(own.default_parameters()[*own.parameter("roughness")], 0.4f);
  EXPECT_FALSE(own.parameter("soft_roughness"));
  EXPECT_FALSE(own.description().percepts.front().blended);
  std::vector<float> less = own.default_parameters();
  less[*own.parameter("ribbed_weight")] = 0;
  Bank less_ribbed(own, less, own.default_size());
  EXPECT_NEAR(predict(less_ribbed, 0, wale::amplitude(less_ribbed, 0)).level, 0.4, 1e-4);
  // Blends of blends: of `ribbed` there are two, the blend's own and the component's.
  expect_same(turned("all", {{"mixed_weight", 0.5f},
                             {"ribbed_weight", 0.7f},
                             {"ribbed_weight_2", 0.1f},
                             {"ringed_weight", 0.25f},
                             {"pulled_weight", 0.9f},
                             {"ringed_roughness", 0.3f}}),
              Bank(written.programs.at("all")));
  // With all weights 0 the force is 0 and not not-a-number.
  Bank none = turned("mixed", {{"ribbed_weight", 0}, {"ringed_weight", 0}, {"pulled_weight", 0}});
  std::mt19937 random(12);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(tick(none, somewhere(random)), Force(0));
}

TEST(Blends, AreSetByInstancesAndLieBetweenBlends) {
  const std::string parts = std::string(base) + R"(
material ringed { perceptual { roughness 0.2 }
 physical { force = lateral(1 mm * grating(length(hand), period: 4 mm)) } }
material mixed = 0.5 ribbed + 0.5 ringed
)";
  const Compiled made(parts + R"(
material turned = mixed(ribbed_weight: 0.1, ringed_roughness: 0.3)
material way = between(mixed, turned, 0.25)
material level = mixed(roughness: 0.7)
)");
  const auto value = [&](const char* material, const char* parameter) {
    const Program& program = made.programs.at(material);
    const auto index = program.parameter(parameter);
    return index ? program.default_parameters()[*index] : NAN;
  };
  EXPECT_FLOAT_EQ(value("turned", "ribbed_weight"), 0.1f);
  EXPECT_FLOAT_EQ(value("turned", "ringed_roughness"), 0.3f);
  EXPECT_FLOAT_EQ(value("way", "ribbed_weight"), 0.4f);
  EXPECT_FLOAT_EQ(value("way", "ringed_roughness"), 0.225f);
  EXPECT_FLOAT_EQ(value("level", "roughness"), 0.7f);
  Bank way(made.programs.at("way"));
  EXPECT_NEAR(predict(way, 0, wale::amplitude(way, 0)).level, (0.4 * 0.6 + 0.5 * 0.225) / 0.9, 1e-4);
  EXPECT_THROW(Compiled(parts + "material none = mixed(ribbed_weight: 0)"), std::runtime_error);
  EXPECT_THROW(Compiled(parts + "material much = mixed(ringed_roughness: 1.2)"), std::runtime_error);
  EXPECT_THROW(Compiled(parts + "material other = mixed(velvet_weight: 0.2)"), std::runtime_error);
}

TEST(Blends, OfBlendsAndWithMoreForces) {
  expect_means(R"(
material a { physical { force = spring(20 N/m) } }
material b { physical { force = viscous(4 N s/m) } }
material ab = 0.5 a + 0.5 b
material abb = 0.5 ab + b { physical { force = vector(0.2 N, 0 N) } }
)",
               "abb", R"(material m { physical {
  force = 0.25 * spring(20 N/m) + 0.25 * viscous(4 N s/m) + viscous(4 N s/m) + vector(0.2 N, 0 N)
} })",
               2e-5);
}

TEST(Blends, WarnOfAWeightThatChangesNothing) {
  const std::string others = R"(
material open { perceptual { roughness 0.6 } physical { force = lateral(grating(x, period: 3 mm)) } }
material crossed { perceptual { roughness 0.4 } physical { force = lateral(grating(y, period: 2 mm)) } }
material fixed { physical { force = lateral(grating(x, period: 3 mm), amplitude: 1 N) } }
material oily { physical { force = viscous(2 N s/m) } }
)";
  for (const std::string rest :
       {"WEIGHT open", "WEIGHT open { perceptual { roughness 0.3 } }", "WEIGHT fixed", "WEIGHT open + oily",
        "WEIGHT open + oily { perceptual { roughness 0.3 } }", "WEIGHT oily + open", "WEIGHT ribbed",
        "WEIGHT open + crossed", "WEIGHT open + crossed { perceptual { roughness 0.3 } }", "WEIGHT open + fixed",
        "WEIGHT open { physical { force = viscous(1 N s/m) } }"}) {
    const auto with = [&](const std::string& weight) {
      return std::string(base) + others + "material m = " + weight + rest.substr(6);
    };
    SourceSet sources;
    Diagnostics diagnostics;
    Files files;
    check_source(sources, sources.add("test.wale", with("0.7")), files, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << rest;
    const bool warned = std::ranges::any_of(diagnostics.all(), [](const Diagnostic& each) {
      return each.code == Code::unused_name && each.message.starts_with("the weight of");
    });
    const Compiled some(with("0.7")), all(with("1"));
    Bank one(some.programs.at("m")), other(all.programs.at("m"));
    std::mt19937 random(7);
    double differ = 0;
    for (int i = 0; i < 500; ++i) {
      const Hand hand = somewhere(random);
      differ = std::max<double>(differ, glm::length(tick(one, hand) - tick(other, hand)));
    }
    EXPECT_EQ(warned, differ < 1e-4) << rest << ": the forces differ by " << differ << " N";
  }
}

TEST(Blends, KeepTheirComponentsStatesApart) {
  const Compiled made(R"(wale 1
material swing { physical {
  param k = 10 N/m in 1 N/m .. 90 N/m
  state p : length = 0 mm in -10 mm .. 10 mm
  next p = x / 2
  force = vector(-k * p, 0 N)
} }
material two = 0.5 swing + 0.25 * swing(k: 30 N/m)
)");
  const auto& states = made.programs.at("two").description().states;
  ASSERT_EQ(states.size(), 2u);
  EXPECT_NE(states[0].name, states[1].name);
}

}  // namespace
}  // namespace wale::compiling::deriving_test
