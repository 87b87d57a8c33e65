// What a library takes in: `review`.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/modules/load_modules.hpp"
#include "library/review/contribution.hpp"
#include "library/licence/licence.hpp"
#include "library/review/review.hpp"
#include "library/thesis_files/in_wale.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::reviewing_test {
namespace {

namespace fs = std::filesystem;
using Codes = std::multiset<std::string>;

/// A library in a folder of its own.
class Reviewing : public testing::Test {
 protected:
  Reviewing() { write("wale.project", "// a library\nlicence \"CC0-1.0\"\n"); }

  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string root() const { return folder_.path().string(); }

  Result<Review> try_review(const std::string& path) const {
    ReviewRequest request;
    request.paths = {path};
    return review(request);
  }
  Review review_all() const { return *try_review(root()); }

  /// The codes that were found, in alphabetical order.
  static Codes codes_of(const Review& review) {
    Codes codes;
    for (const ReviewedFile& file : review.files)
      for (const Diagnostic& each : file.diagnostics.all()) codes.insert(code_name(each.code));
    return codes;
  }

  TemporaryFolder folder_;
};

/// A material that lacks nothing, in the standard style, of a kind that the shipped library does not have. `more` stands
/// in its representative block.
std::string cord(const std::string& name = "broad_cord", const std::string& level = "0.6 estimated",
                 const std::string& period = "3.3 mm", const std::string& more = "") {
  return "wale 1\n\n" +
         standard_declarations("/// Ribs of cotton pile, felt across.\nmaterial " + name +
                               " {\n  representative {\n    title  \"Cord " + name + "\"\n    called \"corded " + name +
                               "\"\n    called de \"Cordstoff " + name + "\"\n" +
                               "    kind   trial.woven\n    source \"ribs: a ruler; level: an estimate\"\n" + more +
                               "  }\n  perceptual { roughness " + level +
                               " }\n  physical {\n    height ribs = grating(x, period: " + period +
                               ")\n    force = lateral(ribs)\n  }\n}\n");
}

TEST_F(Reviewing, TakesInWhatLacksNothing) {
  write("trial/cord.wale", cord());
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), Codes{});
  EXPECT_TRUE(found.accepted());
  ASSERT_EQ(found.materials, 1u);
  const ReviewedMaterial& material = found.files[0].materials[0];
  EXPECT_EQ(material.licence, "CC0-1.0");
  ASSERT_EQ(material.facts.levels.size(), 1u);
  EXPECT_EQ(material.facts.levels[0].evidence, "estimated");
  ASSERT_TRUE(material.facts.levels[0].reads);
  EXPECT_NEAR(*material.facts.levels[0].reads, 0.6, 0.02);
  EXPECT_TRUE(material.facts.standing.starts_with("stable in the hand")) << material.facts.standing;
  EXPECT_EQ(material.nearest, "") << "the shipped library has no such kind";
}

TEST_F(Reviewing, NamesAllThatIsMissing) {
  write("trial/bare.wale", "wale 1\n\nmaterial bare {\n  perceptual { roughness 0.61 }\n}\n");
  const Review found = review_all();
  EXPECT_FALSE(found.accepted());
  // A title, a kind, a name, a translation, a source, documentation, physics, evidence.
  EXPECT_EQ(codes_of(found).count("W0901"), 8u);
}

TEST_F(Reviewing, RefusesLicencesThatForbidToPassOn) {
  const auto with = [&](const std::string& licence) {
    write("trial/cord.wale", cord("broad_cord", "0.6 estimated", "3.3 mm", "    licence \"" + licence + "\"\n"));
    return codes_of(review_all());
  };
  for (const char* fit : {"CC-BY-4.0", "MIT OR CC-BY-NC-4.0", "MIT AND CC0-1.0"}) EXPECT_TRUE(may_be_shared(fit)) << fit;
  for (const char* unfit : {"CC-BY-NC-4.0", "CC-BY-ND-4.0", "all rights reserved", "MIT AND CC-BY-ND-4.0", "CC-BY", "",
                            "LicenseRef-HaTT-research-only"})
    EXPECT_FALSE(may_be_shared(unfit)) << unfit;
  EXPECT_EQ(with("CC-BY-4.0"), Codes{});
  EXPECT_EQ(with("CC-BY-NC-4.0"), Codes{"W0903"});
  write("wale.project", "");
  write("trial/cord.wale", cord());
  EXPECT_EQ(codes_of(review_all()), Codes{"W0902"});
  write("wale.project", "license CC0\n");
  const auto refused = try_review(root());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::malformed_value);
}

