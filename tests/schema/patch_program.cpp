#include "wale/patch_program.hpp"

#include <gtest/gtest.h>

#include "tests/schema/example_program.hpp"
#include "tests/schema/wpp_bytes.hpp"

namespace wale::patch_program_test {
namespace {

using wpp::Bytes;

PatchProgram read(const Bytes& bytes) {
  auto result = read_patch_program(bytes);
  if (!result) {
    ADD_FAILURE() << in_words(result.error());
    return {};
  }
  return *std::move(result);
}

TEST(PatchProgram, ComesBackFromItsBytes) {
  EXPECT_EQ(read(write_patch_program(example::program())), example::program());
  EXPECT_EQ(read(write_patch_program(example::least())), example::least());
}

TEST(PatchProgram, BytesComeBackFromTheirProgram) {
  for (const PatchProgram& program : {example::program(), example::least()}) {
    const Bytes bytes = write_patch_program(program);
    EXPECT_EQ(write_patch_program(read(bytes)), bytes);
    EXPECT_EQ(write_patch_program(program), bytes);
  }
}

TEST(PatchProgram, ConstantsKeepEveryBit) {
  PatchProgram program = example::least();
  program.constants.push_back(-0.0f);
  program.constants.push_back(1e-42f);
  program.constants.push_back(__builtin_inff());
  program.constants.push_back(__builtin_nanf("0x123"));
  const Bytes bytes = write_patch_program(program);
  EXPECT_EQ(write_patch_program(read(bytes)), bytes);
}

// The layout of schema/PATCH_PROGRAM.md, assembled by the writer in wpp_bytes.hpp.
TEST(PatchProgram, FileIsLaidOutAsDocumented) {
  const Bytes bytes = write_patch_program(example::program());
  EXPECT_EQ(wpp::file_of(wpp::sections_of(bytes)), bytes);
  EXPECT_EQ(wpp::get(bytes, 16, 8), bytes.size());
  std::string kinds;
  for (const auto& section : wpp::sections_of(bytes)) kinds += section.kind + (section.flags != 0 ? "! " : "? ");
  EXPECT_EQ(
      kinds,
      "NAME! REGS! CONS! PARM! SETU! PEAK! STAT! GRID! TICK! OUTP! PICT! FRAM? TABL! PTCH! DEVI! PERC? EVID? FATE? CLAI? LAYR? "
      "PLAC? ");
}

TEST(PatchProgram, EmptyOptionalSectionsAreLeftOut) {
  std::string kinds;
  for (const auto& section : wpp::sections_of(write_patch_program(example::least()))) kinds += section.kind + " ";
  EXPECT_EQ(kinds, "NAME REGS CONS PARM SETU PEAK TICK OUTP PICT TABL PTCH DEVI ");
}

// The contents of the sections STAT, GRID and FRAM, byte by byte, written by hand.
TEST(PatchProgram, StatesGridsAndMarksAreLaidOutAsDocumented) {
  const Bytes bytes = write_patch_program(example::program());
  const auto content = [&](std::string_view kind) {
    for (const auto& section : wpp::sections_of(bytes)) {
      if (section.kind == kind) return section.content;
    }
    return Bytes{};
  };
  Bytes states;
  wpp::append(states, 1, 4);
  wpp::append_text(states, "wear");
  wpp::append_text(states, "m");
  wpp::append(states, 0xbf800000, 4);  // -1
  wpp::append(states, 0x3f800000, 4);
  wpp::append(states, 43, 2);
  wpp::append(states, 44, 2);
  wpp::append(states, 1, 4);
  wpp::append(states, 3u + (43ull << 8) + (16ull << 22) + (35ull << 36), 8);
  EXPECT_EQ(content("STAT"), states);

  Bytes grids;
  wpp::append(grids, 2, 4);
  wpp::append_text(grids, "trace");
  wpp::append_text(grids, "kg");
  wpp::append(grids, 4, 4);
  wpp::append(grids, 3, 4);
  for (const std::uint32_t figure : {0x3e800000u, 0u, 0x3f800000u}) wpp::append(grids, figure, 4);  // 0.25, 0, 1
  wpp::append_text(grids, "dot");
  wpp::append_text(grids, "");
  wpp::append(grids, 1, 4);
  wpp::append(grids, 1, 4);
  for (const std::uint32_t figure : {0xbf800000u, 0xc0000000u, 0x40000000u})
    wpp::append(grids, figure, 4);  // -1, -2, 2
  wpp::append(grids, 2, 4);
  for (const int number : {0, 43, 1, 44, 1, 34, 34, 42}) wpp::append(grids, number, 2);
  EXPECT_EQ(content("GRID"), grids);

  Bytes frame;
  wpp::append(frame, 2, 4);
  wpp::append(frame, 1u + (46ull << 8) + (16ull << 22) + (42ull << 36), 8);
  wpp::append(frame, 23u + (43ull << 8) + (46ull << 36), 8);
  wpp::append(frame, 3, 4);
  wpp::append(frame, 1, 1);
  wpp::append(frame, 0xff8000, 4);
  for (const int number : {0, 1, 46}) wpp::append(frame, number, 2);
  wpp::append(frame, 5, 1);
  wpp::append(frame, 0x102030, 4);
  for (const int number : {0, 1, 34, 34, 35}) wpp::append(frame, number, 2);
  wpp::append(frame, 4, 1);
  wpp::append(frame, 0, 4);
  for (const int number : {0, 1, 34, 34}) wpp::append(frame, number, 2);
  EXPECT_EQ(content("FRAM"), frame);
}

TEST(PatchProgram, PlacesAreLaidOutAsDocumented) {
  Bytes places;
  wpp::append(places, 2, 4);
  wpp::append_text(places, "bench.wale");
  wpp::append_text(places, "std.grain");
  const auto run = [&](int instructions, int file, int line) {
    wpp::append(places, instructions, 4);
    wpp::append(places, file, 2);
    wpp::append(places, line, 4);
  };
  for (const auto& [instructions, line] : {std::pair{4, 7}, {4, 8}, {1, 9}}) {  // setup, peak 0, enter
    wpp::append(places, 1, 4);
    run(instructions, 0, line);
  }
  wpp::append(places, 2, 4);  // tick
  run(5, 0, 8);
  run(2, 1, 70000);
  for (const auto& [instructions, line] : {std::pair{4, 8}, {2, 9}, {2, 3}}) {  // picture, frame, prediction 0
    wpp::append(places, 1, 4);
    run(instructions, 0, line);
  }
  EXPECT_EQ(wpp::sections_of(write_patch_program(example::program())).back().content, places);
}

TEST(PatchProgram, KnowsWhereAnInstructionComesFrom) {
  const PatchProgram program = example::program();
  using enum CodeSection;
  EXPECT_EQ(program.place_of(setup, 0, 3), (SourceLine{"bench.wale", 7}));
  EXPECT_EQ(program.place_of(setup, 0, 4), std::nullopt);
  EXPECT_EQ(program.place_of(peak, 0, 0), (SourceLine{"bench.wale", 8}));
  EXPECT_EQ(program.place_of(enter, 0, 0), (SourceLine{"bench.wale", 9}));
  EXPECT_EQ(program.place_of(tick, 0, 4), (SourceLine{"bench.wale", 8}));
  EXPECT_EQ(program.place_of(tick, 0, 5), (SourceLine{"std.grain", 70000}));
  EXPECT_EQ(program.place_of(prediction, 0, 1), (SourceLine{"bench.wale", 3}));
  EXPECT_EQ(program.place_of(prediction, 1, 0), std::nullopt);
  EXPECT_EQ(example::least().place_of(tick, 0, 0), std::nullopt);
  EXPECT_EQ(&program.code(peak, 0), &program.peaks[0].code);
}

// The fields, by hand: operation 3 (multiply) in bits 0-7, then 14 bits each for destination, a, b and c.
TEST(PatchProgram, InstructionsTakeEightBytes) {
  const std::uint64_t word = encode({3, 26, 1, 22, 5});
  EXPECT_EQ(word, 3u + (26ull << 8) + (1ull << 22) + (22ull << 36) + (5ull << 50));
  EXPECT_EQ(decode(word), (Instruction{3, 26, 1, 22, 5}));
  EXPECT_EQ(decode(~0ull), (Instruction{255, 16383, 16383, 16383, 16383}));
}

// 0xcbf43926 is the published check value of CRC-32, that of the text "123456789".
TEST(PatchProgram, ChecksumIsCrc32) {
  const Bytes bytes = write_patch_program(example::program());
  EXPECT_EQ(wpp::get(bytes, 24, 4), wpp::crc(bytes));
  Bytes check;
  for (const char c : std::string_view("123456789")) wpp::append(check, static_cast<unsigned char>(c), 1);
  EXPECT_EQ(wpp::crc(check), 0xcbf43926u);
}

TEST(PatchProgram, PadsComeBackFromTheirBytes) {
  for (const PositionSource source : {PositionSource::none, PositionSource::pointer, PositionSource::touch}) {
    const PatchProgram pad = example::pad(source);
    EXPECT_EQ(read(write_patch_program(pad)), pad);
  }
}

TEST(PatchProgram, UnknownSkippableSectionsAreSkipped) {
  for (const std::size_t place : {0u, 5u, 17u, 18u, 19u}) {
    auto sections = wpp::sections_of(write_patch_program(example::program()));
    sections.insert(sections.begin() + place, {"XTRA", 0, Bytes(13, std::byte{0xee})});
    EXPECT_EQ(read(wpp::file_of(sections)), example::program());
  }
}

TEST(PatchProgram, LaterMinorVersionsAreRead) {
  Bytes bytes = write_patch_program(example::program());
  wpp::put(bytes, 10, 7, 2);
  EXPECT_EQ(read(wpp::sealed(bytes)), example::program());
}

TEST(PatchProgram, CostIsTheSumOfItsInstructions) {
  using enum Operation;
  EXPECT_EQ(cost_of({}), 0);
  const std::vector<Instruction> code = {example::instruction(add, 0), example::instruction(sine, 0),
                                         example::instruction(sample, 0)};
  EXPECT_EQ(cost_of(code), 1 + 8 + 40);
}

}  // namespace
}  // namespace wale::patch_program_test
