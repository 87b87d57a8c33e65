// Files that are not patch programs, each refused with a sentence that says what is wrong with it.

#include <gtest/gtest.h>

#include <functional>

#include "schema/without_place.hpp"
#include "tests/schema/example_program.hpp"
#include "tests/schema/wpp_bytes.hpp"
#include "wale/patch_program.hpp"

namespace wale::refusals_test {
namespace {

using wpp::Bytes;
using wpp::Section;

Bytes example_bytes() { return write_patch_program(example::program()); }

std::string refusal_of(const Bytes& bytes) {
  const auto result = read_patch_program(bytes);
  return result ? "" : in_words_without_place(result.error());
}

/// The refusal of the example after the `size` bytes at `at` are set to `value` and the checksum is corrected.
std::string refusal_with(std::size_t at, std::uint64_t value, int size) {
  Bytes bytes = example_bytes();
  wpp::put(bytes, at, value, size);
  return refusal_of(wpp::sealed(bytes));
}

std::string refusal_of_sections(const std::function<void(std::vector<Section>&)>& change) {
  auto sections = wpp::sections_of(example_bytes());
  change(sections);
  return refusal_of(wpp::file_of(sections));
}

Section& section(std::vector<Section>& sections, std::string_view kind) {
  for (Section& s : sections) {
    if (s.kind == kind) return s;
  }
  throw std::out_of_range(std::string(kind));
}

/// The refusal of the example with one section's content rewritten.
std::string refusal_of_content(std::string_view kind, const std::function<void(Bytes&)>& change) {
  return refusal_of_sections([&](std::vector<Section>& sections) { change(section(sections, kind).content); });
}

std::size_t entry(std::size_t number) { return 32 + 24 * number; }

TEST(Refusals, NotAPatchProgram) {
  const std::string sentence = "this is not a patch program: its first bytes are not those of a .wpp file";
  EXPECT_EQ(refusal_of({}), sentence);
  EXPECT_EQ(refusal_of(Bytes(100)), sentence);
}

TEST(Refusals, DamageByATransferAsText) {
  const std::string sentence = "a transfer as text has damaged this patch program; copy it as binary";
  Bytes unix_ends = example_bytes();
  unix_ends.erase(unix_ends.begin() + 4);  // CR LF becomes LF
  EXPECT_EQ(refusal_of(unix_ends), sentence);
  Bytes seven_bits = example_bytes();
  seven_bits[0] &= std::byte{0x7f};
  EXPECT_EQ(refusal_of(seven_bits), sentence);
}

TEST(Refusals, NewerMajorVersionSaysWhatToDo) {
  EXPECT_EQ(refusal_with(8, 2, 2),
            "this patch program has format version 2.2, but this Wale reads only up to 1; update Wale, or build the "
            "material again with this one");
  EXPECT_EQ(refusal_with(8, 0, 2), "this patch program claims format version 0, which never existed");
}

TEST(Refusals, EveryFlippedBit) {
  const Bytes whole = example_bytes();
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    Bytes bytes = whole;
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    ASSERT_NE(refusal_of(bytes), "") << "bit " << bit;
  }
  Bytes bytes = whole;
  bytes[200] ^= std::byte{1};
  EXPECT_EQ(refusal_of(bytes), "the file is damaged: its checksum does not match its bytes");
}

TEST(Refusals, EveryTruncation) {
  const Bytes whole = example_bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_NE(refusal_of(cut), "") << size;
    if (size < 32) continue;
    // The file is refused even if its header declares the shorter size and the checksum matches.
    Bytes crafted = cut;
    wpp::put(crafted, 16, size, 8);
    ASSERT_NE(refusal_of(wpp::sealed(crafted)), "") << size;
  }
  EXPECT_EQ(refusal_of(Bytes(whole.begin(), whole.begin() + 100)),
            "the file is cut short: expected " + std::to_string(whole.size()) + " bytes, found 100");
  EXPECT_EQ(refusal_of(Bytes(whole.begin(), whole.begin() + 20)),
            "the file ends inside its header, after 20 of 32 bytes");
}

TEST(Refusals, TrailingBytes) {
  Bytes bytes = example_bytes();
  const std::size_t size = bytes.size();
  bytes.resize(size + 8);
  EXPECT_EQ(refusal_of(bytes), "the file has 8 bytes after its end at " + std::to_string(size));
  wpp::put(bytes, 16, size + 8, 8);
  EXPECT_EQ(refusal_of(wpp::sealed(bytes)), "the file has 8 bytes after its last section");
}

TEST(Refusals, HeaderFields) {
  EXPECT_EQ(refusal_with(28, 1, 4), "the reserved part of the header is not zero");
  EXPECT_EQ(refusal_with(12, 0xffffffff, 4), "the header claims 4294967295 sections, more than the file has room for");
}