// As the site does, whose programs hold a part of what they rest on.
TEST_F(Reviewing, RefusesWhatRestsOnWhatMayNotBePassedOn) {
  const std::string kept = "    licence \"CC-BY-NC-4.0\"\n";
  write("trial/kept.wale", cord("kept_cord", "0.6 estimated", "6 mm", kept));
  const auto codes_with = [&](const std::string& imports, const std::string& like, const std::string& period) {
    std::string text = cord("own_cord", "0.6 estimated", period);
    text.insert(text.find("/// Ribs"), imports);
    if (!like.empty()) text.replace(text.find("material own_cord"), 17, "material own_cord = " + like);
    write("trial/own.wale", text);
    Codes codes;
    for (const ReviewedFile& file : review_all().files)
      for (const Diagnostic& each : file.diagnostics.all())
        if (file.file.ends_with("own.wale") && each.code == Code::unfit_licence)
          codes.insert(each.message);
    return codes;
  };
  const Codes refused{"`own_cord` may not be passed on: it rests on a file whose licence, CC-BY-NC-4.0, does not allow it"};
  EXPECT_EQ(codes_with("", "", "3.3 mm"), Codes{});
  EXPECT_EQ(codes_with("import trial.kept\n\n", "", "3.3 mm"), refused);
  EXPECT_EQ(codes_with("import trial.kept\n\n", "kept_cord", "3.3 mm"), refused);
  EXPECT_EQ(codes_with("", "kept_cord", "3.3 mm"), refused) << "by its name alone";
  EXPECT_EQ(codes_with("", "0.5 kept_cord + 0.5 denim", "3.3 mm"), refused) << "as a part of a mixture";
  EXPECT_EQ(codes_with("", "denim", "3.3 mm"), Codes{}) << "the shipped library is for everybody";
  write("trial/own.wale", cord("own_cord", "0.6 estimated", "3.3 mm", "    like kept_cord\n"));
  EXPECT_EQ(codes_of(review_all()).count("W0903"), 2u) << "and for that of the one that it is like";
}

// What a check has kept does not outlive the licence of what it rests on.
TEST_F(Reviewing, AsksTheLicenceOfAnotherLibraryAgain) {
  const TemporaryFolder other;
  other.write("wale.project", "licence \"CC0-1.0\"\n");
  other.write("elsewhere/ribs.wale", "wale 1\n\n/// A length.\nexport function ribs_of(a: length) = a\n");
  std::string text = cord("own_cord", "0.6 estimated", "ribs_of(6 mm)");
  text.insert(text.find("/// Ribs"), "import elsewhere.ribs\n\n");
  write("trial/own.wale", text);
  ReviewRequest request;
  request.paths = {root()}, request.roots = {other.path().string()};
  const Review first = *review(request);
  ASSERT_EQ(codes_of(first), Codes{}) << review_json(first);
  request.since = &first.kept;
  EXPECT_EQ(review(request)->unchanged, 1u);
  other.write("wale.project", "licence \"CC-BY-ND-4.0\"\n");
  EXPECT_EQ(codes_of(*review(request)), Codes{"W0903"});
}

// A name that two replace means none of them.
TEST_F(Reviewing, RefusesTwoThatReplaceOneName) {
  write("trial/one.wale", cord("one_cord", "0.6 estimated", "3.3 mm", "    replaces old_cord\n"));
  EXPECT_EQ(codes_of(review_all()), Codes{});
  write("trial/two.wale", cord("two_cord", "0.6 estimated", "6 mm", "    replaces old_cord\n"));
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), (Codes{"W0904", "W0904"}));
  EXPECT_FALSE(found.accepted());
  const std::string& said = found.files[0].diagnostics.all().front().message;
  EXPECT_TRUE(said.starts_with("`one_cord` replaces `old_cord`, and so does `two_cord`")) << said;
}

TEST_F(Reviewing, RefusesPathsOfOneMachine) {
  for (const char* path : {"/tmp/stone.png", "C:/stone.png"}) {
    write("trial/stone.wale", cord("own_stone", "0.6 estimated", "3.3 mm"));
    std::string text = cord("own_stone", "0.6 estimated", "3.3 mm");
    const std::string grating = "grating(x, period: 3.3 mm)";
    text.replace(text.find(grating), grating.size(),
                 "image(\"" + std::string(path) + "\", scale: 0.1 mm/px, height: 1 mm)");
    write("trial/stone.wale", text);
    EXPECT_EQ(codes_of(review_all()).count("W0910"), 1u) << path;
  }
}

