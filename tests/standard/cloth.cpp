// Weaves and knits: their repeats, their symmetries, and which thread lies on top.
#include "tests/standard/standard.hpp"

namespace wale::standard::cloth_test {
namespace {

/// Whether the warp lies on top where warp thread `end` and weft thread `pick` cross: then the height falls to the
/// sides of the warp and not along it.
bool warp_on_top(const Height& cloth, double spacing, int end, int pick) {
  const glm::dvec2 crossing{spacing * end, spacing * pick};
  const double along_warp = cloth(crossing + glm::dvec2(0, spacing / 4)),
               along_weft = cloth(crossing + glm::dvec2(spacing / 4, 0));
  EXPECT_NEAR(cloth(crossing), 0.5, 1e-5);
  EXPECT_GT(std::abs(along_warp - along_weft), 0.2);
  return along_warp > along_weft;
}

int modulo(int value, int divisor) { return ((value % divisor) + divisor) % divisor; }

TEST(PlainWeave, AlternatesOverAndUnder) {
  const Height cloth("std.weave", "plain_weave(hand, 2 mm)");
  for (int end = -8; end <= 8; ++end)
    for (int pick = -8; pick <= 8; ++pick)
      EXPECT_EQ(warp_on_top(cloth, 0.002, end, pick), modulo(end + pick, 2) == 0) << end << " " << pick;
}

TEST(PlainWeave, RepeatsByThreadsAndIsSymmetricInWarpAndWeft) {
  const Height cloth("std.weave", "plain_weave(hand, 2 mm)");
  Chance chance(10);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.004, 0)), 2e-4);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.002, 0.002)), 2e-4);
    EXPECT_NEAR(cloth(place), cloth({-place.x, place.y}), 2e-4);
    EXPECT_NEAR(cloth(place), cloth({place.y + 0.002, place.x}), 2e-4);
  }
}

TEST(Twill, StepsUpByOneFromWarpToWarp) {
  for (const auto& [over, under] : {std::pair{2, 1}, std::pair{2, 2}, std::pair{3, 1}}) {
    const Height cloth("std.weave",
                       "twill(hand, 2 mm, over: " + std::to_string(over) + ", under: " + std::to_string(under) + ")");
    for (int end = -6; end <= 6; ++end)
      for (int pick = -6; pick <= 6; ++pick)
        EXPECT_EQ(warp_on_top(cloth, 0.002, end, pick), modulo(pick - end, over + under) < over) << end << " " << pick;
    Chance chance(11);
    for (int i = 0; i < 300; ++i) {
      const glm::dvec2 place = chance.place(0.03);
      EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.002, 0.002)), 2e-4);  // along the rib
      EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0, 0.002 * (over + under))), 2e-4);
    }
  }
}

TEST(Satin, TiesEachWarpOnceARepeatAndNeverBesideAnother) {
  for (int harness : {5, 8}) {
    const Height cloth("std.weave", "satin(hand, 1 mm, harness: " + std::to_string(harness) + ")");
    const auto tied = [&](int end, int pick) { return !warp_on_top(cloth, 0.001, end, pick); };
    for (int end = 0; end < harness; ++end) {
      int ties = 0;
      for (int pick = 0; pick < harness; ++pick) {
        if (!tied(end, pick)) continue;
        ++ties;
        for (int by : {-1, 0, 1}) {
          EXPECT_FALSE(tied(end + 1, pick + by)) << end << " " << pick;
          EXPECT_FALSE(tied(end - 1, pick + by)) << end << " " << pick;
        }
      }
      EXPECT_EQ(ties, 1);
    }
  }
}

TEST(Woven, HasSeparateSpacingsForWarpAndWeft) {
  const Height cloth("std.weave", "woven(hand, warp: 2 mm, weft: 3 mm)");
  Chance chance(12);
  for (int i = 0; i < 300; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.002, 0.003)), 2e-4);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0, 0.006)), 2e-4);
  }
  EXPECT_NEAR(cloth({0.001, 0.0015}), -0.5, 1e-4);  // in the corner between threads
}

TEST(Stockinette, RepeatsByWaleAndCourseAndMirrorsInEachColumn) {
  const Height cloth("std.knit", "stockinette(hand, 4 mm, 3 mm)");
  Chance chance(13);
  double sum = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    sum += cloth(place);
    if (i > 1000) continue;
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.004, 0)), 2e-4);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0, 0.003)), 2e-4);
    EXPECT_NEAR(cloth(place), cloth({-place.x, place.y}), 2e-4);
  }
  EXPECT_NEAR(sum / 20000, 0, 0.01);
  // The legs of a V rise to its sides: their crests at 1/8 and 3/8 of a wale are 0.8 / 2 of a course apart.
  const auto crest = [&](double x) {
    double best = 0, top = -1;
    for (double y = 0; y < 0.003; y += 1e-5)
      if (cloth({x, y}) > top) top = cloth({x, y}), best = y;
    return best;
  };
  EXPECT_NEAR(std::fmod(crest(0.0015) - crest(0.0005) + 0.003, 0.003), 0.4 * 0.003, 3e-5);
}

TEST(RibKnit, RepeatsAfterItsKnitAndPurlColumns) {
  const Height cloth("std.knit", "rib_knit(hand, 3 mm, 2.4 mm, columns: 2)");
  Chance chance(14);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 place = chance.place(0.03);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0.012, 0)), 1e-3);
    EXPECT_NEAR(cloth(place), cloth(place + glm::dvec2(0, 0.0024)), 1e-3);
  }
  // The knit columns, from 0 to 6 mm, are higher than the purl columns.
  double knit = 0, purl = 0;
  for (int i = 0; i < 2000; ++i) {
    knit += cloth({chance.between(0.001, 0.005), chance.between(-0.03, 0.03)}) / 2000;
    purl += cloth({chance.between(0.007, 0.011), chance.between(-0.03, 0.03)}) / 2000;
  }
  EXPECT_NEAR(knit - purl, 0.8, 0.1);
}

}  // namespace
}  // namespace wale::standard::cloth_test
