// Files that are too large, too deep, broken or malicious. Each gives one clear diagnostic within bounded memory.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::bounds_test {
namespace {

constexpr long most_megabytes = 1500;

/// Runs `wale check` on the file and expects bounded memory and output. Time is not measured: a step that is quadratic
/// in such a file would not end.
Outcome check_within_bounds(const std::string& file) {
  const Outcome outcome = wale({"check", file});
  EXPECT_LT(outcome.out.size(), 1u << 20) << file;
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);  // the largest of all children so far
  EXPECT_LT(usage.ru_maxrss / 1024, most_megabytes) << file;
  EXPECT_LE(outcome.status, 1) << file << ": ended by a signal";
  return outcome;
}

/// The outcome of `wale check` on a text.
Outcome check_text(const std::string& text) {
  const TemporaryFolder folder;
  return check_within_bounds(folder.write("hostile.wale", text));
}

std::string repeated(const std::string& part, std::size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += part;
  return text;
}

/// Lines with their numbers.
template <class Line>
std::string numbered(std::size_t lines, Line line) {
  std::string text;
  for (std::size_t i = 0; i < lines; ++i) text += line(std::to_string(i));
  return text;
}

constexpr std::size_t four_megabytes = (4u << 20) - 100;

TEST(Bounds, AHundredMegabytesAreOneDiagnostic) {
  for (const char* part : {"x", "\n", "let a = 1\n"}) {
    const Outcome outcome = check_text(repeated(part, 100u << 20));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(contains(outcome.out, "error[W0109]: this file has 100.0 MB; Wale reads up to 4 MB")) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "1 file: 1 error, 0 warnings")) << outcome.out;
  }
}

TEST(Bounds, BytesThatAreNotUtf8AreOneDiagnostic) {
  const struct {
    std::string text;
    const char* said;
  } cases[] = {
      {"wale 1\n" + std::string(four_megabytes, '\0'), "error[W0107]: a NUL byte: this is not a text file"},
      {"wale 1\n" + std::string(four_megabytes, '\xff'), "error[W0107]: the byte 0xff is not UTF-8"},
      {"wale 1\nlet a = \"\xc3\x28\"\n", "error[W0107]: the byte 0xc3 is not UTF-8"},
      {"wale 1\nlet a = \"\xed\xa0\x80\"\n", "error[W0107]: the byte 0xed is not UTF-8"},
  };
  for (const auto& each : cases) {
    const Outcome outcome = check_text(each.text);
    EXPECT_TRUE(contains(outcome.out, each.said)) << outcome.out.substr(0, 500);
    EXPECT_TRUE(contains(outcome.out, "1 file: 1 error, 0 warnings"));
  }
}

TEST(Bounds, NumbersBeyondRangeAreOneDiagnosticEach) {
  for (const std::string& number : {std::string("1e999"), std::string("1e-999"), std::string(100000, '9'),
                                    "0." + std::string(100000, '0') + "1", std::string("1 mm^99 / 1 m^99")}) {
    const Outcome outcome = check_text("wale 1\nmaterial a { physical { force = -" + number + " N/m * hand } }\n");
    EXPECT_EQ(outcome.status, 1) << number.substr(0, 20);
    EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << outcome.out.substr(0, 500);
  }
}

TEST(Bounds, NestingThousandsDeepIsOneDiagnostic) {
  for (const char* opening : {"(", "sin(-", "if 1 < 2 then "}) {
    const Outcome outcome = check_text("wale 1\nlet a = " + repeated(opening, four_megabytes));
    EXPECT_TRUE(contains(outcome.out, "error[W0108]")) << opening << outcome.out.substr(0, 500);
    EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << opening << outcome.out.substr(0, 500);
  }
}