TEST_F(Reviewing, RefusesWhatNobodyFelt) {
  write("trial/cord.wale", cord("broad_cord", "0.6 simulated", "3.3 mm"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0915"});
  const auto by = [&](const std::string& grade) {
    std::string text = cord("broad_cord", "0.6 estimated, by bench.planted", "3.3 mm");
    text.insert(text.find("/// Ribs"),
                "map roughness from amplitude {\n  name     bench.planted\n  law      magnitude = (amplitude / 1 N)^0.76\n"
                "  valid    amplitude 0.2 N .. 4 N\n  scatter  0.05\n  evidence slope " + grade + ", anchor " + grade +
                ", handle " + grade + "\n  on       sandpaper\n  source   \"planted observers\"\n}\n\n");
    write("trial/cord.wale", text);
    return codes_of(review_all());
  };
  // A map of forces sets no level on a device that only vibrates.
  EXPECT_EQ(by("estimated"), Codes{"W0911"});
  EXPECT_EQ(by("simulated"), (Codes{"W0911", "W0915"}));
}

TEST_F(Reviewing, FindsNamesThatAreTakenAndWhatFeelsTheSame) {
  write("trial/one.wale", cord("denim"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0904"}) << "the shipped library has a denim";
  write("trial/one.wale", cord());
  write("trial/two.wale", cord("other_cord", "0.6 estimated", "3.35 mm"));
  EXPECT_EQ(codes_of(review_all()), (Codes{"W0905", "W0905"}));
  write("trial/two.wale", cord("other_cord", "0.6 estimated", "6 mm"));
  const Review apart = review_all();
  EXPECT_EQ(codes_of(apart), Codes{});
  EXPECT_EQ(apart.files[0].materials[0].nearest, "other_cord");
  EXPECT_GT(apart.files[0].materials[0].apart, 1);
  // A new version feels like the old one, and the old one goes.
  write("trial/two.wale", cord("other_cord", "0.6 estimated", "3.35 mm", "    replaces broad_cord\n"));
  EXPECT_EQ(codes_of(review_all()), Codes{"W0908"});
  fs::remove(folder_ / "trial/one.wale");
  EXPECT_EQ(codes_of(review_all()), Codes{});
}

TEST_F(Reviewing, WarnsOfWordsThatTwoMaterialsShare) {
  write("trial/one.wale", cord());
  write("trial/two.wale", cord("other_cord", "0.6 estimated", "6 mm", "    called fr \"CORDED broad_cord\"\n"));
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), (Codes{"W0909", "W0909"})) << "in whatever language and capitals";
  EXPECT_TRUE(found.accepted());
}

TEST_F(Reviewing, RefusesWhatDoesNotFeelAsItAsks) {
  // Another force takes most of it away.
  std::string text = cord();
  const std::string felt = "force = lateral(ribs)";
  text.replace(text.find(felt), felt.size(), "force felt    = lateral(ribs)\n    force against = -lateral(ribs, amplitude: 1.5 N)");
  write("trial/cord.wale", text);
  const Review strong = review_all();
  EXPECT_EQ(codes_of(strong).count("W0912"), 1u);
  EXPECT_FALSE(strong.accepted());
}

TEST_F(Reviewing, BuildsForADeviceOfEachClass) {
  const auto common = common_modules();
  const auto others = devices_of_other_classes(common->declarations, default_device);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(common->declarations.devices.find(others[0])->of_class, "vibrating_pad");
}

TEST_F(Reviewing, LooksAtFoldersAndStyle) {
  write("wood/cord.wale", cord());
  EXPECT_EQ(codes_of(review_all()), Codes{"W0906"});
  fs::remove_all(folder_ / "wood");
  write("trial/cord.wale", cord() + "\n\n\n");
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), Codes{"W0907"});
  EXPECT_TRUE(found.accepted()) << "that is a warning";
}

TEST_F(Reviewing, TellsOfEnergyAndShakingWhateverElseIsDoubted) {
  // Two neighbouring noises have nothing in common, so the force may change by twice its amplitude from count to count.
  std::string text = cord();
  const std::string ribs = "grating(x, period: 3.3 mm)";
  text.replace(text.find(ribs), ribs.size(), "noise(x / 5 mm, y / 5 mm)");
  write("trial/cord.wale", text);
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), (Codes{"W0313", "W0604", "W0913"}));
  EXPECT_GT(found.files[0].materials[0].facts.given, 0);
  EXPECT_NE(review_text(found).find("active: gives the hand up to "), std::string::npos);
}

