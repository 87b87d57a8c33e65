// Figures that are read from programs, against materials with known figures.

#include "compiler/read/read.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <span>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/fourier.hpp"
#include "tests/standard/standard.hpp"

namespace wale::read_test {
namespace {

using standard::material;
using std::numbers::pi;

constexpr PeriodBand textures{0.7e-3, 10e-3}, bumps{10e-3, 100e-3};

Bank pushing(const std::string& statements, const std::string& declarations = "") {
  return Bank(material(declarations + "\nmaterial m { physical {\n" + statements + "\n} }", "m"));
}

Relief relief_of(const Bank& bank) { return static_force(bank).relief; }

Swing vibration_of(const Bank& bank) {
  Swing sway, vibration;
  tell_swings(bank, felt_at_rest(bank), sway, vibration);
  return vibration;
}

ForceReading reading_of(const Bank& bank) {
  static const auto common = common_modules();
  return read(bank, common->declarations);
}

/// `count` irregular values.
std::vector<std::complex<float>> any_values(std::size_t count) {
  std::vector<std::complex<float>> values;
  for (std::size_t i = 0; i < count; ++i)
    values.emplace_back(static_cast<float>((i * i * 7 + 3 * i) % 23) - 11, static_cast<float>(i * i % 17) - 8);
  return values;
}

// Sides with factors 2, 3, 4 and others, and with fewer and more lines than are transformed at once.
TEST(Fourier, IsTheSumOfItsDefinitionAndHasItsInverse) {
  for (const std::size_t side : {1u, 5u, 6u, 8u, 18u, 20u}) {
    const auto values = any_values(side * side);
    const auto coefficients = fourier(side, values);
    for (std::size_t v = 0; v < side; ++v)
      for (std::size_t u = 0; u < side; ++u) {
        std::complex<double> sum = 0;
        for (std::size_t y = 0; y < side; ++y)
          for (std::size_t x = 0; x < side; ++x)
            sum += std::complex<double>(values[y * side + x]) *
                   std::polar(1.0, -2 * pi * static_cast<double>((u * x + v * y) % side) / static_cast<double>(side));
        EXPECT_LT(std::abs(sum - std::complex<double>(coefficients[v * side + u])), 1e-3) << u << ' ' << v;
      }
    const auto back = inverse_fourier(side, coefficients);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_LT(std::abs(back[i] - values[i]), 1e-4f) << side;
  }
}

TEST(Fourier, OfManyLinesIsThatOfEach) {
  constexpr std::size_t count = 12, lines = 21;
  const auto values = any_values(count * lines);
  const auto all = fourier_of_lines(count, values);
  for (std::size_t line = 0; line < lines; ++line) {
    const auto one = fourier_of_line(std::span(values).subspan(line * count, count));
    for (std::size_t i = 0; i < count; ++i) EXPECT_LT(std::abs(all[line * count + i] - one[i]), 1e-4f) << line;
  }
}

TEST(Reading, EveryFigureOfASineIsItsClosedForm) {
  for (const double period : {0.9, 2.5, 7.0}) {
    const Relief texture =
        relief_of(pushing("force = vector(-1.2 N * sin(2 * pi * x / " + std::to_string(period) + " mm), 0 N)"));
    const double metres = period * 1e-3;
    EXPECT_NEAR(texture.amplitude, 1.2, 0.03) << period;
    EXPECT_NEAR(texture.maximum, 1.2, 0.06) << period;
    EXPECT_NEAR(texture.rms, 1.2 / std::sqrt(2), 0.03) << period;
    EXPECT_NEAR(texture.mean, 1.2 * 2 / pi, 0.03) << period;
    EXPECT_NEAR(texture.period, metres, 0.02 * metres) << period;
    EXPECT_NEAR(std::sin(texture.orientation), 0, 0.03) << period;
    EXPECT_GT(texture.anisotropy, 0.95) << period;
    EXPECT_GT(texture.regularity, 0.9) << period;
    EXPECT_NEAR(texture.transitions, 2 / metres, 0.05 * 2 / metres) << period;
    EXPECT_NEAR(texture.steepness, 2 * pi / metres, 0.05 * 2 * pi / metres) << period;
  }
}

TEST(Reading, SignChangesOfSumsAndNoisesAreThoseThatCountingFinds) {
  struct Case {
    const char* physical;
    std::function<double(double)> force;  // at x, in millimetres
  };
  const auto sine = [](double x, double period) { return std::sin(2 * pi * x / period); };
  const std::vector<Case> cases = {
      {"force = vector(1 N * sin(2 * pi * x / 4 mm) + 1 N * sin(2 * pi * x / 5 mm), 0 N)",
       [&](double x) { return sine(x, 4) + sine(x, 5); }},
      {"force = vector(1 N * sin(2 * pi * x / 20 mm) + 0.6 N * sin(2 * pi * x / 1.7 mm), 0 N)",
       [&](double x) { return sine(x, 20) + 0.6 * sine(x, 1.7); }},
      {"force = vector(0.4 N * sin(2 * pi * x / 3 mm) + 1 N * sin(2 * pi * x / 7.7 mm) - 30 N/m * x, 0 N)",
       [&](double x) { return 0.4 * sine(x, 3) + sine(x, 7.7); }}};
  for (const Case& each : cases) {
    int changes = 0;
    double before = 0;
    for (double x = -70; x < 70; x += 0.002) {
      const double force = each.force(x);
      if (std::abs(force) < 0.05 * 1.4) continue;
      changes += before * force < 0;
      before = force;
    }
    const double truth = changes / 0.14;
    EXPECT_NEAR(relief_of(pushing(each.physical)).transitions, truth, 0.15 * truth) << each.physical;
  }
  // A force of noise has a little less than a zero in each cell of its lattice of 2 mm.
  const double cells = relief_of(pushing("force = vector(1 N * noise2(x / 2 mm, y / 2 mm), 0 N)")).transitions;
  EXPECT_GT(cells, 200);
  EXPECT_LT(cells, 500);
}

TEST(Reading, TheOrientationIsTheDirectionInWhichATextureChanges) {
  for (const double degrees : {30.0, 90.0, 135.0}) {
    const double angle = degrees * pi / 180;
    const std::string along =
        "(" + std::to_string(std::cos(angle)) + " * x + " + std::to_string(std::sin(angle)) + " * y)";
    const Relief texture =
        relief_of(pushing("height h = 1 mm * cos(2 * pi * " + along + " / 3 mm)\n force = lateral(h, amplitude: 1 N)"));
    EXPECT_NEAR(texture.orientation, angle, 0.02) << degrees;
    EXPECT_NEAR(texture.period, 3e-3, 0.06e-3) << degrees;
    EXPECT_NEAR(texture.amplitude, 1, 0.03) << degrees;
  }
}

TEST(Reading, ACheckIsTheSameInEveryDirectionAndARuleIsNot) {
  const Relief check = relief_of(pushing("force = vector(1 N * sin(2 * pi * x / 4 mm), 1 N * sin(2 * pi * y / 4 mm))"));
  EXPECT_LT(check.anisotropy, 0.1);
  EXPECT_GT(check.regularity, 0.9);
  EXPECT_NEAR(check.amplitude, std::sqrt(2), 0.06);
}

TEST(Reading, NoiseDoesNotComeBackAfterAPeriod) {
  const Relief noise =
      relief_of(pushing("height h = 1 mm * noise2(x / 2 mm, y / 2 mm)\n force = lateral(h, amplitude: 1 N)"));
  EXPECT_LT(noise.regularity, 0.5);
  EXPECT_LT(noise.anisotropy, 0.3);
  EXPECT_GT(noise.period, 2e-3);  // noise on a lattice of 2 mm has no strong component below 2 mm
}

TEST(Reading, APeriodicTextureIsRegularWhateverItsHarmonics) {
  // Periodic derivatives of a Gaussian bar. Of the five strong harmonics, the second is the strongest.
  const std::string declared =
      "function bar(along: length, spacing: length) = 1 N * (along - spacing * round(along / spacing)) / 0.45 mm *\n"
      "  exp(0.5 - 0.5 * ((along - spacing * round(along / spacing)) / 0.45 mm)^2)";
  const Relief ribs = relief_of(pushing("force = vector(bar(x, 5 mm), 0 N)", declared));
  EXPECT_GT(ribs.regularity, 0.95);
  EXPECT_NEAR(ribs.period, 5e-3, 0.1e-3);
  EXPECT_NEAR(ribs.anisotropy, 1, 0.05);
  // A square mesh of such bars, along the axes and rotated.
  const Relief mesh = relief_of(pushing("force = vector(bar(x, 5 mm), bar(y, 5 mm))", declared));
  EXPECT_GT(mesh.regularity, 0.95);
  EXPECT_NEAR(mesh.period, 5e-3, 0.1e-3);
  EXPECT_LT(mesh.anisotropy, 0.1);
  const Relief turned =
      relief_of(pushing("let u = (x + 2 * y) / sqrt(5)\nlet v = (y - 2 * x) / sqrt(5)\n"
                        "force = bar(u, 3 mm) * vector(1, 2) / sqrt(5) + bar(v, 3 mm) * vector(-2, 1) / sqrt(5)",
                        declared));
  EXPECT_GT(turned.regularity, 0.95);
  EXPECT_NEAR(turned.period, 3e-3, 0.1e-3);
}

TEST(Reading, ALongPatchIsReadAsASquareOne) {
  for (const char* size : {"160 mm, 40 mm", "40 mm, 160 mm", "60 mm, 60 mm", "40 mm, 30 mm"})
    for (const char* along : {"x", "y"}) {
      const std::string wave = "1 N * sin(2 * pi * " + std::string(along) + " / 2.2 mm)";
      const Relief texture = relief_of(pushing("patch " + std::string(size) + "\nforce = vector(" +
                                               (*along == 'x' ? wave + ", 0 N" : "0 N, " + wave) + ")"));
      EXPECT_NEAR(texture.amplitude, 1, 0.03) << size << along;
      EXPECT_NEAR(texture.period, 2.2e-3, 0.05e-3) << size << along;
      EXPECT_GT(texture.regularity, 0.95) << size << along;
      EXPECT_NEAR(std::abs(std::cos(texture.orientation)), *along == 'x' ? 1 : 0, 0.05) << size << along;
    }
}

TEST(Reading, TheShippedMeshesAreRegular) {
  for (const char* name : {"wire_mesh", "perforated_sheet"}) {
    const Relief texture = relief_of(Bank(standard::made("std.mesh", name)));
    EXPECT_GT(texture.regularity, 0.9) << name;
    EXPECT_LT(texture.anisotropy, 0.1) << name;
  }
  // By default, holes are 6 mm and wires 5 mm apart. Rows of holes are closer than holes.
  EXPECT_NEAR(relief_of(Bank(standard::made("std.mesh", "perforated_sheet"))).period, 6e-3, 0.15e-3);
  EXPECT_NEAR(relief_of(Bank(standard::made("std.mesh", "wire_mesh"))).period, 5e-3, 0.15e-3);
}

TEST(Reading, IncommensurableWavesAreNotNoise) {
  // The sum of two incommensurable periods repeats approximately, and better at longer distances.
  const Relief texture = relief_of(
      pushing("force = vector(1 N * sin(2 * pi * x / 2.5 mm) + 1 N * sin(2 * pi * x / (2.5 mm * sqrt(2))), 0 N)"));
  // Half of its mean square repeats after the period that is told, and the other half after another.
  EXPECT_TRUE(texture.regular());
  EXPECT_NEAR(texture.regularity, 0.5, 0.1);
  ASSERT_EQ(texture.waves.size(), 2u);
  const double one = texture.waves[0].period, other = texture.waves[1].period;
  EXPECT_NEAR(std::min(one, other), 2.5e-3, 0.05e-3);
  EXPECT_NEAR(std::max(one, other), 2.5e-3 * std::sqrt(2.0), 0.07e-3);
  EXPECT_NEAR(texture.waves[0].share, 0.5, 0.05);
  EXPECT_NEAR(texture.waves[1].share, 0.5, 0.05);
  EXPECT_EQ(texture.period, one);
}

TEST(Reading, NoiseOfAnyGrainIsIrregular) {
  for (const double grain : {0.8, 1.5, 2.5, 4.0, 6.0})
    for (const char* noise : {"noise2(x / g, y / g)", "noise2(x / g, y / (3 * g))", "gradient_noise(x / g, y / g)"}) {
      const Relief texture = relief_of(pushing("let g = " + std::to_string(grain) + " mm\nheight h = 1 mm * " + noise +
                                               "\nforce = lateral(h, amplitude: 1 N)"));
      EXPECT_LT(texture.regularity, 0.5) << noise << ' ' << grain;
      EXPECT_FALSE(texture.regular());
    }
}

TEST(Reading, ASpringAndAHillAreNoTexture) {
  const Bank spring = pushing("force = -120 N/m * hand\n patch 160 mm, 160 mm");
  EXPECT_EQ(relief_of(spring).amplitude, 0);
  EXPECT_NEAR(static_force(spring).trend.stiffness(), 120, 0.1);
  const Bank hill = pushing("force = vector(2 N * sin(2 * pi * x / 40 mm), 0 N)");
  EXPECT_EQ(relief_of(hill).within(textures), 0);
  EXPECT_NEAR(relief_of(hill).within(bumps), 2, 0.02);
  EXPECT_NEAR(relief_of(hill).period, 40e-3, 0.4e-3);
}

TEST(Reading, ATextureIsTheSameOnASpringAndOnAHill) {
  const Relief texture =
      relief_of(pushing("let ridges = vector(0.8 N * sin(2 * pi * x / 2.5 mm), 0 N)\n"
                        "force = ridges - 20 N/m * hand + vector(0 N, 1 N * sin(2 * pi * y / 50 mm))"));
  // The hill is the larger part, and the size of each is by its share of the mean square.
  EXPECT_NEAR(texture.within(textures), texture.amplitude * std::sqrt(0.64 / 1.64), 0.02);
  EXPECT_NEAR(texture.within(bumps), texture.amplitude * std::sqrt(1 / 1.64), 0.02);
  ASSERT_EQ(texture.waves.size(), 2u);
  EXPECT_NEAR(texture.waves[0].period, 50e-3, 0.5e-3);
  EXPECT_NEAR(texture.waves[1].period, 2.5e-3, 0.02e-3);
  EXPECT_NEAR(texture.period, 50e-3, 0.5e-3);
}

TEST(Reading, FineRibsAreNoBumpsAtAnySampling) {
  for (const double period : {0.75, 0.78, 0.8, 0.9, 1.17, 1.27, 1.4, 2.4}) {
    const Bank ribs = pushing("force = vector(1 N * sin(2 * pi * x / " + std::to_string(period) + " mm), 0 N)");
    EXPECT_LT(relief_of(ribs).within(bumps), 0.05) << period;
  }
}

TEST(Reading, ATextureInOneCornerIsFoundThere) {
  const Relief texture = relief_of(pushing(
      "patch 160 mm, 160 mm\n"
      "force = if x > 30 mm and y > 30 mm then vector(1 N * sin(2 * pi * x / 1.5 mm), 0 N) else vector(0 N, 0 N)"));
  EXPECT_NEAR(texture.period, 1.5e-3, 0.05e-3);
}

TEST(Reading, DampingFrictionAndMassAreTheirCoefficients) {
  EXPECT_NEAR(opposing_force(pushing("force = -7 N s/m * velocity")).damping, 7, 0.02);
  EXPECT_NEAR(opposing_force(pushing("force = -7 N s/m * velocity")).friction, 0, 0.02);
  EXPECT_NEAR(inertia(pushing("force = -0.3 kg * acceleration")).greatest, 0.3, 1e-3);
  EXPECT_EQ(inertia(pushing("force = -7 N s/m * velocity")).greatest, 0);
  // A force that depends on the place alone opposes no motion, averaged over a stroke to and fro.
  const OpposingForce none =
      opposing_force(pushing("force = vector(2 N * sin(2 * pi * x / 3 mm), 0 N) - 50 N/m * hand"));
  EXPECT_NEAR(none.friction, 0, 0.02);
  EXPECT_NEAR(none.damping, 0, 0.1);
}

TEST(Reading, FrictionIsReadWithAndWithoutStates) {
  const OpposingForce coulomb =
      opposing_force(pushing("force = coulomb(0.8 N, rise: 200 N s/m) - 2 N s/m * velocity", "import std.friction"));
  EXPECT_NEAR(coulomb.friction, 0.8, 0.02);
  EXPECT_NEAR(coulomb.damping, 2, 0.1);
  const OpposingForce dahl = opposing_force(Bank(standard::made("std.friction", "dahl_friction", "coulomb: 1.1 N")));
  EXPECT_NEAR(dahl.friction, 1.1, 0.11);
}

TEST(Reading, AVibrationHasItsAmplitudeAndFrequency) {
  const Swing shaking = vibration_of(pushing("active 2 W\nforce = vector(0.5 N * sin(2 * pi * phase(40 Hz)), 0 N)"));
  EXPECT_NEAR(shaking.amplitude, 0.5, 0.005);
  EXPECT_NEAR(shaking.frequency, 40, 0.01);
  EXPECT_EQ(vibration_of(pushing("force = -120 N/m * hand")).amplitude, 0);
  const ForceReading slow = reading_of(pushing("active 2 W\nforce = vector(2 N * sin(2 * pi * phase(1.3 Hz)), 0 N)"));
  EXPECT_NEAR(slow.sway.amplitude, 2, 0.03);
  EXPECT_NEAR(slow.sway.frequency, 1.3, 0.01);
  EXPECT_EQ(slow.vibration.amplitude, 0);
  EXPECT_EQ(slow.opposing.friction, 0);
  EXPECT_EQ(slow.opposing.damping, 0);
}

TEST(Reading, ASumHasTheFiguresOfItsParts) {
  const Bank bank =
      pushing("force = vector(-0.8 N * sin(2 * pi * x / 2.5 mm), 0 N) - 40 N/m * hand - 3 N s/m * velocity");
  const ForceReading found = reading_of(bank);
  EXPECT_NEAR(found.relief().amplitude, 0.8, 0.01);
  EXPECT_EQ(found.relief().within(bumps), 0);
  EXPECT_NEAR(found.stiffness, 40, 0.5);
  EXPECT_NEAR(found.opposing.damping, 3, 0.05);
  EXPECT_NEAR(found.opposing.friction, 0, 0.02);
  EXPECT_EQ(found.inertia.greatest, 0);
  EXPECT_EQ(found.vibration.amplitude, 0);
  EXPECT_FALSE(found.wall);
}

// A limit of the author's is a law: from there on nothing gets stiffer. One of the device cuts a law off.
TEST(Reading, ALimitedSpringKeepsItsStiffnessAndIsNoHill) {
  const ForceReading limited = reading_of(pushing("force = -300 N/m * hand limit 3 N"));
  EXPECT_NEAR(limited.stiffness, 300, 1);
  EXPECT_FALSE(limited.wall);
  EXPECT_EQ(limited.relief().amplitude, 0);
  const ForceReading cut_off = reading_of(pushing("force = -300 N/m * hand"));
  EXPECT_NEAR(cut_off.stiffness, 300, 1);
  EXPECT_FALSE(cut_off.wall);
  EXPECT_EQ(cut_off.relief().amplitude, 0);
}

/// A force along a direction, as a formula of `u` (m along it).
std::string along(double degrees, const std::string& force) {
  const double angle = degrees * pi / 180;
  return "let u = " + std::to_string(std::cos(angle)) + " * x + " + std::to_string(std::sin(angle)) +
         " * y\nforce = " + "vector(" + force + ", 0 N)";
}

TEST(Reading, APeriodIsTheFundamentalWhateverTheWaveformAndScale) {
  for (const double period : {0.12, 0.3, 0.55, 2.5, 12.0, 40.0}) {
    const std::string p = std::to_string(period) + " mm";
    for (const std::string& force :
         {"1.5 N * sin(2 * pi * u / (" + p + "))", "(if modulo(u, " + p + ") < " + p + " / 2 then 1.5 N else -1.5 N)",
          "1.5 N * (2 * modulo(u, " + p + ") / (" + p + ") - 1)",
          // Without its fundamental: the second and the third harmonic.
          "0.8 N * (sin(4 * pi * u / (" + p + ")) + sin(6 * pi * u / (" + p + ")))"})
      for (const double degrees : {0.0, 67.0}) {
        const Relief relief = relief_of(pushing(along(degrees, force)));
        EXPECT_NEAR(relief.period, period * 1e-3, 0.01e-3 * period) << force << ' ' << degrees;
        EXPECT_NEAR(relief.amplitude, 1.5, 0.05) << force << ' ' << degrees;
        EXPECT_NEAR(relief.orientation, degrees * pi / 180, 0.02) << force;
        EXPECT_GT(relief.regularity, 0.95) << force;
      }
  }
}

TEST(Reading, NarrowRidgesRepeatAfterTheirDistance) {
  for (const double period : {0.5, 2.5, 40.0}) {
    const Relief relief = relief_of(
        pushing("force = lateral(grating(x, period: " + std::to_string(period) + " mm, duty: 0.05), amplitude: 1 N)"));
    EXPECT_NEAR(relief.period, period * 1e-3, 0.01e-3 * period);
    EXPECT_NEAR(relief.amplitude, 1, 0.03);
  }
}

TEST(Reading, WavesThatCrossAreWavesOfTheirOwn) {
  const Relief relief =
      relief_of(pushing("force = vector(1 N * sin(2 * pi * x / 2 mm), 0.5 N * sin(2 * pi * y / 17 mm)) + "
                        "vector(0.35 N * sin(2 * pi * (x + y) / 0.6 mm), 0 N)"));
  ASSERT_EQ(relief.waves.size(), 3u);
  EXPECT_NEAR(relief.waves[0].period, 2e-3, 0.01e-3);
  EXPECT_NEAR(relief.waves[1].period, 17e-3, 0.1e-3);
  EXPECT_NEAR(relief.waves[2].period, 0.6e-3 / std::sqrt(2.0), 0.003e-3);
  EXPECT_NEAR(relief.waves[2].orientation, pi / 4, 0.01);
  EXPECT_NEAR(relief.within(bumps), relief.amplitude * std::sqrt(0.25 / (1 + 0.25 + 0.1225)), 0.02);
}

TEST(Reading, WhatDoesNotRepeatLeavesNoTexture) {
  for (const char* force : {"force = vector(-700 N/m * max(x - 12.3 mm, 0 mm), 0 N)", "force = -50000 N/m * hand",
                            "force = -300 N/m * hand limit 3 N", "force = vector(if x > 5 mm then 1 N else 0 N, 0 N)",
                            "force = vector(-300 N/m * max(x - 30 mm, 0 mm), 0 N) - 40 N/m * hand"})
    EXPECT_EQ(relief_of(pushing(force)).amplitude, 0) << force;
  for (const char* at : {"x^2 + y^2", "(x - 20 mm)^2 + (y + 13 mm)^2"}) {
    const Relief hill = relief_of(
        pushing("height h = 10 mm * exp(-((" + std::string(at) + ") / (6 mm)^2))\nforce = lateral(h, amplitude: 1 N)"));
    EXPECT_EQ(hill.within(textures), 0) << at;
    EXPECT_GT(hill.within(bumps), 0.9) << at;
    EXPECT_EQ(hill.period, 0) << at;
  }
}

TEST(Reading, FrictionOnASlopeThatStartsAtRestIsNoViscosity) {
  for (const double newton : {0.5, 1.4}) {
    const OpposingForce found = opposing_force(
        pushing("force = coulomb(" + std::to_string(newton) + " N, rise: 8 N s/m)", "import std.friction"));
    EXPECT_NEAR(found.friction, newton, 0.03 * newton);
    EXPECT_EQ(found.damping, 0);
    EXPECT_NEAR(found.saturation_speed, newton / 8, 0.05 * newton / 8);
    EXPECT_NEAR(found.rise(), 8, 0.4);
  }
}

TEST(Reading, AHeartbeatHasNoViscosity) {
  const ForceReading beat =
      reading_of(pushing("active 2 W\nforce = vector(1 N * exp(-30 * phase(1.2 Hz)), 0 N) - 20 N/m * hand"));
  EXPECT_EQ(beat.opposing.damping, 0);
  EXPECT_EQ(beat.opposing.friction, 0);
  EXPECT_NEAR(beat.sway.frequency, 1.2, 0.02);
}

TEST(Reading, AWallHasAFaceAndNothingElseHas) {
  const auto face = wall_face(pushing(
      "let depth = max(x - 12.3 mm, 0 mm)\n"
      "force = vector(-900 N/m * depth - (if depth > 0 mm then 6 N s/m * max(velocity.x, 0 m/s) else 0 N), 0 N)"));
  ASSERT_TRUE(face.has_value());
  EXPECT_NEAR(face->stiffness, 900, 5);
  EXPECT_NEAR(face->place.x, 12.3e-3, 0.05e-3);
  EXPECT_NEAR(face->inward.x, 1, 1e-9);
  EXPECT_NEAR(face->damping, 6, 0.05);
  EXPECT_NEAR(face->release, 0, 0.05);
  EXPECT_FALSE(wall_face(pushing("force = -120 N/m * hand")));
  EXPECT_FALSE(wall_face(pushing("force = vector(2 N * sin(2 * pi * x / 2.5 mm), 0 N)")));
  EXPECT_FALSE(wall_face(pushing("force = vector(0 N, 0 N)")));
}

TEST(Reading, AWallWithStatesIsFoundByAHandThatMovesIntoIt) {
  // std.wall: stiffness 900 N/m, damping 4 N s/m on the way in, face 20 mm right of the centre; it has states.
  const Bank wall(standard::made("std.wall", "wall"));
  EXPECT_EQ(static_force(wall).largest, 0);  // a hand that enters behind the face feels no force
  const auto face = wall_face(wall);
  ASSERT_TRUE(face.has_value());
  EXPECT_NEAR(face->stiffness, 900, 5);
  EXPECT_NEAR(face->place.x, 20e-3, 0.05e-3);
  EXPECT_NEAR(face->inward.x, 1, 1e-9);
  EXPECT_NEAR(face->damping, 4, 0.05);
  EXPECT_NEAR(face->release, 0, 0.05);
  const auto up = wall_face(Bank(standard::made("std.wall", "wall", "stiffness: 300 N/m, angle: 90 deg")));
  ASSERT_TRUE(up.has_value());
  EXPECT_NEAR(up->stiffness, 300, 2);
  EXPECT_NEAR(up->inward.y, 1, 1e-9);
  const auto room = wall_face(Bank(standard::made("std.wall", "room", "stiffness: 500 N/m")));
  ASSERT_TRUE(room.has_value());
  EXPECT_NEAR(room->stiffness, 500, 5);
  const auto post = wall_face(Bank(standard::made("std.wall", "post", "stiffness: 700 N/m")));
  ASSERT_TRUE(post.has_value());
  EXPECT_NEAR(post->stiffness, 700, 20);  // the face is curved
  EXPECT_NEAR(reading_of(wall).wall->stiffness, 900, 5);
  // Frictions have states too, but are no walls.
  for (const char* name : {"coulomb_friction", "karnopp_friction", "dahl_friction"})
    EXPECT_FALSE(wall_face(Bank(standard::made("std.friction", name)))) << name;
}

}  // namespace
}  // namespace wale::read_test