TEST(Refusals, SectionsOutOfPlace) {
  const auto size = std::to_string(example_bytes().size());
  EXPECT_EQ(refusal_with(entry(8) + 16, 1u << 20, 8).substr(0, 34), "section TICK claims 1048576 bytes ");
  EXPECT_EQ(refusal_with(entry(8) + 8, ~0ull, 8),
            "section TICK claims 60 bytes at 18446744073709551615, but the file has only " + size);
  const auto offset = wpp::get(example_bytes(), entry(8) + 8, 8);
  EXPECT_EQ(refusal_with(entry(8) + 8, offset - 8, 8),
            "section TICK at " + std::to_string(offset - 8) + " overlaps the bytes before it");
  EXPECT_EQ(refusal_with(entry(8) + 8, offset + 8, 8),
            "section TICK at " + std::to_string(offset + 8) + " leaves a gap of 8 bytes before it");
  EXPECT_EQ(refusal_with(offset + 60, 1, 1), "section TICK is followed by bytes that are not zero");
}

TEST(Refusals, SectionKindsAndFlags) {
  EXPECT_EQ(refusal_of_sections([](auto& s) {
              s.insert(s.begin() + 3, {"XTRA", 1, {}});
            }),
            "this program needs section XTRA, which this Wale does not know; update Wale");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s.insert(s.begin() + 3, s[2]); }), "section CONS occurs twice");
  EXPECT_EQ(refusal_of_sections([](auto& s) { std::swap(s[2], s[3]); }),
            "section CONS comes after PARM, expected before it");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s.erase(s.begin() + 8); }), "section TICK is missing");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s.clear(); }), "section NAME is missing");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s[8].flags = 0; }),
            "section TICK is marked as skippable, expected required");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s[19].flags = 1; }),
            "section LAYR is marked as required, expected skippable");
  EXPECT_EQ(refusal_of_sections([](auto& s) { s[8].flags = 3; }),
            "section TICK has flags that this Wale does not know");
}

TEST(Refusals, ContentThatEndsEarlyOrLate) {
  EXPECT_EQ(refusal_of_content("PTCH", [](Bytes& b) { b.resize(10); }),
            "section PTCH ends early: it needs 4 more bytes and has 2");
  EXPECT_EQ(refusal_of_content("REGS", [](Bytes& b) { b.resize(9); }), "section REGS has 5 bytes after its end");
}

TEST(Refusals, CountsBeyondTheFile) {
  for (const std::string kind : {"CONS", "PARM", "SETU", "PEAK", "STAT", "GRID", "TICK", "OUTP", "FRAM", "TABL", "PERC",
                                 "FATE", "CLAI", "LAYR", "PLAC"}) {
    for (const std::uint32_t count : {0xffffffffu, 0x20000000u, 100000u}) {
      const std::string reason = refusal_of_content(kind, [count](Bytes& b) { wpp::put(b, 0, count, 4); });
      EXPECT_EQ(reason.substr(0, 20), "section " + kind + " claims ") << reason;
    }
  }
  EXPECT_EQ(refusal_of_content("TICK", [](Bytes& b) { wpp::put(b, 0, 1000, 4); }),
            "section TICK claims 1000 instructions but has only 56 bytes for them");
}

TEST(Refusals, Texts) {
  EXPECT_EQ(refusal_of_content("NAME", [](Bytes& b) { wpp::put(b, 0, 0xffffffff, 4); }),
            "section NAME claims 4294967295 bytes for the material's name; texts have at most 1048576");
  EXPECT_EQ(refusal_of_content("NAME", [](Bytes& b) { wpp::put(b, 0, 1000, 4); }),
            "section NAME ends early: it needs 1000 more bytes and has 13");
  EXPECT_EQ(refusal_of_content("NAME", [](Bytes& b) { b[6] = std::byte{0}; }),
            "section NAME has a NUL byte inside the material's name");
}

TEST(Refusals, FiguresThatAreNotFinite) {
  constexpr std::uint64_t nan32 = 0x7fc00000, inf64 = 0x7ff0000000000000;
  EXPECT_EQ(refusal_of_content("PTCH", [](Bytes& b) { wpp::put(b, 4, nan32, 4); }),
            "section PTCH holds nan for the patch's height, expected a finite number");
  EXPECT_EQ(refusal_of_content("STAT", [](Bytes& b) { wpp::put(b, 4 + (4 + 4) + (4 + 1) + 4, nan32, 4); }),
            "section STAT holds nan for a state's range, expected a finite number");
  EXPECT_EQ(refusal_of_content("GRID", [](Bytes& b) { wpp::put(b, 4 + (4 + 5) + (4 + 2) + 8, nan32, 4); }),
            "section GRID holds nan for a grid's initial value, expected a finite number");
  EXPECT_EQ(refusal_of_content("DEVI", [](Bytes& b) { wpp::put(b, 4 + 5 + 8 * 4, inf64, 8); }),
            "section DEVI holds inf for the rate, expected a finite number");
}

