// Headers of `wale build --emit cpp` as a program includes them: several in one file, one in several files, beside
// names of the program's own, without a library; and what they refuse.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>

#include "compiler/cpp/print_header.hpp"
#include "tests/listing/opening.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::listing::headers_test {
namespace {

const std::string freestanding = " -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -Wall -Wextra -Werror ";

std::vector<std::string> compilers() {
  std::vector<std::string> all{WALE_CXX_COMPILER};
  if (const std::string clang = WALE_CLANG; !clang.empty() && clang != all[0]) all.push_back(clang);
  return all;
}

Program shipped(const std::string& path, const std::string& material) {
  return File((library / path).string()).program(material);
}

std::string header(const Program& program, const std::vector<std::string>& live = {}) {
  return print_header(program, *live_parts(program.description(), live));
}

Program corduroy() { return shipped("fabric/corduroy.wale", "corduroy"); }

/// What the compiler says; empty if it succeeds in silence.
std::string said_by(const std::string& command) {
  const TemporaryFolder folder;
  const int status = std::system((command + " >" + (folder / "said") + " 2>&1").c_str());
  std::ifstream said(folder / "said");
  const std::string text{std::istreambuf_iterator<char>(said), {}};
  return status == 0 || !text.empty() ? text : "failed in silence";
}

/// The example in a header's comment, as code.
std::string example_in(const std::string& text) {
  const std::size_t begin = text.find("//   namespace patch = "), end = text.find("\n//\n// Forces, states", begin);
  std::string code = text.substr(begin, end - begin);
  return std::regex_replace(code, std::regex("(^|\n)//( {3})?"), "$1");
}

TEST(Headers, OfEveryMaterialCompileFreestandingWithTheirExample) {
  const TemporaryFolder folder;
  std::string all;
  std::size_t count = 0;
  for (const auto& path : shipped_files()) {
    const File file(path);
    for (const auto& material : materials_of(file.opened)) {
      const Program program = file.program(material);
      const std::vector<std::string> live =
          count % 2 == 0 ? std::vector<std::string>{} : std::vector<std::string>{"all"};
      const std::string text = header(program, live);
      const std::string example = example_in(text);
      EXPECT_TRUE(example.find("patch::tick(") != std::string::npos) << text.substr(0, 3000);
      folder.write("material" + std::to_string(count) + ".hpp", text);
      all += "namespace { namespace example" + std::to_string(count) + " {\n" + example + "\n} }\n";
      all.insert(0, "#include \"material" + std::to_string(count++) + ".hpp\"\n");
    }
  }
  EXPECT_GT(count, 20u);
  const std::string source = folder.write("all.cpp", all);
  for (const std::string& compiler : compilers())
    for (const char* mode : {"", "-DWALE_MACHINE_MODE -ffp-contract=off "})
      EXPECT_EQ(said_by(compiler + freestanding + mode + "-Wno-unused-function -fsyntax-only " + source), "")
          << compiler;
}

TEST(Headers, StandTogetherInOneProgramOfSeveralFiles) {
  const TemporaryFolder folder;
  const std::string text = header(corduroy());
  folder.write("corduroy.hpp", text);
  folder.write("oak.hpp", header(shipped("wood/oak.wale", "oak"), {"all"}));
  // The same material by another version of Wale, whose arithmetic and namespace are its own.
  std::string other =
      std::regex_replace(text, std::regex("(WALE_ARITHMETIC_|wale_arithmetic_)[0-9a-f]{8}"), "$0_older");
  other = std::regex_replace(other, std::regex("(WALE_PATCH_|wale_patch_)corduroy"), "$1old_corduroy");
  folder.write("old_corduroy.hpp", other);
  // Names of the program that are names of the arithmetic, too.
  const std::string own =
      "inline int sum, product, quotient, absolute, held_within, flushed, nearest, held, limited, infinity;\n"
      "namespace arithmetic { inline int root; }\n";
  const std::string includes =
      "#include \"corduroy.hpp\"\n#include \"oak.hpp\"\n#include \"old_corduroy.hpp\"\n#include \"corduroy.hpp\"\n";
  const std::string a = folder.write(
      "a.cpp", own + includes +
                   "const float* here() { return &wale_patch_corduroy::half_width; }\n"
                   "float force(float x) { wale_patch_corduroy::State s; wale_patch_corduroy::Hand h; h.x = x;\n"
                   "  return wale_patch_corduroy::tick(s, h).x; }\n");
  const std::string b = folder.write(
      "b.cpp", includes + own +
                   "const float* here();\nfloat force(float x);\n"
                   "int main() { wale_patch_old_corduroy::State s; wale_patch_old_corduroy::Hand h; h.x = 0.001f;\n"
                   "  const float f = wale_patch_old_corduroy::tick(s, h).x;\n"
                   "  return here() == &wale_patch_corduroy::half_width && f != 0 && f == force(0.001f) ? 0 : 1; }\n");
  for (const std::string& compiler : compilers()) {
    const std::string program = folder / "program";
    EXPECT_EQ(said_by(compiler + " -std=c++17 -Wall -Wextra -Werror -o " + program + " " + a + " " + b), "")
        << compiler;
    EXPECT_EQ(std::system(program.c_str()), 0) << compiler;
  }
}

TEST(Headers, OfDifferentMaterialsOfOneNameKeepTheirForcesInDifferentFiles) {
  const TemporaryFolder folder;
  const auto drag = [&](const std::string& size) {
    const std::string text = "wale 1\nmaterial drag { physical { force = -" + size + " N s/m * velocity } }\n";
    return header(File(folder.write("drag" + size + ".wale", text)).program("drag"));
  };
  folder.write("soft.hpp", drag("2")), folder.write("hard.hpp", drag("20"));
  const std::string name = "wale_patch_drag";
  const auto file_of = [&](const std::string& kind) {
    return folder.write(kind + ".cpp", "#include \"" + kind + ".hpp\"\nfloat " + kind + "() { " + name + "::State s; " + name +
                                           "::Hand h; h.velocity_x = 0.125f; return " + name + "::tick(s, h).x; }\n");
  };
  const std::string soft = file_of("soft"), hard = file_of("hard");
  const std::string main = folder.write(
      "main.cpp", "float soft(); float hard();\nint main() { return soft() == -0.25f && hard() == -2.5f ? 0 : 1; }\n");
  for (const std::string& compiler : compilers())
    for (const char* order : {"soft", "hard"}) {
      const std::string program = folder / "program", first = order == std::string("soft") ? soft : hard,
                        second = order == std::string("soft") ? hard : soft;
      EXPECT_EQ(said_by(compiler + " -std=c++17 -O0 -o " + program + " " + first + " " + second + " " + main), "") << compiler;
      EXPECT_EQ(std::system(program.c_str()), 0) << compiler << ", first " << order;
    }
}

TEST(Headers, RefuseWhatWouldChangeTheirBits) {
  const TemporaryFolder folder;
  folder.write("folded.hpp", header(corduroy()));
  folder.write("live.hpp", header(corduroy(), {"wale"}));
  const std::string one = folder.write("one.cpp", "#include \"folded.hpp\"\n#include \"folded.hpp\"\n");
  const std::string both = folder.write("both.cpp", "#include \"folded.hpp\"\n#include \"live.hpp\"\n");
  const std::string compiler = WALE_CXX_COMPILER;
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_EQ(said_by(compiler + " -std=c++17 -fsyntax-only " + one), "");
  EXPECT_TRUE(has(said_by(compiler + " -std=c++17 -ffast-math -fsyntax-only " + one), "needs IEEE floats"));
  EXPECT_TRUE(has(said_by(compiler + " -std=c++17 -ffinite-math-only -fsyntax-only " + one), "needs IEEE floats"));
  EXPECT_TRUE(has(said_by(compiler + " -std=c++14 -fsyntax-only " + one), "needs C++17"));
#if defined(__x86_64__)
  EXPECT_TRUE(has(said_by(compiler + " -std=c++17 -mfpmath=387 -fsyntax-only " + one), "rounded after each operation"));
#endif
  EXPECT_TRUE(has(said_by(compiler + " -std=c++17 -fsyntax-only " + both), "another build of this material"));
}

#if defined(__x86_64__)
constexpr const char* beside_the_processor = R"(
#include "corduroy.hpp"
#include <cstdio>
#include <random>
namespace p = wale_patch_corduroy;
enum Operation { add, subtract, multiply, divide };
float by_processor(Operation operation, float a, float b, unsigned mode) {
  _mm_setcsr(mode);
  volatile float x = a, y = b, result = 0;
  switch (operation) {
    case add: result = x + y; break;
    case subtract: result = x - y; break;
    case multiply: result = x * y; break;
    case divide: result = x / y; break;
  }
  _mm_setcsr(0x1f80);
  return result;
}
float by_header(Operation operation, float a, float b) {
  switch (operation) {
    case add: return p::sum(a, b);
    case subtract: return p::difference(a, b);
    case multiply: return p::product(a, b);
    case divide: return p::quotient(a, b);
  }
  return 0;
}
int main() {
  std::mt19937 random(3);
  const auto near = [&](double value) {  // within 2^-22 of it, with either sign
    const double share = 1 + (static_cast<double>(random() % 64) - 32) * 0x1p-27;
    return static_cast<float>((random() % 2 == 0 ? value : -value) * share);
  };
  long rounded_apart = 0, wrong = 0;
  for (int i = 0; i < 1000000; ++i) {
    const float b = static_cast<float>((1 + random() % 8388608 * 0x1p-23) * (random() % 2 == 0 ? 0x1p-40 : 0x1p-3));
    const float a[] = {near(b), near(b), near(0x1p-126 / b), near(0x1p-126 * b)};
    for (const Operation operation : {add, subtract, multiply, divide}) {
      const float small = operation == add || operation == subtract ? 0x1p-86f : 1.0f;
      const float x = a[operation] * small, y = b * small;
      if (p::absolute(x) < 0x1p-126f || p::absolute(y) < 0x1p-126f) continue;
      const auto machine = p::arithmetic::bits_of(by_processor(operation, x, y, 0x9fc0));
      rounded_apart += p::arithmetic::bits_of(p::arithmetic::flushed(by_processor(operation, x, y, 0x1f80))) != machine;
      wrong += p::arithmetic::bits_of(by_header(operation, x, y)) != machine;
    }
    const float square = p::arithmetic::float_of(random() & 0x7fffffffu);
    if (square >= 0x1p-126f && square < p::arithmetic::infinity)
      wrong += p::arithmetic::root_by_digits(square) != p::square_root_of(square);
  }
  wrong += p::arithmetic::root_by_digits(-1.0f) == p::arithmetic::root_by_digits(-1.0f);
  std::printf("%ld results differ from flushed IEEE ones, %ld from the header's\n", rounded_apart, wrong);
  return rounded_apart > 100 && wrong == 0 ? 0 : 1;
}
)";

