// What the index and the site know of one material.
#include "compiler/read/kept_readings.hpp"
#include "library/index/entry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "library/index/content_hash.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::entry_test {
namespace {

constexpr const char* cord = R"(wale 1
import parts.ribs

/// Ribbed cotton.
material cord {
  representative {
    title "Wide cord"
    called "ribbed cotton"
    called de "Breitcord", "Kord"
    kind fabric.woven
    feels "like a washboard"
    replaces old_cord
    source "An estimate of the authors."
  }
  perceptual { roughness 0.6 estimated }
  physical {
    param wale = 2.5 mm in 1 mm .. 5 mm
    height ribs = ribs_of(x, wale)
    force = lateral(ribs)
  }
}

material wrong { physical { force = 3 } }
)";
constexpr const char* ribs = "wale 1\nexport function ribs_of(x, wale) = grating(x, period: wale, duty: 0.5, smooth: 24/256)\n";

struct Shelf {
  Shelf() {
    folder.write("wale.project", "licence \"CC0-1.0\"\n");
    folder.write("parts/ribs.wale", ribs);
    file = folder.write("fabric/cord.wale", cord);
  }
  FileEntries read() const {
    auto read = read_entries({.file = file, .roots = {folder.path()}}, "fabric.cord");
    EXPECT_TRUE(read) << (read ? "" : in_words(read.error()));
    return read ? *std::move(read) : FileEntries{};
  }
  TemporaryFolder folder;
  std::string file;
};

TEST(Entry, HasAllThatTheTextSays) {
  Shelf shelf;
  shelf.folder.write("fabric/cord.wale", std::string(cord, std::string_view(cord).find("material wrong")));
  const FileEntries read = shelf.read();
  ASSERT_EQ(read.entries.size(), 1u);
  const Entry& entry = read.entries.front();
  EXPECT_EQ(entry.name, "cord");
  EXPECT_EQ(entry.module, "fabric.cord");
  EXPECT_EQ(entry.folder, "fabric");
  EXPECT_EQ(entry.title, "Wide cord");
  EXPECT_EQ(entry.names, (std::vector<EntryName>{{"en", "ribbed cotton"}, {"de", "Breitcord"}, {"de", "Kord"}}));
  EXPECT_EQ(entry.replaces, std::vector<std::string>{"old_cord"});
  EXPECT_EQ(entry.licence, "CC0-1.0");
  EXPECT_EQ(entry.asks, std::vector<std::string>{"roughness"});
  EXPECT_EQ(entry.trouble, "");
  ASSERT_EQ(entry.parameters.size(), 2u);  // the level is one too
  EXPECT_TRUE(std::ranges::any_of(entry.parameters, [](const Parameter& each) { return each.name == "wale"; }));
}

TEST(Entry, HasWhatTheProgramReads) {
  Shelf shelf;
  shelf.folder.write("fabric/cord.wale", std::string(cord, std::string_view(cord).find("material wrong")));
  const FileEntries read = shelf.read();
  ASSERT_EQ(read.entries.size(), 1u);
  const EntryFeel& felt = read.entries.front().felt;
  const EntryPercept* roughness = felt.percept("roughness");
  ASSERT_NE(roughness, nullptr);
  EXPECT_EQ(roughness, &felt.percepts.front());
  EXPECT_NEAR(roughness->asked.value_or(0), 0.6, 1e-6);
  EXPECT_NEAR(roughness->reads.value_or(0), 0.6, 0.01);
  EXPECT_EQ(roughness->claimed, Evidence::estimated);
  // README.md: roughness 0.6 is 1.93 N of lateral amplitude.
  EXPECT_NEAR(roughness->size, 1.934, 0.01);
  EXPECT_EQ(roughness->unit, "N");
  EXPECT_LT(roughness->means.low, *roughness->reads);
  EXPECT_GT(roughness->means.high, *roughness->reads);
  ASSERT_TRUE(felt.cues);
  EXPECT_NEAR((*felt.cues)[CueKind::period].value_or(0), 2.5e-3, 2.5e-5);
  EXPECT_NEAR((*felt.cues)[CueKind::amplitude].value_or(0), roughness->size, 0.02);
}

/// An entry goes on with what its compilation has measured. It is that of a program that was compiled alone, with all
/// warnings, and then read anew: textures, springs, walls, memory, noise in time, states and several percepts at once.
TEST(Entry, IsThatOfAProgramThatIsReadAnew) {
  for (const char* file : {"fabric/corduroy", "wood/oak", "earth/sand", "mechanism/ratchet", "fluid/oil", "rubber/foam", "abstract/noises"}) {
    FileRequest request;
    request.file = std::string(WALE_SOURCE_DIR) + "/library/" + file + ".wale";
    const auto read = read_entries(request, file);
    ASSERT_TRUE(read) << in_words(read.error());
    for (const Entry& entry : read->entries) {
      Diagnostics diagnostics;
      const auto program = compile_opened(read->opened, request, entry.name, diagnostics);
      ASSERT_TRUE(program) << entry.name;
      EXPECT_EQ(entry.program, write_patch_program(program->description())) << entry.name;
      const EntryFeel anew = felt_of(*program, read->opened.module->declarations());
      EXPECT_EQ(entry.felt.percepts, anew.percepts) << entry.name;
      ASSERT_EQ(entry.felt.cues.has_value(), anew.cues.has_value()) << entry.name;
      EXPECT_TRUE(!anew.cues || entry.felt.cues->values == anew.cues->values) << entry.name;
    }
  }
}

