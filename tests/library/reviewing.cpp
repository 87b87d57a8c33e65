// What a library takes in: `review`.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "library/review/licence.hpp"
#include "library/review/review.hpp"

namespace wale::reviewing_test {
namespace {

namespace fs = std::filesystem;

/// A library in a folder of its own.
class Reviewing : public testing::Test {
 protected:
  Reviewing() {
    folder_ = fs::temp_directory_path() / ("wale_review_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    write("wale.project", "// a library\nlicence \"CC0-1.0\"\n");
  }
  ~Reviewing() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  Review review_all() const { return *review({folder_.string()}, {}, Sandbox::required); }
  std::string root() const { return folder_.string(); }

  /// The codes that were found, in alphabetical order.
  static std::multiset<std::string> codes_of(const Review& review) {
    std::multiset<std::string> codes;
    for (const ReviewedFile& file : review.files)
      for (const Diagnostic& each : file.diagnostics.all()) codes.insert(code_name(each.code));
    return codes;
  }

  fs::path folder_;
};
using Codes = std::multiset<std::string>;

/// A material that lacks nothing. `more` stands in its representative block.
std::string cord(const std::string& name = "cord", const std::string& level = "0.6 estimated",
                 const std::string& period = "2.5 mm", const std::string& more = "") {
  return "wale 1\n\n/// Ribs of cotton pile, felt across.\nmaterial " + name +
         " {\n  representative {\n    title  \"Cord\"\n    called \"corded cloth\"\n    called de \"Cordstoff\"\n"
         "    kind   fabric.woven\n    source \"ribs: a ruler; level: an estimate\"\n" +
         more + "  }\n  perceptual { roughness " + level +
         " }\n  physical {\n    height ribs = grating(x, period: " + period +
         ")\n    force = lateral(ribs)\n  }\n}\n";
}

TEST_F(Reviewing, TakesInWhatLacksNothing) {
  write("fabric/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm"));
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), Codes{});
  EXPECT_TRUE(found.accepted());
  ASSERT_EQ(found.materials, 1u);
  const ReviewedMaterial& material = found.files[0].materials[0];
  EXPECT_EQ(material.licence, "CC0-1.0");
  ASSERT_EQ(material.levels.size(), 1u);
  EXPECT_EQ(material.levels[0].evidence, "estimated");
  EXPECT_FALSE(material.nearest.empty()) << "the shipped library has fabrics";
}

TEST_F(Reviewing, NamesAllThatIsMissing) {
  write("fabric/bare.wale", "wale 1\n\nmaterial bare {\n  perceptual { roughness 0.61 }\n}\n");
  const Review found = review_all();
  EXPECT_FALSE(found.accepted());
  // A title, a kind, a name, a translation, a source, documentation, physics, evidence.
  EXPECT_EQ(codes_of(found).count("W0901"), 8u);
}

TEST_F(Reviewing, RefusesLicencesThatForbidToPassOn) {
  const auto with = [&](const std::string& licence) {
    write("fabric/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm", "    licence \"" + licence + "\"\n"));
    return codes_of(review_all());
  };
  for (const char* fit : {"CC-BY-4.0", "MIT OR CC-BY-NC-4.0", "MIT AND CC0-1.0"}) EXPECT_EQ(with(fit), Codes{}) << fit;
  for (const char* unfit : {"CC-BY-NC-4.0", "CC-BY-ND-4.0", "all rights reserved", "MIT AND CC-BY-ND-4.0", "CC-BY"})
    EXPECT_EQ(with(unfit), Codes{"W0903"}) << unfit;
  write("wale.project", "");
  write("fabric/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0902"});
  write("wale.project", "license CC0\n");
  const auto refused = review({root()}, {}, Sandbox::required);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::malformed_value);
}

TEST_F(Reviewing, RefusesWhatNobodyFelt) {
  write("fabric/cord.wale", cord("broad_cord", "0.6 simulated", "3.3 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0909"});
  const auto by = [&](const std::string& grade) {
    std::string text = cord("broad_cord", "0.6 estimated, by bench.planted", "3.3 mm");
    text.insert(text.find("/// Ribs"),
                "map roughness from amplitude {\n  name     bench.planted\n  law      magnitude = (amplitude / 1 N)^0.76\n"
                "  valid    amplitude 0.2 N .. 4 N\n  scatter  0.05\n  evidence slope " + grade + ", anchor " + grade +
                ", handle " + grade + "\n  on       sandpaper\n  source   \"planted observers\"\n}\n\n");
    write("fabric/cord.wale", text);
    return codes_of(review_all());
  };
  EXPECT_EQ(by("estimated"), Codes{});
  EXPECT_EQ(by("simulated"), Codes{"W0909"});
}

TEST_F(Reviewing, FindsNamesThatAreTakenAndWhatFeelsTheSame) {
  write("fabric/one.wale", cord("denim", "0.6 estimated", "3.3 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0904"}) << "the shipped library has a denim";
  write("fabric/one.wale", cord("broad_cord", "0.6 estimated", "3.3 mm"));
  write("fabric/two.wale", cord("other_cord", "0.6 estimated", "3.35 mm"));
  EXPECT_EQ(codes_of(review_all()), (Codes{"W0905", "W0905"}));
  write("fabric/two.wale", cord("other_cord", "0.6 estimated", "6 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{});
  // A new version feels like the old one, and the old one goes.
  write("fabric/two.wale", cord("other_cord", "0.6 estimated", "3.35 mm", "    replaces broad_cord\n"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0908"});
  fs::remove(folder_ / "fabric/one.wale");
  EXPECT_EQ(codes_of(review_all()), Codes{});
}

TEST_F(Reviewing, LooksAtFoldersAndStyle) {
  write("wood/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0906"});
  fs::remove_all(folder_ / "wood");
  write("fabric/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm") + "\n\n\n");
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), Codes{"W0907"});
  EXPECT_TRUE(found.accepted()) << "that is a warning";
}

TEST_F(Reviewing, SaysTheSameInJson) {
  write("fabric/cord.wale", cord("broad_cord", "0.6", "3.3 mm"));
  const auto json = nlohmann::json::parse(review_json(review_all()));
  EXPECT_EQ(json.at("accepted"), false);
  EXPECT_EQ(json.at("errors"), 1);
  EXPECT_EQ(json.at("materials").at(0).at("name"), "broad_cord");
  EXPECT_EQ(json.at("materials").at(0).at("percepts").at("roughness").at("asked_evidence"), nullptr);
  EXPECT_EQ(json.at("diagnostics").at(0).at("code"), "W0901");
}

TEST_F(Reviewing, ReadsWhatCannotBeCompiledToo) {
  write("fabric/broken.wale", "wale 1\n\nmaterial broken {\n  physical { force = }\n}\n");
  write("fabric/empty.wale", "");
  write("fabric/functions.wale", "wale 1\n\nexport function half(a: length): length = a / 2\n");
  const Review found = review_all();
  EXPECT_FALSE(found.accepted());
  EXPECT_FALSE(review({root() + "/none"}, {}, Sandbox::required));
  fs::create_directories(folder_ / "nothing");
  const auto nothing = review({root() + "/nothing"}, {}, Sandbox::required);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::unknown_material);
}

}  // namespace
}  // namespace wale::reviewing_test