TEST_F(Reviewing, SaysNothingOfWhatItDidNotCompile) {
  std::string text = cord();
  const std::string period = "3.3 mm";
  text.replace(text.find(period), period.size(), "3.3 N");
  write("trial/cord.wale", text);
  const Review found = review_all();
  for (const std::string& code : codes_of(found)) EXPECT_TRUE(code < "W09") << code;
  const std::string told = review_text(found);
  EXPECT_NE(told.find("not checked further, since it does not compile"), std::string::npos) << told;
  EXPECT_EQ(told.find("none of its kind"), std::string::npos);
  // What is not written at all is missing all the same.
  text.erase(text.find("  perceptual"), std::string("  perceptual { roughness 0.6 estimated }\n").size());
  write("trial/cord.wale", text);
  EXPECT_EQ(codes_of(review_all()).count("W0901"), 1u);
}

TEST_F(Reviewing, AsksNoNamesOfFoldersThatAreApart) {
  const std::string bare = "wale 1\n\nmaterial bare {\n  physical {\n    height ribs = grating(x, period: 3 mm)\n"
                           "    force = lateral(ribs, amplitude: 0.2 N)\n  }\n}\n";
  write("trial/bare.wale", bare);
  EXPECT_FALSE(review_all().accepted());
  for (const char* word : {"stimuli", "modules"}) {
    write("wale.project", "licence \"CC0-1.0\"\n" + std::string(word) + " \"trial\"\n");
    EXPECT_EQ(codes_of(review_all()), Codes{}) << word;
  }
  write("wale.project", "stimuli \"trial\"\n");
  EXPECT_EQ(codes_of(review_all()), Codes{"W0902"}) << "a licence is needed all the same";
  EXPECT_TRUE(shipped_project().is_apart("sandpaper") && shipped_project().is_apart("std"));
  EXPECT_FALSE(shipped_project().is_apart("stone"));
}

TEST_F(Reviewing, TakesNoBlankTextsAndNoWordsThatSayNothing) {
  std::string text = cord("broad_cord", "0.6 estimated", "3.3 mm", "    replaces broad_cord\n    licence \" \"\n");
  const auto put = [&](const std::string& old, const std::string& with) { text.replace(text.find(old), old.size(), with); };
  put("ribs: a ruler; level: an estimate", "");
  put("trial.woven", "wovenfabric");
  write("cord.wale", text);
  const Review found = review_all();
  EXPECT_EQ(codes_of(found), (Codes{"W0901", "W0902", "W0908"})) << review_text(found);
  EXPECT_EQ(found.files[0].materials[0].nearest_kind, "fabric.woven");
  text = cord();
  put("Cordstoff broad_cord", "CORDED broad_cord");
  write("cord.wale", text);
  EXPECT_EQ(codes_of(review_all()), Codes{"W0909"}) << text;
  EXPECT_EQ(nearest_licence("CC0"), "CC0-1.0");
  EXPECT_EQ(nearest_licence("cc-by"), "CC-BY-4.0");
}

TEST_F(Reviewing, SaysTheSameInJson) {
  write("trial/cord.wale", cord("broad_cord", "0.6"));
  const Review found = review_all();
  const auto json = nlohmann::json::parse(review_json(found));
  EXPECT_EQ(json.at("accepted"), false);
  EXPECT_EQ(json.at("errors"), 1);
  EXPECT_EQ(json.at("materials").at(0).at("name"), "broad_cord");
  EXPECT_EQ(json.at("materials").at(0).at("percepts").at("roughness").at("asked_evidence"), nullptr);
  EXPECT_EQ(json.at("diagnostics").at(0).at("code"), "W0901");
  EXPECT_NE(review_text(found).find("1 material in 1 file: 1 error, 0 warnings; not accepted\n"), std::string::npos);
}

TEST_F(Reviewing, ReadsWhatCannotBeCompiledToo) {
  write("trial/broken.wale", "wale 1\n\nmaterial broken {\n  physical { force = }\n}\n");
  write("trial/empty.wale", "");
  write("trial/functions.wale", "wale 1\n\nexport function half(a: length): length = a / 2\n");
  EXPECT_FALSE(review_all().accepted());
  EXPECT_FALSE(try_review(root() + "/none"));
  fs::create_directories(folder_ / "nothing");
  const auto nothing = try_review(root() + "/nothing");
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::unknown_material);
}