TEST(Refusals, Tables) {
  EXPECT_EQ(refusal_of_content("TABL", [](Bytes& b) { wpp::put(b, 4, 0xffffffff, 4); }),
            "section TABL claims 4294967295 x 2 heights for table 0 but has only 12 bytes for them");
  EXPECT_EQ(refusal_of_content("TABL", [](Bytes& b) { wpp::put(b, 4, 0xffffffffffffffff, 8); }),
            "section TABL claims 4294967295 x 4294967295 heights for table 0 but has only 12 bytes for them");
  EXPECT_EQ(refusal_of_content("TABL", [](Bytes& b) { b[20] ^= std::byte{1}; }),
            "section TABL holds table 0, whose heights do not match its hash");
  // The same codes in another shape are another table.
  EXPECT_EQ(refusal_of_content("TABL", [](Bytes& b) { wpp::put(b, 4, 2 | 3ull << 32, 8); }),
            "section TABL holds table 0, whose heights do not match its hash");
}

TEST(Refusals, ChoicesThatThisWaleDoesNotKnow) {
  EXPECT_EQ(refusal_of_content("OUTP", [](Bytes& b) { b[4] = std::byte{9}; }),
            "section OUTP names quantity 9, which this Wale does not know");
  EXPECT_EQ(refusal_of_content("FRAM", [](Bytes& b) { b[4 + 2 * 8 + 4] = std::byte{7}; }),
            "section FRAM has a mark of kind 7, which this Wale does not know");
  EXPECT_EQ(refusal_of_content("PICT", [](Bytes& b) { b[2] = std::byte{2}; }),
            "section PICT holds 2 for whether the relief is a length, expected 0 or 1");
  EXPECT_EQ(refusal_of_content("PICT", [](Bytes& b) { b[3] = std::byte{0}; }),
            "section PICT names registers for a colour, but says that the surface has none");
  const std::size_t live = 4 + (4 + 9) + (4 + 17);  // after the count, "roughness" and "lateral amplitude"
  EXPECT_EQ(refusal_of_content("PERC", [&](Bytes& b) { b[live] = std::byte{3}; }),
            "section PERC holds 3 for how a percept's level is set, expected 0, 1 or 2");
  EXPECT_EQ(refusal_of_content("PERC", [&](Bytes& b) { b[live] = std::byte{0}; }),
            "section PERC names parameter 1 for a percept without a parameter");
  const std::size_t slope = live + 1 + 2 + 2 + 1 + (4 + 2 * 8) + 2 + 2 + 3 * 4;
  EXPECT_EQ(refusal_of_content("PERC", [&](Bytes& b) { b[slope] = std::byte{8}; }),
            "section PERC has evidence grade 8 for a slope, which this Wale does not know");
  const std::size_t profiles =
      4 + 2 * 4 + (2 * 4 + 2) + 5 + 1;  // after the count, the figures, what is assumed, and whether it is stated
  EXPECT_EQ(refusal_of_content("EVID", [&](Bytes& b) { b[profiles] = std::byte{16}; }),
            "section EVID has stimuli that this Wale does not know");
  EXPECT_EQ(refusal_of_content("EVID", [&](Bytes& b) { b[0] = std::byte{0}; }),
            "section EVID has not as many entries as there are percepts");
  const std::size_t fate = 4 + (4 + 9) + 1;  // after the count, "roughness" and whether it is a percept
  EXPECT_EQ(refusal_of_content("FATE", [&](Bytes& b) { b[fate] = std::byte{5}; }),
            "section FATE has fate 5, which this Wale does not know");
}

TEST(Refusals, PlacesThatDoNotFitTheCode) {
  const std::size_t run = 4 + (4 + 10) + (4 + 9) + 4;  // setup's first run, after the files and the count
  EXPECT_EQ(refusal_of_content("PLAC", [&](Bytes& b) { wpp::put(b, run, 3, 4); }),
            "section PLAC has places for 3 instructions, but the code has 4");
  EXPECT_EQ(refusal_of_content("PLAC", [&](Bytes& b) { wpp::put(b, run, 0, 4); }),
            "section PLAC has a run of no instructions");
  EXPECT_EQ(refusal_of_content("PLAC", [&](Bytes& b) { wpp::put(b, run + 4, 2, 2); }),
            "section PLAC names file 2 but has only 2");
  EXPECT_EQ(refusal_of_content("PLAC", [&](Bytes& b) { wpp::put(b, run + 6, 0, 4); }),
            "section PLAC names line 0; lines are numbered from 1");
  EXPECT_EQ(refusal_of_content("PLAC", [](Bytes& b) { b.resize(b.size() - 10); }).substr(0, 27),
            "section PLAC claims 1 runs ");
}

