// The interface for programs that ask for materials and levels by name.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <thread>

#include "tests/temporary_folder.hpp"
#include "wale/library.hpp"

namespace wale::by_name_test {
namespace {

/// An environment variable that has another value for a while.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~EnvironmentVariable() {
    if (before_) setenv(name_, before_->c_str(), 1);
    else unsetenv(name_);
  }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

using Bytes = std::vector<std::byte>;

std::string denim_file() { return std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale"; }

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Bytes bytes_of(const Program& program) {
  const auto bytes = write_patch_program(program.description());
  const auto view = std::as_bytes(std::span(bytes));
  return {view.begin(), view.end()};
}

Bytes bytes_of(const std::string& text) {
  const auto view = std::as_bytes(std::span(text));
  return {view.begin(), view.end()};
}

void expect_denim(const Result<Compiled>& result) {
  static const Bytes denim = bytes_of(Library().open(denim_file())->program);
  ASSERT_TRUE(result) << in_words(result.error());
  EXPECT_EQ(bytes_of(result->program), denim);
}

TEST(ByName, OneMaterialIsTheSameByEveryWay) {
  const Library library;
  const std::string text = text_of(denim_file());
  expect_denim(library.find("denim"));
  expect_denim(library.find("fabric.denim"));
  expect_denim(library.find("fabric.denim:denim"));
  expect_denim(library.find("denim", {.device = "sandpaper"}));
  expect_denim(library.compile(text, {.name = denim_file()}));
  expect_denim(library.open(bytes_of(text), {.name = denim_file()}));
  const Bytes program = bytes_of(library.find("denim")->program);
  expect_denim(library.open(program));
  const TemporaryFolder folder;
  expect_denim(library.open(
      folder.write("denim.wpp", std::string(reinterpret_cast<const char*>(program.data()), program.size()))));

  expect_denim(library.find_later("denim").get());
  expect_denim(library.compile_later(text, {.name = denim_file()}).get());
  expect_denim(library.open_later(denim_file()).get());
  expect_denim(library.open_later(program).get());
  const auto coarse = library.level("roughness", "coarse"), later = library.level_later("roughness", "coarse").get();
  ASSERT_TRUE(coarse && later);
  EXPECT_EQ(bytes_of(coarse->program), bytes_of(later->program));
}

TEST(ByName, MaterialsOfOnesOwnFoldersGoFirstAndThatIsSaid) {
  const TemporaryFolder folder;
  folder.write("mine/denim.wale", text_of(denim_file()));
  const Library library({.folders = {folder.path().string()}});
  for (const char* name : {"denim", "mine.denim"}) {
    const Result<Compiled> own = library.find(name);
    ASSERT_TRUE(own) << in_words(own.error());
    EXPECT_EQ(own->taken.find(folder / "mine/denim.wale") != std::string::npos, std::string(name) == "denim")
        << name << ": " << own->taken;
  }
  EXPECT_EQ(Library().find("denim")->taken, "");
  EXPECT_FALSE(Library().find("mine.denim"));
}

TEST(ByName, ErrorsAreAboutTheArgument) {
  const Library library;
  const std::string huge(1 << 20, 'a');
  const struct {
    Result<Compiled> result;
    Code code;
    const char* place;
    std::vector<std::string> first;  ///< of `nearest`
  } cases[] = {
      {library.level("rougness", "coarse"), Code::unknown_name, "percept", {"roughness"}},
      {library.level("", "coarse"), Code::malformed_value, "percept", {}},
      {library.level("rough\xff\x1bness", "coarse"), Code::invalid_encoding, "percept", {}},
      {library.level("rough\x1bness", "coarse"), Code::malformed_value, "percept", {}},
      {library.level(huge, "coarse"), Code::unknown_name, "percept", {}},
      {library.level("roughness", "coarze"), Code::unknown_name, "level", {"coarse"}},
      {library.level("roughness", "coarse", {.material = "x"}), Code::unknown_material, "material", {}},
      {library.find("fabric.corduroy:corduroi"), Code::unknown_material, "name", {"corduroy"}},
      {library.find("denim", {.name = "a\nb"}), Code::malformed_value, "name", {}},
      {library.level("roughness", "0.5 } }"), Code::malformed_value, "level", {}},
      {library.level("roughness", ""), Code::malformed_value, "level", {}},
      {library.level("roughness", huge), Code::malformed_value, "level", {}},
      {library.level("roughness", "\xff"), Code::malformed_value, "level", {}},
      {library.level("roughness", "-0.5"), Code::level_out_of_range, "level", {}},
      {library.level("roughness", "-"), Code::malformed_value, "level", {}},
      {library.level("roughness", "0x.8p0"), Code::malformed_value, "level", {}},
      {library.level("roughness", ".5"), Code::malformed_value, "level", {}},
      {library.level("roughness", "5."), Code::malformed_value, "level", {}},
      {library.level("roughness", "1e"), Code::malformed_value, "level", {}},
      {library.level("roughness", "nan"), Code::malformed_value, "level", {}},
      {library.level("roughness", "-Infinity"), Code::malformed_value, "level", {}},
      {library.level("roughness", "-1e-14"), Code::level_out_of_range, "level", {}},
      {library.compile("wale 1\n", {.name = "\xff"}), Code::invalid_encoding, "name", {}},
      {library.compile("wale 1\n", {.name = "a\nb"}), Code::malformed_value, "name", {}},
      {library.find("\xc2\xa0"), Code::malformed_value, "name", {}},           // a no-break space
      {library.find("den\xe2\x80\xa8im"), Code::malformed_value, "name", {}},  // a separator of lines
      {library.level("roughness", "1.5"), Code::level_out_of_range, "level", {}},
      {library.level("roughness", "coarse", {.device = "falcom"}), Code::unknown_device, "device", {"falcon"}},
      {library.find("denim", {.device = "falcom"}), Code::unknown_device, "device", {"falcon"}},
      {library.find("denim", {.material = "denin"}), Code::unknown_material, "material", {"denim"}},
      {library.open(denim_file(), {.material = "velvet"}), Code::unknown_material, "material", {}},
      {library.find("corderoy"), Code::unknown_name, "name", {"corduroy"}},
      {library.find("corduroy.wale"), Code::unknown_name, "name", {"corduroy"}},  // `open` reads files
      {library.find("mesh"), Code::unknown_name, "name", {"aluminium_mesh"}},  // a word of names
      {library.find(""), Code::malformed_value, "name", {}},
      {library.find(" "), Code::malformed_value, "name", {}},
      {library.find("\t\n"), Code::malformed_value, "name", {}},
      {library.find("den\nim"), Code::malformed_value, "name", {}},
      {library.find(std::string("den\0im", 6)), Code::invalid_encoding, "name", {}},
      {library.find("denim", {.device = "\xff"}), Code::invalid_encoding, "device", {}},
      {library.find("denim", {.device = " "}), Code::malformed_value, "device", {}},
      {library.find("denim", {.material = "a\nb"}), Code::malformed_value, "material", {}},
      {library.find("mechanism"), Code::unknown_name, "name", {}},  // a kind
      {library.find(huge), Code::unknown_name, "name", {}},
      {library.find("den\xffim"), Code::invalid_encoding, "name", {}},
      {library.find("denim:"), Code::malformed_value, "name", {}},
      {library.find(denim_file()), Code::unknown_name, "name", {}},  // a path is no name
      {library.find("corderoy:denim"), Code::unknown_name, "name", {"corduroy"}},
  };
  for (const auto& each : cases) {
    ASSERT_FALSE(each.result);
    const Error& error = each.result.error();
    EXPECT_EQ(error.code, each.code) << error.sentence.substr(0, 300);
    EXPECT_EQ(error.place.name, each.place) << error.sentence.substr(0, 300);
    EXPECT_EQ(error.place.number, std::nullopt);
    EXPECT_EQ(error.place.column, std::nullopt);
    EXPECT_LE(error.nearest.size(), 3u);
    EXPECT_LT(error.sentence.size(), 400u);
    EXPECT_FALSE(error.mend.empty() && error.nearest.empty()) << error.sentence;
    EXPECT_TRUE(in_words(error).starts_with(error.place.name + ": ")) << in_words(error).substr(0, 300);
    if (!each.first.empty()) {
      ASSERT_FALSE(error.nearest.empty()) << error.sentence;
      EXPECT_EQ(error.nearest.front(), each.first.front());
      EXPECT_NE(error.mend.find("`" + each.first.front() + "`"), std::string::npos) << error.mend;
    }
  }
}

TEST(ByName, AFolderThatDoesNotExistIsAnErrorOfEachProgram) {
  const TemporaryFolder folder;
  const std::string missing = folder / "missing";
  const Library library({.folders = {folder.path().string(), missing}});
  ASSERT_FALSE(library.folders_exist());
  for (const Result<Compiled>& result :
       {library.find("denim"), library.level("roughness", "coarse"), library.compile(text_of(denim_file())),
        library.open(denim_file()), library.find_later("denim").get()}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, Code::unreadable_file);
    EXPECT_EQ(result.error().place.text, missing);
  }
  EXPECT_TRUE(Library({.folders = {folder.path().string()}}).folders_exist());
}

TEST(ByName, AFolderThatIsNoneIsToldByWhatItIs) {
  const TemporaryFolder folder;
  const auto told = [](std::vector<std::string> folders) {
    const auto exist = Library({.folders = std::move(folders)}).folders_exist();
    return exist ? std::string() : exist.error().sentence;
  };
  EXPECT_NE(told({folder.write("a.wale", "wale 1\n")}).find("is a file"), std::string::npos);
  EXPECT_NE(told({""}).find("empty text"), std::string::npos);
  EXPECT_NE(told({folder / "none"}).find("no such folder"), std::string::npos);
}

TEST(ByName, AWrongFolderOfTheEnvironmentIsAnError) {
  const TemporaryFolder folder;
  const EnvironmentVariable variable("WALE_LIBRARY", folder / "none");
  const auto found = Library().find("denim");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::unreadable_file);
  EXPECT_EQ(found.error().place.name, "WALE_LIBRARY");
  EXPECT_EQ(found.error().place.text, folder / "none");
}