TEST_F(Reviewing, CompilesOnlyWhatHasChanged) {
  write("std/ribs.wale", "wale 1\n\nexport function ribs(a: length): length = a\n");
  std::string uses = cord("other_cord", "0.6 estimated", "own(6 mm)");
  uses.insert(8, "import trial.own\n\n");
  write("trial/own.wale", "wale 1\n\n/// A length.\nexport function own(a: length) = a\n");
  write("trial/one.wale", cord());
  write("trial/two.wale", uses);
  ReviewRequest request;
  request.paths = {root() + "/trial"};
  const Review first = *review(request);
  ASSERT_EQ(codes_of(first), Codes{}) << review_json(first);
  EXPECT_EQ(first.unchanged, 0u);

  const std::string kept = folder_.write("kept.json", kept_text(first.kept));
  const auto read = read_kept(kept);
  ASSERT_TRUE(read);
  request.since = &*read;
  const Review second = *review(request);
  EXPECT_EQ(second.unchanged, 3u);
  auto before = nlohmann::json::parse(review_json(first)), after = nlohmann::json::parse(review_json(second));
  before.erase("unchanged"), after.erase("unchanged");
  EXPECT_EQ(before, after);

  // A file that another one imports changes both; a comment in one changes that one.
  write("trial/own.wale", "wale 1\n\n/// A length, as it is.\nexport function own(a: length) = a\n");
  EXPECT_EQ(review(request)->unchanged, 1u);
  // What is known of a file does not hide what another one does to it.
  write("trial/three.wale", cord("third_cord", "0.6 estimated", "3.35 mm"));
  const Review third = *review(request);
  EXPECT_EQ(codes_of(third), (Codes{"W0905", "W0905"}));

  for (const char* wrong : {"", "{}", "[1]", "{\"wale review\": 1}", "{\"wale review\": 1, \"build\": 3"}) {
    const auto refused = read_kept(folder_.write("wrong.json", wrong));
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().code, Code::damaged_file);
  }
  const auto other = read_kept(folder_.write("other.json", "{\"wale review\": 1, \"build\": \"another\"}"));
  ASSERT_TRUE(other);
  EXPECT_TRUE(other->reviewed.empty());
}

TEST_F(Reviewing, IsNotHarmedByHostileContributions) {
  const TemporaryFolder outside;
  outside.write("secret.wale", "wale 1\n// the secret\nmaterial secret { }\n");
  write("trial/cord.wale", cord());
  fs::create_symlink(outside.path() / "secret.wale", folder_ / "trial/link.wale");
  fs::create_directory_symlink(outside.path(), folder_ / "trial/away");
  fs::create_directory_symlink(folder_.path(), folder_ / "trial/round");
  write("trial/\x1b[2Jclear.wale", cord("clear_cord", "0.6 estimated", "6 mm"));
  std::string deep = "deep";
  for (int i = 0; i < 40; ++i) deep += "/d";
  write(deep + "/cord.wale", cord("deep_cord", "0.6 estimated", "12 mm"));
  const auto found = contribution_of({root()});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->files.size(), 1u);
  EXPECT_EQ(found->unfit.size(), 5u);
  const Review review = review_all();
  EXPECT_EQ(codes_of(review), (Codes{"W0910", "W0910", "W0910", "W0910", "W0910"}));
  EXPECT_FALSE(review.accepted());
  const std::string json = review_json(review);
  EXPECT_EQ(json.find("the secret"), std::string::npos);
  EXPECT_EQ(json.find('\x1b'), std::string::npos);
}

TEST_F(Reviewing, KeepsTextsAndPicturesOfOthersInTheirPlace) {
  std::string text = cord();
  const std::string title = "Cord broad_cord";
  text.replace(text.find(title), title.size(), "<script>alert(1)</script>");
  write("trial/cord.wale", text);
  EXPECT_EQ(codes_of(review_all()), Codes{});
  // A picture that claims to be far larger than it is, and one outside of the library.
  write("trial/huge.pgm", "P5\n60000 60000\n255\n");
  std::string pictured = cord("other_cord", "0.6 estimated", "6 mm");
  const std::string ribs = "grating(x, period: 6 mm)";
  pictured.replace(pictured.find(ribs), ribs.size(), "image(\"huge.pgm\", scale: 0.1 mm/px, height: 1 mm)");
  write("trial/cord.wale", pictured);
  const Review found = review_all();
  EXPECT_FALSE(found.accepted());
  EXPECT_EQ(codes_of(found).count("W0503") + codes_of(found).count("W0502"), 1u);
}

}  // namespace
}  // namespace wale::reviewing_test
