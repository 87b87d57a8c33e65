// Drafts of what was measured.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "library/drafts/draft.hpp"

namespace wale::drafting_test {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

DraftOptions map_options() {
  DraftOptions options;
  options.scale = 1e-4, options.unit = 1e-6, options.bad = {"NaN", "***"};
  return options;
}

TEST(HeightMap, HasItsHeightsInSixteenBits) {
  const auto draft =
      height_map_draft("m.txt", "# um\n0 10 20 30\n0;10;20;30\n0,10,20,30\n+0\t1e1 20 30\n", "m", map_options());
  ASSERT_TRUE(draft);
  ASSERT_EQ(draft->files.size(), 1u);
  const std::string& picture = draft->files[0].bytes;
  const std::string head = "P5\n4 4\n65535\n";
  ASSERT_EQ(picture.size(), head.size() + 32);
  EXPECT_EQ(picture.substr(0, head.size()), head);
  const auto code = [&](std::size_t cell) {
    return static_cast<unsigned char>(picture[head.size() + 2 * cell]) * 256 +
           static_cast<unsigned char>(picture[head.size() + 2 * cell + 1]);
  };
  EXPECT_EQ(code(0), 0);
  EXPECT_EQ(code(1), 21845);
  EXPECT_EQ(code(7), 65535);
  EXPECT_TRUE(has(draft->text, "scale: 0.1 mm/px, height: 0.03 mm")) << draft->text;
}

TEST(HeightMap, FillsWhatWasNotMeasuredFromItsNeighbours) {
  const auto draft = height_map_draft("m.txt", "0 0 0 0\n0 NaN 3 0\n0 0 0 0\n9 *** 0 0\n", "m", map_options());
  ASSERT_TRUE(draft);
  const std::string& picture = draft->files[0].bytes;
  // The mean of 0, 0, 0, 0, 3, 0, 0 and 0 is 3/8 of 9 um in all.
  const std::size_t at = std::string("P5\n4 4\n65535\n").size() + 2 * 5;
  const int code = static_cast<unsigned char>(picture[at]) * 256 + static_cast<unsigned char>(picture[at + 1]);
  EXPECT_EQ(code, std::lround(65535 * 3.0 / 8 / 9));
  EXPECT_TRUE(has(draft->assumed.back(), "2 of 16 heights"));
}

TEST(HeightMap, SaysInWhichRowItIsWrong) {
  const auto refused = [](const std::string& text) {
    const auto draft = height_map_draft("m.txt", text, "m", map_options());
    return draft ? std::string("taken") : draft.error().place.name + ": " + draft.error().sentence;
  };
  EXPECT_EQ(refused("1 2 3 4\n\n1 2 3\n"), "m.txt: row 3: expected 4 numbers as in the rows before, found 3");
  EXPECT_EQ(refused("1 2 3 4\n1 2 x 4\n"), "m.txt: row 2: expected a number, found \"x\"");
  EXPECT_EQ(refused("1 2 3 inf\n"), "m.txt: row 1: expected a number, found \"inf\"");
  EXPECT_EQ(refused("1 2\n3 4\n"), "m.txt: row 2: expected 4 by 4 numbers or more, found 2 by 2");
  EXPECT_EQ(refused(""), "m.txt: row 0: expected 4 by 4 numbers or more, found 0 by 0");
  EXPECT_EQ(refused("NaN NaN NaN NaN\nNaN NaN NaN NaN\nNaN NaN NaN NaN\nNaN NaN NaN NaN\n"), "m.txt: row 4: no value was measured");
  EXPECT_EQ(refused("1 1 1 1\n1 1 1 1\n1 1 1 1\n1 1 1 1\n"), "m.txt: all heights are the same, so it cannot push");
  EXPECT_TRUE(has(refused("1 2 \x1b[2J 4\n"), "\\u001b"));
  EXPECT_FALSE(height_map_draft("m.txt", "", "m", {}));
}

const std::vector<std::string> percepts = {"hardness", "roughness", "stickiness"};

TEST(Ratings, BecomeLevelsOfEachMaterial) {
  DraftOptions options;
  options.least = 1, options.most = 7;
  const auto drafts = rating_drafts("r.csv", "material,roughness,hardness\n\"Cord, wide\",4,\n\"Cord, wide\",7,1\r\nOak,,7\n",
                                    percepts, {"oak"}, options);
  ASSERT_TRUE(drafts);
  ASSERT_EQ(drafts->size(), 2u);
  EXPECT_TRUE(has((*drafts)[0].text, "roughness 0.750 transferred")) << (*drafts)[0].text;
  EXPECT_TRUE(has((*drafts)[0].text, "hardness 0.000 transferred"));
  EXPECT_TRUE(has((*drafts)[0].text, "\"Cord, wide\""));
  EXPECT_NE((*drafts)[1].name, "oak") << "that name is taken";
  EXPECT_FALSE(has((*drafts)[1].text, "roughness"));
}

TEST(Ratings, AreReadAsSpreadsheetsWriteThem) {
  // The same table, as one in German writes it, and with a column that is no percept.
  const auto english = rating_drafts("r.csv", "material,roughness,notes\nOak,0.25,\"dry, old\"\n", percepts, {}, {});
  const auto german = rating_drafts("r.csv", "material;roughness;notes\nOak;0,25;\"dry; old\"\n", percepts, {}, {});
  const auto tabs = rating_drafts("r.csv", "material\troughness\tnotes\nOak\t0,25\tdry\n", percepts, {}, {});
  ASSERT_TRUE(english && german && tabs);
  EXPECT_TRUE(has((*english)[0].text, "roughness 0.250 transferred"));
  EXPECT_EQ((*english)[0].text, (*german)[0].text);
  EXPECT_EQ((*english)[0].text, (*tabs)[0].text);
  EXPECT_TRUE(has((*english)[0].assumed.back(), "\"notes\""));
  EXPECT_FALSE(rating_drafts("r.csv", "material,notes\nOak,dry\n", percepts, {}, {})) << "no column is a percept";
}

TEST(Ratings, SayInWhichRowTheyAreWrong) {
  const auto refused = [](const std::string& text) {
    const auto drafts = rating_drafts("r.csv", text, percepts, {}, {});
    return drafts ? std::string("taken") : drafts.error().sentence + "; " + drafts.error().mend;
  };
  EXPECT_EQ(refused("material,rougness\n"), "row 1: no percept is called \"rougness\"; did you mean roughness?");
  EXPECT_TRUE(has(refused("material,roughness\na,1,2\n"), "row 2: expected 2 cells as in the first line, found 3"));
  EXPECT_TRUE(has(refused("material,roughness\na,soft\n"), "row 2: expected a number for roughness, found \"soft\""));
  EXPECT_TRUE(has(refused("material,roughness\na,5\n"), "row 2: the roughness of 5 is outside 0 .. 1"));
  EXPECT_TRUE(has(refused("material,roughness\n\"a,0.5\n"), "row 2: a quotation mark is not closed"));
  EXPECT_TRUE(has(refused("material,roughness\n,0.5\n"), "row 2: the material has no name"));
  EXPECT_TRUE(has(refused("material,roughness\n"), "there is no material"));
  EXPECT_TRUE(has(refused("material\n"), "row 1: expected a line of names"));
  EXPECT_TRUE(has(refused("material,roughness,roughness\n"), "twice"));
}

/// A model of one resonance: the poles r e^(±i angle), whose filter is 1 - 2 r cos(angle) z^-1 + r^2 z^-2.
std::string resonance(double hertz, double radius, double variance, const std::string& more = "") {
  const double angle = 2 * M_PI * hertz / 10'000, a1 = -2 * radius * std::cos(angle), a2 = radius * radius;
  // Of the polynomials A(z) ± z^-3 A(1/z), written out for two coefficients.
  const double first = std::acos((1 - a1 - a2) / 2), second = std::acos(-(1 + a1 - a2) / 2);
  return "<?xml version=\"1.0\"?>\n<modelSet>\n<mu>0.4</mu>\n" + more + "<model><ARlsf><value>" + std::to_string(first) +
         "</value><value>" + std::to_string(second) + "</value></ARlsf><var>" + std::to_string(variance) +
         "</var><speedMod>100</speedMod><forceMod>2</forceMod></model>\n</modelSet>\n";
}

TEST(TextureModel, GivesFrictionAndTheStrongestWave) {
  DraftOptions options;
  options.mass = 0.05;
  const auto draft = texture_model_draft("Models_Cord.xml", resonance(200, 0.99, 0.01), "cord", options);
  ASSERT_TRUE(draft) << draft.error().sentence;
  EXPECT_TRUE(has(draft->text, "param friction = 0.8 N")) << draft->text;
  EXPECT_TRUE(has(draft->text, "LicenseRef-HaTT-research-only"));
  // The variance of a second-order process: var (1 + a2) / ((1 - a2) ((1 + a2)^2 - a1^2)).
  const double r = 0.99, a1 = -2 * r * std::cos(2 * M_PI * 200 / 10'000), a2 = r * r;
  const double power = 0.01 * (1 + a2) / ((1 - a2) * ((1 + a2) * (1 + a2) - a1 * a1));
  const std::size_t at = draft->text.find("param wave_1 = ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NEAR(std::stod(draft->text.substr(at + 15)), 0.05 * std::sqrt(2 * power), 0.01 * 0.05 * std::sqrt(2 * power));
  const std::size_t period = draft->text.find("period: ");
  EXPECT_NEAR(std::stod(draft->text.substr(period + 8)), 0.5, 0.01) << "100 mm/s at 200 Hz";
  EXPECT_FALSE(has(draft->text, "wave_2"));
}

TEST(TextureModel, SaysInWhichLineItIsWrong) {
  const auto refused = [](const std::string& text) {
    const auto draft = texture_model_draft("Models_X.xml", text, "x", {});
    return draft ? std::string("taken") : draft.error().sentence;
  };
  EXPECT_TRUE(has(refused("<modelSet>\n<mu>0.4</nu>"), "row 2: "));
  EXPECT_TRUE(has(refused("<modelSet>\n<mu>much</mu></modelSet>"), "row 2: expected a number, found \"much\""));
  EXPECT_TRUE(has(refused("<modelSet><mu>0.4</mu></modelSet>"), "there is no `model`"));
  EXPECT_TRUE(has(refused(""), "row "));
  std::string back = resonance(200, 0.99, 0.01);
  const auto value = back.find("<value>");
  EXPECT_TRUE(has(refused(back.replace(value, 7, "<value>3")), "do not rise"));
  EXPECT_TRUE(has(refused("<!DOCTYPE a [<!ENTITY b \"ha\"><!ENTITY c \"&b;&b;\">]><modelSet><mu>&c;</mu></modelSet>"),
                  "declares no entities"));
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  EXPECT_TRUE(has(refused(deep), "too deep"));
}

TEST(Picture, IsDecodedBeforeItIsTaken) {
  DraftOptions options;
  options.scale = 5e-4;
  std::ifstream file(std::string(WALE_SOURCE_DIR) + "/library/stone/slate.png", std::ios::binary);
  const std::string slate{std::istreambuf_iterator<char>(file), {}};
  const auto draft = picture_draft("slate.png", slate, "slate_scan", options);
  ASSERT_TRUE(draft) << draft.error().sentence;
  EXPECT_TRUE(has(draft->text, "patch 128 mm, 128 mm")) << "256 pixels of 0.5 mm";
  EXPECT_EQ(draft->files[0].name, "slate_scan.png");
  EXPECT_FALSE(picture_draft("broken.png", "PNG?", "broken", options));
  EXPECT_FALSE(picture_draft("slate.png", slate, "slate_scan", {})) << "without a scale";
}

TEST(Draft, HasNoQuotesOfOthersInItsTexts) {
  EXPECT_EQ(draft_names("a\"}b\n", "c\\", ""), "  representative {\n    title  \"a'}b'u000a\"\n    source \"c'\"\n  }\n");
}

}  // namespace
}  // namespace wale::drafting_test