TEST(ByName, FoldersStayWhereTheyWereWhenTheLibraryWasMade) {
  const TemporaryFolder folder;
  folder.write("shelf/mine.wale", "wale 1\nmaterial mine { physical { force = vector(0.5 N * sin(x / 1 mm), 0 N) } }\n");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const Library library({.folders = {"shelf"}});
  std::filesystem::current_path("/");
  const auto found = library.find("mine");
  std::filesystem::current_path(before);
  EXPECT_TRUE(found) << in_words(found.error());
}

TEST(ByName, AnErrorInTheOwnersDevicesIsToldWithADeviceThatIsUnknown) {
  const TemporaryFolder folder;
  folder.write("wale/devices.wale", "wale 1\nexport device mine { rubbish }\n");
  const EnvironmentVariable variable("XDG_CONFIG_HOME", folder.path().string());
  const Library library;
  EXPECT_TRUE(library.find("denim")) << "shipped devices do not depend on that file";
  const CompileOptions mine{.device = "mine"};
  for (const auto& result : {library.find("denim", mine), library.level("roughness", "0.5", mine)}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, Code::unknown_device);
    ASSERT_EQ(result.error().others.size(), 1u);
    EXPECT_NE(result.error().others.front().place.name.find("devices.wale"), std::string::npos);
    EXPECT_NE(result.error().mend.find("devices.wale"), std::string::npos);
  }
}

