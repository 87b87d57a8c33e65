// `wale find --near`, by levels and ranges; `show`, `between` and `library index`, on a small library of one's own.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/command_line/running.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::command_line::finding_by_feel_test {
namespace {

class ByFeel : public testing::Test {
 protected:
  ByFeel() {
    folder_.write("shelf/wale.project", "licence \"CC0-1.0\"\n");
    for (int i = 1; i <= 5; ++i) {
      const std::string number = std::to_string(i);
      folder_.write("shelf/ribs" + number + ".wale",
                    "wale 1\n/// Ribs.\nmaterial ribs" + number + " {\n  representative {\n    title \"Ribs " + number +
                        "\"\n    called de \"Rippen " + number +
                        "\"\n    kind trial.woven\n  }\n  perceptual { roughness 0." + std::to_string(2 + i) +
                        " estimated }\n  physical { force = lateral(cos(2 pi * x / 2.5 mm)) }\n}\n");
    }
  }
  std::string index() const { return folder_ / "an.index"; }
  void make() const {
    const Outcome made = wale({"library", "index", folder_ / "shelf", "-o", index()});
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_NE(made.out.find("5 materials of 5 files; 5 read anew, 0 gone"), std::string::npos) << made.out;
  }
  static std::vector<std::string> names_in(const std::string& json) {
    std::vector<std::string> names;
    for (const auto& each : nlohmann::json::parse(json)) names.push_back(each.at("name"));
    return names;
  }

  TemporaryFolder folder_;
};

using Names = std::vector<std::string>;

TEST_F(ByFeel, FindsTheNearestFirst) {
  make();
  const Outcome near = wale({"find", "--near", "ribs3", "--index", index(), "--json"});
  ASSERT_EQ(near.status, 0) << near.err;
  // Their levels are 0.3 to 0.7, and a ratio of forces tells them apart: 0.6 is nearer to 0.5 than 0.4 is.
  EXPECT_EQ(names_in(near.out), (Names{"ribs4", "ribs2", "ribs5", "ribs1"}));
  EXPECT_EQ(names_in(wale({"find", "--roughness", "0.41", "--most", "2", "--index", index(), "--json"}).out),
            (Names{"ribs2", "ribs3"}));
  const Outcome range = wale({"find", "--roughness", "0.45..0.65", "--index", index(), "--json"});
  EXPECT_EQ(names_in(range.out), (Names{"ribs3", "ribs4"}));
  EXPECT_EQ(names_in(wale({"find", "--smoothness", "35 % .. 55 %", "--index", index(), "--json"}).out),
            (Names{"ribs3", "ribs4"}))
      << "the other end of the scale";
  EXPECT_EQ(names_in(wale({"find", "rippen", "--near", "ribs1", "--most", "1", "--index", index(), "--json"}).out),
            (Names{"ribs2"}));
  EXPECT_EQ(wale({"find", "--roughness", "0.9..1", "--index", index()}).status, 1);
  EXPECT_EQ(wale({"find", "--near", "ribs1", "--kind", "metal", "--index", index()}).status, 1);
}

TEST_F(ByFeel, ListsWhatLiesBetween) {
  make();
  const Outcome between = wale({"between", "ribs1", "ribs5", "--index", index(), "--json"});
  ASSERT_EQ(between.status, 0) << between.err;
  const auto found = nlohmann::json::parse(between.out);
  ASSERT_EQ(found.size(), 3u);
  for (const auto& each : found) {
    const double one = each.at("from_first").at("low"), other = each.at("from_second").at("low");
    EXPECT_GT(one, 0);
    EXPECT_GT(other, 0);
  }
  const Outcome none = wale({"between", "ribs1", "ribs2", "--index", index()});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no material lies between"), std::string::npos) << none.err;
}

TEST_F(ByFeel, ShowsAllThatIsKnown) {
  make();
  const Outcome shown = wale({"show", "rippen 3", "--index", index()});
  ASSERT_EQ(shown.status, 0) << shown.err;
  for (const char* said : {"Ribs 3 (ribs3)", "called de    Rippen 3", "CC0-1.0", "asked 0.50 (estimated), reads 0.50", "  ribs4"})
    EXPECT_NE(shown.out.find(said), std::string::npos) << said << "\n" << shown.out;
  const Outcome missing = wale({"show", "ribs33", "--index", index()});
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("the nearest: `ribs3`"), std::string::npos) << missing.err;
}

TEST_F(ByFeel, SaysWhatIsWrong) {
  const auto said = [&](std::vector<std::string> words, int status, const std::string& text) {
    const Outcome came = wale(std::move(words));
    EXPECT_EQ(came.status, status) << text;
    EXPECT_NE(came.err.find(text), std::string::npos) << came.err;
    EXPECT_NE(came.err.find("help"), std::string::npos) << came.err;
  };
  said({"find", "--roughness", "2"}, 2, "--roughness: expected a level from 0 to 1");
  said({"find", "--roughness", "0.6..0.4"}, 2, "expected a level from 0 to 1");
  said({"find", "--roughness", "nan"}, 2, "expected a level from 0 to 1");
  said({"find", "--near", "a", "--index", folder_ / "missing"}, 1, "the index cannot be opened");
  said({"show", "a", "--index", folder_.write("text", "no index at all, but a text")}, 1, "no index");
  said({"library", "index", folder_ / "nothing", "-o", index()}, 1, "no such file or folder");
  said({"library", "index", folder_ / "shelf", "-o", folder_ / "no/such/an.index"}, 1, "the index cannot be");
  said({"library", "index", folder_ / "shelf", "-o", index(), "--device", "falcom"}, 2, "nothing declares a device");
}

}  // namespace
}  // namespace wale::command_line::finding_by_feel_test
