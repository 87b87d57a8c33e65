// `Library::search`, `nearest` and `between` give programs what `wale find` and `wale between` print.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "tests/command_line/running.hpp"
#include "wale/library.hpp"

namespace wale::for_programs_test {
namespace {

using command_line::Outcome;
using Json = nlohmann::json;

/// A variable of the environment, for the time of a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* was = std::getenv(name)) was_ = was;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { was_ ? setenv(name_, was_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> was_;
};

/// A shelf of ribs, and of denim, some cues of which are not known beside theirs.
class ForPrograms : public testing::Test {
 protected:
  ForPrograms() {
    folder_.write("shelf/wale.project", "licence \"CC0-1.0\"\n");
    for (int i = 1; i <= 5; ++i) {
      const std::string number = std::to_string(i);
      folder_.write("shelf/ribs" + number + ".wale",
                    "wale 1\n/// Ribs.\nmaterial ribs" + number + " {\n  representative {\n    title \"Ribs " + number +
                        "\"\n    called de \"Rippen " + number + "\"\n    kind trial." + (i % 2 ? "woven" : "knitted") +
                        "\n  }\n  perceptual { roughness 0." + std::to_string(2 + i) +
                        " estimated }\n  physical { force = lateral(cos(2 pi * x / 2.5 mm)) }\n}\n");
    }
    folder_.write("shelf/denim.wale", command_line::bytes_of(std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale"));
  }
  void SetUp() override {
    const Outcome made = command_line::wale({"library", "index", folder_ / "shelf", "-o", index()});
    ASSERT_NE(made.out.find("materials of 6 files"), std::string::npos) << made.out << made.err;
  }
  std::string index() const { return folder_ / "an.index"; }
  LibraryOptions in_index() const {
    LibraryOptions options;
    options.index = index();
    return options;
  }
  Json told(std::vector<std::string> words) const {
    words.insert(words.end(), {"--index", index(), "--json"});
    const Outcome printed = command_line::wale(words);
    EXPECT_EQ(printed.status, 0) << words.at(1) << ": " << printed.err;
    return printed.status == 0 ? printed.json() : Json::array();
  }
  TemporaryFolder folder_;
};

void expect_same(const FeltDistance& distance, const Json& json) {
  EXPECT_EQ(distance.low, json.at("low").get<double>());
  if (json.at("high").is_null())
    EXPECT_TRUE(std::isinf(distance.high));
  else
    EXPECT_EQ(distance.high, json.at("high").get<double>());
  EXPECT_EQ(distance.unknown, json.at("unknown").get<std::vector<std::string>>());
  EXPECT_EQ(distance.plainest, json.at("plainest").get<std::string>());
}

void expect_same(const Result<SearchResult>& result, const Json& printed) {
  ASSERT_TRUE(result) << in_words(result.error());
  EXPECT_TRUE(result->warnings.empty()) << in_words(result->warnings.front());
  ASSERT_EQ(result->matches.size(), printed.size());
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const Match& match = result->matches[i];
    const Json& json = printed[i];
    EXPECT_EQ(match.name, json.at("name").get<std::string>());
    EXPECT_EQ(match.title, json.at("title").get<std::string>());
    EXPECT_EQ(match.kind, json.at("kind").get<std::string>());
    EXPECT_EQ(match.file, json.value("file", match.file));
    EXPECT_EQ(match.module, json.value("module", match.module));
    EXPECT_EQ(match.score, json.value("score", 0.0));
    EXPECT_EQ(match.distance.has_value(), json.contains("distance") || json.contains("from_first"));
    if (json.contains("distance")) expect_same(*match.distance, json.at("distance"));
    if (json.contains("from_first")) expect_same(*match.distance, json.at("from_first"));
    if (json.contains("from_second")) expect_same(*match.from_other, json.at("from_second"));
  }
}

TEST_F(ForPrograms, AnswersAreThoseOfTheCommandLine) {
  const Library library(in_index());
  const auto near = library.nearest("ribs3");
  expect_same(near, told({"find", "--near", "ribs3"}));
  ASSERT_EQ(near->matches.size(), 5u);
  EXPECT_EQ(near->matches.front().name, "ribs4");
  EXPECT_FALSE(near->matches.back().distance->unknown.empty()) << "a cue that is unknown is named";
  expect_same(library.nearest("rippen 3", {.kind = "trial.woven", .most = 1}),
              told({"find", "--near", "rippen 3", "--kind", "trial.woven", "--most", "1"}));
  expect_same(library.search("", {.percepts = {{"roughness", 0.41, 0.41}}, .most = 2}),
              told({"find", "--roughness", "0.41", "--most", "2"}));
  expect_same(library.search("rippen", {.percepts = {{"smoothness", 0.35, 0.55}}}),
              told({"find", "rippen", "--smoothness", "0.35..0.55"}));
  expect_same(library.search("", {.percepts = {{"roughness", 0.5, 0.5}}, .near = "ribs1"}),
              told({"find", "--roughness", "0.5", "--near", "ribs1"}));
  expect_same(library.search("denim ribs"), told({"find", "denim ribs"}));
  expect_same(library.between("ribs1", "ribs5"), told({"between", "ribs1", "ribs5"}));
  const std::string own = folder_.write("own.wale", "wale 1\nmaterial own { perceptual { roughness 0.62 } }\n");
  expect_same(library.nearest(own), told({"find", "--near", own}));
  expect_same(library.nearest_later("ribs2").get(), told({"find", "--near", "ribs2"}));
  // Each match names a material for `find` and for another search.
  for (const Match& each : near->matches) {
    const auto again = library.nearest(each.module + ":" + each.name), by_name = library.nearest(each.name);
    ASSERT_TRUE(again && by_name) << each.name;
    ASSERT_EQ(again->matches.size(), by_name->matches.size());
    EXPECT_EQ(again->matches.front().name, by_name->matches.front().name);
  }
  const double not_a_number = std::nan("");
  EXPECT_EQ(library.search("", {.percepts = {{"roughness", not_a_number, 1}}}).error().code, Code::malformed_value);
}

/// Words alone need no index: the catalogue is that of `wale find`.
TEST_F(ForPrograms, FindsWordsInTheLibraryItself) {
  const Library library;
  for (const std::string text : {"rough ribbed cotton", "ribbed", "Cord", "no such thing at all"}) {
    const Outcome printed = command_line::wale({"find", text, "--json"});
    expect_same(library.search(text), printed.json());
  }
  const auto denim = library.search("ribbed cotton", {.kind = "fabric", .most = 1});
  ASSERT_TRUE(denim);
  EXPECT_EQ(denim->matches.at(0).name, "corduroy");
  EXPECT_EQ(denim->matches.at(0).found_by, "called");
  EXPECT_TRUE(library.find(denim->matches.at(0).module + ":" + denim->matches.at(0).name)) << "a match can be compiled";
}

TEST_F(ForPrograms, ErrorsNameTheArgument) {
  const Library library(in_index());
  const auto refused = [](const Result<SearchResult>& result, Code code, const char* argument, const std::string& nearest = {}) {
    ASSERT_FALSE(result) << argument;
    EXPECT_EQ(result.error().code, code) << in_words(result.error());
    EXPECT_EQ(result.error().place.name, argument) << in_words(result.error());
    if (nearest.empty()) return;
    ASSERT_FALSE(result.error().nearest.empty());
    EXPECT_EQ(result.error().nearest.front(), nearest);
  };
  refused(library.nearest("ribs33"), Code::unknown_name, "material", "ribs3");
  refused(library.search("", {.near = "ribs33"}), Code::unknown_name, "near", "ribs3");
  refused(library.between("ribs1", "ripps2"), Code::unknown_name, "other");
  refused(library.nearest(" "), Code::malformed_value, "material");
  refused(library.nearest("ribs1", {.near = "ribs2"}), Code::malformed_value, "near");
  refused(library.nearest("ribs1", {.kind = "trial.wovn"}), Code::unknown_name, "kind", "trial.woven");
  refused(library.search("", {.percepts = {{"roughnes", 0, 1}}}), Code::unknown_name, "percept", "roughness");
  refused(library.search("", {.percepts = {{"roughness", 0.5, 0.2}}}), Code::level_out_of_range, "percepts");
  refused(library.search("", {.percepts = {{"roughness", std::nan(""), 0.2}}}), Code::malformed_value, "percepts");
  refused(library.nearest("ribs1", {.device = "falcon"}), Code::other_device, "device");
  refused(library.nearest("ribs1", {.device = "falcom"}), Code::unknown_device, "device", "falcon");
  refused(library.search("\xff"), Code::invalid_encoding, "text");
  LibraryOptions missing;
  missing.index = folder_ / "missing.index";
  refused(Library(missing).nearest("ribs1"), Code::unreadable_file, missing.index.c_str());
}

TEST_F(ForPrograms, AFileOfOnesOwnIsNotNearItself) {
  const Library library(in_index());
  for (const std::string& file : {folder_ / "shelf/ribs3.wale", folder_ / "shelf/../shelf/ribs3.wale:ribs3"}) {
    expect_same(library.nearest(file), told({"find", "--near", "ribs3"}));
    EXPECT_EQ(library.nearest(file, {.most = 1})->matches.at(0).name, "ribs4");
  }
  // Another file of that name is another material.
  const std::string copy = folder_.write("ribs3.wale", command_line::bytes_of(folder_ / "shelf/ribs3.wale"));
  EXPECT_EQ(library.nearest(copy, {.most = 1})->matches.at(0).name, "ribs3");
}

TEST_F(ForPrograms, ErrorsInAFileOfOnesOwnAreItsOwn) {
  const Library library(in_index());
  const std::string own = folder_.write("own.wale", "wale 1\nmaterial own { perceptual { roughnes 0.62 } }\n");
  const auto opened = library.open(own);
  ASSERT_FALSE(opened);
  for (const auto& result : {library.nearest(own), library.search("", {.near = own}), library.between("ribs1", own)}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, opened.error().code) << in_words(result.error());
    EXPECT_EQ(result.error().place.name, own);
    EXPECT_EQ(result.error().place.number, 2u);
    EXPECT_EQ(in_words(result.error()), in_words(opened.error()));
  }
}

TEST_F(ForPrograms, MendsAreInTheWordsOfTheInterface) {
  const Library library(in_index());
  EXPECT_EQ(library.nearest("zzzzzzzzzzzzzzz").error().mend.find("wale find"), std::string::npos);
  const Error missing = library.nearest("zzz.wale").error();
  EXPECT_EQ(missing.code, Code::unreadable_file);
  EXPECT_NE(missing.sentence.find("zzz.wale"), std::string::npos) << missing.sentence;
  EXPECT_EQ(missing.mend.find("`nearest`"), std::string::npos) << missing.mend;
  EXPECT_EQ(library.search("a\nb").error().sentence.find("a name"), std::string::npos);
  LibraryOptions other;
  other.index = folder_.write("no.index", std::string(5000, 'x'));
  const auto refused = Library(other).nearest("ribs1");
  EXPECT_EQ(refused.error().code, Code::damaged_file);
  EXPECT_TRUE(refused.error().mend.starts_with("name another file")) << refused.error().mend;
}

/// Without an index one is kept in the user's cache; that can be seen and ended, and goes on where it was.
TEST_F(ForPrograms, ReadsALibraryThatCanBeStopped) {
  const Variable cache("XDG_CACHE_HOME", folder_ / "cache");
  LibraryOptions options;
  options.folders = {folder_ / "shelf"};
  const Library library(options);
  std::size_t told = 0, of = 0;
  const auto stopped = library.nearest("corduroy", {.progress = [&](std::size_t done, std::size_t all) {
                                         EXPECT_EQ(done, ++told) << "each file once, one at a time";
                                         of = all;
                                         return done < 8;
                                       }});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::stopped) << in_words(stopped.error());
  EXPECT_EQ(told, 8u);
  std::size_t left = 0;
  const auto again = library.nearest("corduroy", {.progress = [&](std::size_t, std::size_t all) {
                                       left = all;
                                       return false;
                                     }});
  EXPECT_EQ(again.error().code, Code::stopped);
  EXPECT_EQ(left, of - 8) << "what was read is kept";
  // What it throws comes out of the search, also by a future.
  const SearchOptions throwing{.progress = [](std::size_t, std::size_t) -> bool { throw std::runtime_error("enough"); }};
  EXPECT_THROW(library.nearest("corduroy", throwing), std::runtime_error);
  EXPECT_THROW(library.nearest_later("corduroy", throwing).get(), std::runtime_error);
  // An unknown name is known to be none before anything is read, and so is one of the command line.
  const auto unknown = library.nearest("nix", {.progress = [](std::size_t, std::size_t) -> bool {
                                         ADD_FAILURE();
                                         return false;
                                       }});
  EXPECT_EQ(unknown.error().code, Code::unknown_name) << in_words(unknown.error());
  EXPECT_EQ(command_line::wale({"show", "nix"}).status, 1);
  // The destructor does not wait until all is read.
  std::optional<Library> short_lived(std::in_place, options);
  auto future = short_lived->nearest_later("corduroy");
  short_lived.reset();
  const auto ended = future.get();
  ASSERT_FALSE(ended);
  EXPECT_TRUE(ended.error().code == Code::stopped || ended.error().code == Code::wrong_moment) << in_words(ended.error());
}