TEST(ByName, ALevelThatTheDeviceCannotRenderIsAnError) {
  const Library library;
  for (const char* device : {"gamepad", "touch_pad"}) {
    const auto lost = library.level("viscosity", "0.9", {.device = device});
    ASSERT_FALSE(lost) << device;
    EXPECT_EQ(lost.error().code, Code::percept_unrealised);
    EXPECT_EQ(lost.error().place.name, "percept");
    EXPECT_NE(lost.error().sentence.find(device), std::string::npos);
    EXPECT_FALSE(lost.error().mend.empty());
    EXPECT_TRUE(library.level("roughness", "0.5", {.device = device})) << device;
  }
  EXPECT_TRUE(library.level("viscosity", "0.9"));
}

TEST(ByName, ErrorsInATextHaveTheirPlaceAndTheirParts) {
  const std::string wrong_line = "material m { physical { force = 3 m } }";
  const Result<Compiled> wrong = Library().compile("wale 1\n" + wrong_line + "\n", {.name = "my.wale"});
  ASSERT_FALSE(wrong);
  const Error& error = wrong.error();
  EXPECT_EQ(severity_of(error.code), Severity::error);
  EXPECT_EQ(error.place.name, "my.wale");
  EXPECT_EQ(error.place.number, 2u);
  EXPECT_EQ(error.place.column, wrong_line.find("3 m") + 1);
  EXPECT_EQ(error.place.length, std::string("3 m").size());
  EXPECT_EQ(error.place.text, wrong_line);
  EXPECT_FALSE(error.expected.empty() && error.mend.empty());
  EXPECT_TRUE(in_words(error).starts_with("my.wale:2:" + std::to_string(*error.place.column) + ": " + error.sentence));
  EXPECT_TRUE(error.others.empty());

  // Columns count characters, not bytes.
  const std::string letter = "material m { physical { force = vector(1 N * ä, 0 N) } }";
  const Result<Compiled> two =
      Library().compile("wale 1\n" + letter + "\nmaterial n { physical { force = vector(/* ää */ 1 N * no, 0 N) } }\n");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, Code::unexpected_character);
  EXPECT_EQ(two.error().place.column, letter.find("ä") + 1);
  ASSERT_EQ(two.error().others.size(), 1u);
  const Error& other = two.error().others.front();
  EXPECT_EQ(other.code, Code::unknown_name);
  EXPECT_EQ(other.place.number, 3u);
  EXPECT_EQ(other.place.column, 55u) << "two letters before it have two bytes each";
  EXPECT_EQ(other.place.name, "text");
}

