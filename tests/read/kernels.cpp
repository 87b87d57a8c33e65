#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "compiler/read/fold_kernels.hpp"
#include "compiler/read/logistic.hpp"

namespace wale {
namespace {

constexpr double pi = std::numbers::pi;

// More places than a block has, and no whole number of blocks.
std::vector<glm::dvec2> some_places() {
  std::vector<glm::dvec2> places;
  for (int i = 0; i < 1003; ++i) places.emplace_back(0.07 * std::sin(1.7 * i), 0.05 * std::cos(2.3 * i + 1));
  return places;
}
constexpr glm::dvec2 waves(310, -85);  // periods over a metre

double phase_at(glm::dvec2 place) {
  const double periods = glm::dot(waves, place);
  return periods - std::floor(periods);
}

TEST(Logistic, IsOneOverOnePlusTheExponential) {
  std::vector<double> values;
  for (double value = -800; value <= 800; value += 0.37) values.push_back(value);
  std::vector<double> found(values.size());
  logistic_of(values.data(), values.size(), found.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(found[i], 1 / (1 + std::exp(-values[i])), 1e-15) << values[i];
  EXPECT_EQ(logistic_of(0), 0.5);
  EXPECT_EQ(logistic_of(HUGE_VAL), 1);
  EXPECT_LT(logistic_of(-HUGE_VAL), 1e-300);
  EXPECT_TRUE(std::isnan(logistic_of(std::numeric_limits<double>::quiet_NaN())));
}

TEST(FoldKernels, EachForceIsInItsPartOfThePeriod) {
  constexpr std::size_t parts = 12;
  const std::vector<glm::dvec2> places = some_places();
  std::vector<glm::dvec2> forces, sums(parts, glm::dvec2(0));
  std::vector<std::uint32_t> counts(parts);
  glm::dvec2 sum{0};
  double squares = 0;
  for (const glm::dvec2& place : places) {
    forces.emplace_back(100 * place.y, 1 - place.x);
    const auto part = static_cast<std::size_t>(phase_at(place) * parts);
    sums[part] += forces.back(), ++counts[part], sum += forces.back(),
        squares += glm::dot(forces.back(), forces.back());
  }
  const FoldedSums found = fold_up(places, forces, waves, parts);
  EXPECT_EQ(found.counts, counts);
  for (std::size_t i = 0; i < parts; ++i) EXPECT_LT(glm::distance(found.sums[i], sums[i]), 1e-9) << i;
  EXPECT_LT(glm::distance(found.sum, sum), 1e-9);
  EXPECT_NEAR(found.squares, squares, 1e-9);
}

TEST(FoldKernels, AWaveformOfManyPartsIsTheSineItWasMadeOf) {
  constexpr std::size_t parts = 2000;
  std::vector<glm::dvec2> profile;
  for (std::size_t i = 0; i < parts; ++i) {
    const double angle = 2 * pi * (static_cast<double>(i) + 0.5) / parts;
    profile.emplace_back(std::sin(angle), 3 * std::cos(angle));
  }
  const std::vector<glm::dvec2> places = some_places();
  std::vector<glm::dvec2> forces(places.size(), glm::dvec2(1, 2));
  add_waveform(profile, waves, -2, places, forces);
  std::vector<double> cosines(places.size()), sines(places.size());
  cosines_and_sines(places, waves, cosines, sines);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double angle = 2 * pi * glm::dot(waves, places[i]);
    EXPECT_NEAR(forces[i].x, 1 - 2 * std::sin(angle), 1e-5) << i;
    EXPECT_NEAR(forces[i].y, 2 - 6 * std::cos(angle), 3e-5) << i;
    EXPECT_NEAR(cosines[i], std::cos(angle), 1e-6) << i;
    EXPECT_NEAR(sines[i], std::sin(angle), 1e-6) << i;
  }
}

}  // namespace
}  // namespace wale