TEST(BeforeALibraryIsRead, WhatIsWrongWithAFileIsTold) {
  const TemporaryFolder folder;
  const Variable cache("XDG_CACHE_HOME", folder / "cache");  // there is no index yet
  folder.write("empty.wale", "");
  folder.write("broken.wale", "wale 1\nmaterial m { physical { force = 3 mm } }\n");
  folder.write("none.wale", "wale 1\nlet a = 1\n");
  const Library library;
  int told = 0;
  const SearchOptions options{.progress = [&](std::size_t, std::size_t) { return ++told, false; }};
  const std::pair<const char*, Code> files[] = {{"missing.wale", Code::unreadable_file},
                                                {"empty.wale", Code::missing_version},
                                                {"broken.wale", Code::wrong_dimension},
                                                {"none.wale", Code::unknown_material}};
  for (const auto& [name, code] : files) {
    const std::string path = folder / name;
    for (const auto& result : {library.nearest(path, options), library.between("denim", path, options),
                               library.between(path, "denim", options)}) {
      ASSERT_FALSE(result) << name;
      EXPECT_EQ(result.error().code, code) << in_words(result.error());
    }
  }
  EXPECT_EQ(told, 0);
  folder.write("good.wale", "wale 1\nmaterial m { physical { force = lateral(sin(2 pi * x / 3 mm), amplitude: 1 N) } }\n");
  const auto stopped = library.nearest(folder / "good.wale", options);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::stopped);
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace wale::for_programs_test