TEST(Headers, RoundNearTheLeastNormalNumberAsTheProcessorDoes) {
  const TemporaryFolder folder;
  folder.write("corduroy.hpp", header(corduroy()));
  const std::string source = folder.write("beside.cpp", beside_the_processor), program = folder / "program";
  for (const std::string& compiler : compilers()) {
    EXPECT_EQ(said_by(compiler + " -std=c++17 -O1 -Wall -Wextra -Werror -o " + program + " " + source), "") << compiler;
    const std::string command = program + " >" + (folder / "found");
    const bool agrees = std::system(command.c_str()) == 0;
    std::ifstream found(folder / "found");
    EXPECT_TRUE(agrees) << compiler << ": " << std::string{std::istreambuf_iterator<char>(found), {}};
  }
}
#endif

TEST(Headers, SayWhatMemoryTheyNeed) {
  const std::string text = header(corduroy(), {"wale"});
  EXPECT_NE(text.find("  1024  stack while setup runs"), std::string::npos) << text.substr(0, 2000);
  EXPECT_EQ(header(corduroy()).find("stack while setup runs"), std::string::npos);
  for (const auto& path : shipped_files()) {
    const File file(path);
    for (const auto& material : materials_of(file.opened)) {
      const Program program = file.program(material);
      const PatchProgram& description = program.description();
      const std::string of_material = header(program);
      std::size_t cells = 0;
      for (const Grid& grid : description.grids) cells += std::size_t{grid.columns} * grid.rows;
      if (cells > 0) {
        EXPECT_NE(of_material.find("  " + std::to_string(4 * cells) + "  RAM: Cells"), std::string::npos) << material;
      }
      if (!description.states.empty()) {
        EXPECT_NE(of_material.find("  " + std::to_string(8 * description.states.size()) + "  RAM: State"),
                  std::string::npos)
            << material;
      }
    }
  }
}

TEST(Headers, NameTheNearestLivePart) {
  const auto refused = live_parts(corduroy().description(), {"wale", "sise"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().mend, "did you mean `size`?");
  const auto all = live_parts(corduroy().description(), {"all"});
  ASSERT_TRUE(all);
  EXPECT_TRUE(all->size && all->any());
}

}  // namespace
}  // namespace wale::listing::headers_test