// A reading that is kept is that of the program itself: to the bit the same as without.
TEST(Entry, ReadsACopyAsItsOriginal) {
  const TemporaryFolder folder;
  const std::string law =
      " estimated }\n  physical {\n    height ribs = cos(2 pi * x / 2.5 mm) + 0.3 * cos(2 pi * x / 14 mm)\n"
      "    force = lateral(ribs) + coulomb(0.3 N)\n  }\n}\n";
  const auto material = [&](const std::string& name, double level) {
    return "wale 1\nimport std.friction\n/// It is " + name + ".\nmaterial " + name + " {\n  representative { title \"" + name +
           "\" }\n  perceptual { roughness " + std::to_string(level) + law;
  };
  KeptReadings kept;
  const auto read = [&](const std::string& name, double level, KeptReadings* from) {
    auto found = read_entries({.file = folder.write(name + ".wale", material(name, level))}, name, felt_of, from);
    EXPECT_TRUE(found && found->entries.size() == 1 && found->entries[0].trouble.empty())
        << (found ? found->entries[0].trouble : in_words(found.error()));
    return found->entries[0];
  };
  read("original", 0.4, &kept);
  const std::size_t before = kept.given();
  const Entry copy = read("copy", 0.4, &kept), alone = read("copy", 0.4, nullptr);
  EXPECT_GT(kept.given(), before) << "what was measured of the original";
  const Entry other = read("other", 0.7, &kept), other_alone = read("other", 0.7, nullptr);
  for (const auto& [with, without] : {std::pair(&copy, &alone), std::pair(&other, &other_alone)}) {
    EXPECT_EQ(with->program, without->program);
    EXPECT_EQ(with->felt.percepts, without->felt.percepts);
    EXPECT_EQ(with->felt.cues->values, without->felt.cues->values);
  }
  EXPECT_NE(copy.felt.percepts, other.felt.percepts);
}

TEST(Entry, OfAMaterialWithAnErrorSaysSo) {
  const Shelf shelf;
  const FileEntries read = shelf.read();
  ASSERT_EQ(read.entries.size(), 2u);
  EXPECT_EQ(read.entries[1].name, "wrong");
  EXPECT_NE(read.entries[1].trouble, "");
  EXPECT_TRUE(read.entries[1].program.empty());
  EXPECT_TRUE(read.entries[1].felt.percepts.empty());
  EXPECT_EQ(read.entries[1].licence, "CC0-1.0");
}

TEST(Entry, RestsOnItsImports) {
  Shelf shelf;
  const FileEntries before = shelf.read();
  ASSERT_EQ(before.entries.size(), 2u);
  const std::string& content = before.entries[0].content;
  EXPECT_EQ(content.size(), 64u);
  EXPECT_NE(content, before.entries[1].content);
  EXPECT_EQ(shelf.read().entries[0].content, content);
  const auto looks_for = [&](const std::string& name) {
    return std::ranges::find(before.looked_for, shelf.folder / name) != before.looked_for.end();
  };
  EXPECT_TRUE(looks_for("parts/ribs.wale"));
  EXPECT_TRUE(looks_for("devices.wale")) << "another device there would change it";
  EXPECT_FALSE(before.uses_names);

  shelf.folder.write("parts/ribs.wale", std::string(ribs) + "// changed\n");
  const std::string changed = shelf.read().entries[0].content;
  EXPECT_NE(changed, content);
  shelf.folder.write("parts/ribs.wale", ribs);
  EXPECT_EQ(shelf.read().entries[0].content, content);
}

TEST(Entry, KnowsThatOtherMaterialsMayChangeIt) {
  Shelf shelf;
  shelf.folder.write("fabric/cord.wale", "wale 1\nmaterial soft_denim = denim\n");
  const FileEntries read = shelf.read();
  ASSERT_EQ(read.entries.size(), 1u);
  EXPECT_EQ(read.entries[0].trouble, "");
  EXPECT_TRUE(read.uses_names);
}

TEST(Entry, IsNotReadFromWhatIsNoText) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_entries({.file = folder / "none.wale"}, "none").error().code, Code::unreadable_file);
  const auto empty = read_entries({.file = folder.write("empty.wale", "")}, "empty");
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->entries.empty());
}

// FIPS 180-2 gives the digest of "abc" and of other texts without lengths, so here: an empty value is not nothing, and
// the border between two values counts.
TEST(ContentHash, KnowsWhereAValueEnds) {
  const auto hash = [](std::initializer_list<std::string_view> values) {
    ContentHash hash;
    for (const std::string_view value : values) hash.take(value);
    return hash.digits();
  };
  // SHA-256 of no bytes.
  EXPECT_EQ(hash({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  // printf '\x03\0\0\0\0\0\0\0abc' | sha256sum
  EXPECT_EQ(hash({"abc"}), "ce91dc5eec0139adf091900d225971d6ad246a845bad791b5693a9d0d55dd391");
  EXPECT_NE(hash({"ab", "c"}), hash({"a", "bc"}));
  EXPECT_NE(hash({""}), hash({}));
}

TEST(CompilerBuild, HasADigitsOnlyName) {
  EXPECT_GE(compiler_build().size(), 32u);
  EXPECT_EQ(compiler_build().find_first_not_of("0123456789abcdef"), std::string::npos);
}

}  // namespace
}  // namespace wale::entry_test