TEST(Bounds, NamesOfThousandsOfPartsAreOneDiagnostic) {
  for (const char* name : {"hand", "nothing", "fabric.x"})
    for (const std::size_t parts : {100, 20'000, 1'000'000}) {
      const std::string words = name + repeated(".x", 2 * parts);
      for (const std::string& text : {"let q = " + words, "let q = " + words + "(1)", "import " + words}) {
        const Outcome outcome = check_text("wale 1\n" + text + "\n");
        EXPECT_EQ(outcome.status, 1) << name << ", " << parts << " parts";
        EXPECT_TRUE(contains(outcome.out, "1 file: 1 error, ")) << outcome.out.substr(0, 1000);
      }
    }
}

TEST(Bounds, FourMegabytesOfMistakesAreCutShort) {
  constexpr std::size_t many = 150000;
  const std::string in_material = "wale 1\nmaterial m { physical {\n";
  const std::string texts[] = {
      "wale 1\n" + repeated("let a b\n", four_megabytes),
      "wale 1\n" + repeated("let a = 1\n", four_megabytes),
      "wale 1\n" + repeated("(\n", four_megabytes),
      "wale 1\n" + repeated("{ x\n", four_megabytes),
      "wale 1\n" + repeated("“", four_megabytes),
      "wale 1\n" + numbered(many, [](const std::string& i) { return "let a" + i + " = b" + i + "\n"; }),
      "wale 1;" + numbered(many, [](const std::string& i) { return "let a" + i + " = b" + i + ";"; }),
      in_material + numbered(many, [](const std::string& i) { return "let a" + i + " = b" + i + "\n"; }) + "} }",
      in_material + numbered(many, [](const std::string& i) { return "param a" + i + " = 1\n"; }) + "} }",
      "wale 1\nlevels roughness {\n" + numbered(many, [](const std::string& i) { return "a" + i + " 0.5\n"; }) + "}",
      "wale 1\n" + numbered(many / 2, [](const std::string& i) {
        return "material a" + i + " { physical { force = q" + i + " } }\n";
      })};
  for (const auto& text : texts) {
    const Outcome outcome = check_text(text);
    EXPECT_EQ(outcome.status, 1) << text.substr(0, 60);
  }
}

TEST(Bounds, ImagesThatAreMissingUnreadableOrHugeAreOneDiagnostic) {
  const TemporaryFolder folder;
  folder.write("torn.png", bytes_of(std::string(WALE_SOURCE_DIR) + "/examples/corduroy.png").substr(0, 1000));
  folder.write("empty.png", "");
  folder.write("vast.pgm", "P5\n100000 100000\n255\n");
  std::string header("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\x86\xa0\0\1\x86\xa0\x10\0\0\0\0", 29);
  folder.write("vast.png", header + std::string(4, '\0'));
  fs::create_directory(folder / "folder.png");
  const struct {
    const char *image, *code;
  } cases[] = {{"missing.png", "W0501"}, {"folder.png", "W0501"}, {"torn.png", "W0502"},
               {"empty.png", "W0502"},   {"vast.pgm", "W0503"},   {"vast.png", "W050"}};
  for (const auto& each : cases) {
    const Outcome outcome = check_within_bounds(
        folder.write("a.wale", std::string("wale 1\nmaterial a { physical { force = lateral(image(\"") + each.image +
                                   "\", scale: 0.1 mm/px, height: 1 mm), amplitude: 1 N) } }\n"));
    EXPECT_TRUE(contains(outcome.out, std::string("error[") + each.code)) << each.image << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << each.image << outcome.out;
  }
}

TEST(Bounds, AHundredMegabytesImportedAreOneDiagnostic) {
  const TemporaryFolder folder;
  folder.write("large.wale", std::string(100u << 20, '\n'));
  const Outcome outcome = check_within_bounds(folder.write("a.wale", "wale 1\nimport large\n"));
  EXPECT_TRUE(contains(outcome.out, "error[W0212]: `large` cannot be imported: ")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "has 100.0 MB; Wale reads up to 4 MB")) << outcome.out;
}

TEST(Bounds, ImportsInACircleAreOneDiagnostic) {
  const TemporaryFolder folder;
  constexpr int files = 50;
  for (int i = 0; i < files; ++i)
    folder.write("m" + std::to_string(i) + ".wale", "wale 1\nimport m" + std::to_string((i + 1) % files) + "\n");
  const Outcome outcome = check_within_bounds(folder / "m0.wale");
  EXPECT_TRUE(contains(outcome.out, "error[W0213]: `m0` imports this file")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << outcome.out;
}

TEST(Bounds, ImportsThousandsDeepAreOneDiagnostic) {
  const TemporaryFolder folder;
  constexpr int files = 3000;
  for (int i = 0; i < files; ++i)
    folder.write("m" + std::to_string(i) + ".wale", "wale 1\nimport m" + std::to_string(i + 1) + "\n");
  const Outcome outcome = check_within_bounds(folder / "m0.wale");
  EXPECT_TRUE(contains(outcome.out, "error[W0108]: imports are nested more than 64 files deep")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << outcome.out;
}

TEST(Bounds, MoreThanAThousandImportsAreOneDiagnostic) {
  const TemporaryFolder folder;
  std::string imports = "wale 1\n";
  for (int i = 1; i <= 1001; ++i) {
    folder.write("m" + std::to_string(i) + ".wale", "wale 1\n");
    imports += "import m" + std::to_string(i) + "\n";
  }
  const Outcome outcome = check_within_bounds(folder.write("a.wale", imports));
  EXPECT_TRUE(contains(outcome.out, "error[W0212]: `m1001` cannot be imported: more than 1000 files")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "1 file: 1 error,")) << outcome.out;
}

}  // namespace
}  // namespace wale::command_line::bounds_test