TEST(Refusals, EmptySectionsThatAreLeftOut) {
  EXPECT_EQ(refusal_of_content("STAT", [](Bytes& b) { b = Bytes(8); }),
            "section STAT is empty; a file without states leaves it out");
  EXPECT_EQ(refusal_of_content("GRID", [](Bytes& b) { b = Bytes(8); }),
            "section GRID is empty; a file without grids leaves it out");
  EXPECT_EQ(refusal_of_content("FRAM", [](Bytes& b) { b = Bytes(8); }),
            "section FRAM is empty; a file without marks leaves it out");
  EXPECT_EQ(refusal_of_content("PERC", [](Bytes& b) { b = Bytes(4); }),
            "section PERC is empty; a file without percepts leaves it out");
  EXPECT_EQ(refusal_of_content("CLAI", [](Bytes& b) { b.back() = std::byte{9}; }),
            "section CLAI has evidence grade 9 for a level, which this Wale does not know");
  EXPECT_EQ(refusal_of_content("CLAI", [](Bytes& b) { b = Bytes(4); }),
            "section CLAI is empty; a file without claims leaves it out");
  EXPECT_EQ(refusal_of_content("FATE", [](Bytes& b) { b = Bytes(4); }),
            "section FATE is empty; a file without fates leaves it out");
  EXPECT_EQ(refusal_of_content("LAYR", [](Bytes& b) { b = Bytes(16); }),
            "section LAYR is empty; a file without layers leaves it out");
  EXPECT_EQ(refusal_of_content("PLAC", [](Bytes& b) { b = Bytes(4); }),
            "section PLAC is empty; a file without places leaves it out");
}

// An accepted file is written again as the same bytes, so no two files mean the same program.
TEST(Refusals, AcceptedFilesAreCanonical) {
  const std::size_t sections = wpp::get(example_bytes(), 12, 4);
  int accepted = 0;
  for (const Bytes& whole : {example_bytes(), write_patch_program(example::pad())})
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const int flip : {0x01, 0x80, 0xff}) {
        Bytes bytes = whole;
        bytes[at] ^= static_cast<std::byte>(flip);
        if (at == 10 || at == 11) continue;  // a later minor version is read but written as this one
        const auto result = read_patch_program(wpp::sealed(bytes));
        if (!result) continue;
        ++accepted;
        const bool unknown_section = at >= 32 && at < 32 + 24 * sections;
        if (unknown_section) continue;  // a section with a changed name is skipped
        ASSERT_EQ(write_patch_program(*result), wpp::sealed(bytes)) << "byte " << at;
      }
    }
  EXPECT_GT(accepted, 100);
}

TEST(Refusals, VibrationOfAPad) {
  const Bytes pad = write_patch_program(example::pad());
  const auto refusal = [&](const std::function<void(Bytes&)>& change) {
    auto sections = wpp::sections_of(pad);
    for (auto& section : sections)
      if (section.kind == "VIBR") change(section.content);
    const auto result = read_patch_program(wpp::file_of(sections));
    return !result ? in_words_without_place(result.error()) : "";
  };
  EXPECT_EQ(refusal([](Bytes&) {}), "");
  EXPECT_EQ(refusal([](Bytes& b) { b[0] = std::byte{3}; }),
            "section VIBR has position source 3, which this Wale does not know");
  EXPECT_EQ(refusal([](Bytes& b) { wpp::put(b, 1, 0x7ff0000000000000, 8); }),
            "section VIBR holds inf for a figure of the vibration, expected a finite number");
  EXPECT_EQ(refusal([](Bytes& b) { wpp::put(b, 1 + 5 * 8, 1000, 4); }).substr(0, 40),
            "section VIBR claims 1000 frequencies but");
  EXPECT_EQ(refusal([](Bytes& b) { wpp::put(b, 1 + 5 * 8 + 4 + 8, 1000, 4); }).substr(0, 48),
            "section VIBR claims 1000 points of the response ");
  EXPECT_EQ(refusal([](Bytes& b) { b.resize(b.size() - 1); }),
            "section VIBR claims 2 points of the response but has only 31 bytes for them");
}

}  // namespace
}  // namespace wale::refusals_test