TEST(ByName, WarningsComeWithTheProgram) {
  // `unused` is a name that nothing uses (W0209), in line 4.
  const std::string text =
      "wale 1\nmaterial m {\n  physical {\n    let unused = 3 mm\n    force = vector(0.5 N * sin(x / 1 mm), 0 N)\n  "
      "}\n}\n";
  const Result<Compiled> compiled = Library().compile(text);
  ASSERT_TRUE(compiled) << in_words(compiled.error());
  const auto unused = std::ranges::find(compiled->warnings, Code::unused_name, &Error::code);
  ASSERT_NE(unused, compiled->warnings.end());
  EXPECT_EQ(severity_of(unused->code), Severity::warning);
  EXPECT_EQ(unused->place.name, "text");
  EXPECT_EQ(unused->place.number, 4u);
  EXPECT_EQ(unused->place.column, 9u);
}

TEST(ByName, WhatIsNoFileOfOursIsRefused) {
  const Library library;
  const TemporaryFolder folder;
  const auto code = [](const Result<Compiled>& result) {
    EXPECT_FALSE(result);
    return result ? Code{} : result.error().code;
  };
  EXPECT_EQ(code(library.compile("")), Code::missing_version);
  EXPECT_EQ(code(library.compile("wale 1\n\xff\xfe")), Code::invalid_encoding);
  EXPECT_EQ(code(library.compile("wale 1\n" + std::string(5 << 20, ' '))), Code::too_long);
  EXPECT_EQ(code(library.compile("wale 1\nmaterial m { physical { force = " + std::string(100'000, '('))),
            Code::nested_too_deep);
  EXPECT_EQ(code(library.compile_later("wale 1\nmaterial m { physical { force = " + std::string(100'000, '(')).get()),
            Code::nested_too_deep);
  EXPECT_EQ(code(library.open(folder / "missing.wale")), Code::unreadable_file);
  EXPECT_EQ(code(library.open(folder / "")), Code::unreadable_file);
  EXPECT_EQ(code(library.open(std::string())), Code::unreadable_file);
  EXPECT_EQ(code(library.open("/dev/null")), Code::unreadable_file);
  EXPECT_EQ(code(library.open(folder.write("picture.wale", "\x89PNG\r\n\x1a\n"))), Code::damaged_file);
  EXPECT_EQ(code(library.open(bytes_of(std::string("\x89PNG\r\n\x1a\n")))), Code::damaged_file);
  Bytes program = bytes_of(library.find("denim")->program);
  EXPECT_EQ(code(library.open(program, {.device = "falcon"})), Code::other_device);
  EXPECT_EQ(code(library.open(program, {.material = "velvet"})), Code::unknown_material);
  program.resize(program.size() / 2);
  EXPECT_FALSE(library.open(program));
  EXPECT_FALSE(library.open(std::span<const std::byte>()));
}

TEST(ByName, TwoThreadsGetTheSameAsOne) {
  const Library library;
  const auto work = [&] {
    for (int i = 0; i < 3; ++i) {
      expect_denim(library.find("denim"));
      EXPECT_TRUE(library.level("roughness", "0.4"));
      EXPECT_FALSE(library.find("denin"));
      EXPECT_TRUE(library.level_later("roughness", "fine").get());
    }
  };
  std::thread other(work);
  work();
  other.join();
}

TEST(ByName, FuturesOutliveTheirLibrary) {
  std::vector<std::future<Result<Compiled>>> all;
  std::optional<Library> library(std::in_place);
  for (int i = 0; i < 40; ++i) all.push_back(library->find_later("denim"));
  library.reset();
  long done = 0, dropped = 0;
  for (auto& each : all) {
    ASSERT_EQ(each.wait_for(std::chrono::seconds(0)), std::future_status::ready);
    const Result<Compiled> result = each.get();
    if (result) {
      EXPECT_EQ(dropped, 0) << "the pieces are done in their order";
      expect_denim(result);
      ++done;
    } else {
      EXPECT_EQ(result.error().code, Code::wrong_moment);
      ++dropped;
    }
  }
  EXPECT_EQ(done + dropped, 40);
  EXPECT_GT(dropped, 0) << "forty take longer than to ask for them";
  { const Library never_asked; }
}

}  // namespace
}  // namespace wale::by_name_test
