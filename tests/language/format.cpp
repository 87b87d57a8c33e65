// wale format: one style, nothing is lost, and formatting twice changes nothing.

#include "compiler/format/format.hpp"

#include <gtest/gtest.h>

#include "compiler/diagnostics/render.hpp"
#include "tests/language/grammar.hpp"
#include "tests/language/reading.hpp"
#include "tests/language/shipped.hpp"

namespace {

/// The formatted text, or its errors.
std::string formatted(const std::string& text) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  const auto result = format(sources, sources.add("test.wale", text), diagnostics);
  if (result) return *result;
  std::string errors;
  for (const auto& each : diagnostics.all()) errors += render_text(each, sources, false);
  return errors;
}

std::string statement(const std::string& text) {
  const std::string result = formatted("wale 1\nmaterial m { physical {\n" + text + "\n} }\n");
  const std::string head = "wale 1\nmaterial m {\n  physical {\n", tail = "  }\n}\n";
  if (!result.starts_with(head)) return result;
  return result.substr(head.size(), result.size() - head.size() - tail.size());
}

TEST(Format, SpacesOperatorsAndNotParentheses) {
  EXPECT_EQ(statement("let  a=- 3*( b+c )/f( x ,y )^ 2"), "    let a = -3 * (b + c) / f(x, y)^2\n");
  EXPECT_EQ(statement("let a = b-c + - d - -e"), "    let a = b - c + -d - -e\n");
  EXPECT_EQ(statement("let a = + -b"), "    let a = + -b\n");  // `+-` would be a tolerance
  EXPECT_EQ(statement("let a=if b<c then(b)else-c"), "    let a = if b < c then (b) else -c\n");
  EXPECT_EQ(statement("height h=grating( x,period :2mm )"), "    height h = grating(x, period: 2 mm)\n");
  EXPECT_EQ(statement("param p=5mm in 1mm..9mm\"why\""), "    param p = 5 mm in 1 mm .. 9 mm  \"why\"\n");
  EXPECT_EQ(statement("state p:position=hand in -6mm..6mm"), "    state p : position = hand in -6 mm .. 6 mm\n");
  EXPECT_EQ(statement("v '=-k; next  v=0"), "    v' = -k\n    next v = 0\n");
  EXPECT_EQ(statement("force a=b  limit-c"), "    force a = b limit -c\n");
  EXPECT_EQ(statement("force=2mm*k  limit\t3N"), "    force = 2 mm * k limit 3 N\n");
  EXPECT_EQ(statement("show- x; patch 2mm ,3mm"), "    show -x\n    patch 2 mm, 3 mm\n");
}

TEST(Format, UnitsAreTightAndQuotientsAreNot) {
  EXPECT_EQ(statement("let a = 0.8N s / m"), "    let a = 0.8 N s/m\n");
  EXPECT_EQ(statement("let a = 1 kg m ^ 2/s^ - 2"), "    let a = 1 kg m^2/s^-2\n");
  EXPECT_EQ(statement("let a = 10 N/512"), "    let a = 10 N / 512\n");
  EXPECT_EQ(statement("let a = 5 N / mass + b/c"), "    let a = 5 N / mass + b / c\n");
  EXPECT_EQ(statement("let a = 24/256 + 1 /2"), "    let a = 24/256 + 1 / 2\n");
  EXPECT_EQ(formatted("wale 1\nunit ell = 1 m\nlet a = 3 N / ell"), "wale 1\nunit ell = 1 m\nlet a = 3 N/ell\n");
}

TEST(Format, SettingsStandInColumns) {
  EXPECT_EQ(formatted("wale 1\nlevels rough{fine 0.1;medium 0.2\n\n//c\n  coarse  0.3}"),
            "wale 1\nlevels rough {\n  fine   0.1\n  medium 0.2\n\n  // c\n  coarse 0.3\n}\n");
  EXPECT_EQ(formatted("wale 1\ndevice d { speed 1 m/s\nvelocity_filter 15, 1 counts\nrate 900 Hz }"),
            "wale 1\ndevice d {\n  speed 1 m/s\n  velocity_filter 15, 1 counts\n  rate  900 Hz\n}\n");
  EXPECT_EQ(
      formatted("wale 1\nmap a from b{valid amplitude -3N..3N, (a - b)*2 .. c on d\nlaw log(x) - 1=2}"),
      "wale 1\nmap a from b {\n  valid amplitude -3 N .. 3 N, (a - b) * 2 .. c on d\n  law   log(x) - 1 = 2\n}\n");
  // Also where the value begins with a parenthesis, written close or apart.
  for (const std::string between : {"", " ", "    "})
    EXPECT_EQ(formatted("wale 1\nmap a from b{valid c 1 N..2 N\nlaw" + between + "(x)=2}"),
              "wale 1\nmap a from b {\n  valid c 1 N .. 2 N\n  law   (x) = 2\n}\n");
}

TEST(Format, ConsecutiveDeclarationsOfOneKindStandInColumns) {
  EXPECT_EQ(formatted("wale 1\nunit N = 1 kg m/s^2\nunit ozf = 0.28 N\n\nunit kilogramme = 1 kg\nlet a = 1"),
            "wale 1\nunit N   = 1 kg m/s^2\nunit ozf = 0.28 N\n\nunit kilogramme = 1 kg\nlet a = 1\n");
  EXPECT_EQ(statement("param a = 1 \"one\"\nparam abc = 2 in 1 .. 3 \"two\"\nforce = b"),
            "    param a   = 1            \"one\"\n    param abc = 2 in 1 .. 3  \"two\"\n    force = b\n");
}

TEST(Format, ShortBlocksStayInTheirLine) {
  EXPECT_EQ(formatted("wale 1\nmaterial a { perceptual {roughness 0.6} }"),
            "wale 1\nmaterial a {\n  perceptual { roughness 0.6 }\n}\n");
  EXPECT_EQ(formatted("wale 1\nmaterial a\n{ perceptual { roughness 0.6; softness 1 } physical { } }"),
            "wale 1\nmaterial a {\n  perceptual {\n    roughness 0.6\n    softness 1\n  }\n  physical {}\n}\n");
  EXPECT_EQ(formatted("wale 1\nlevels a { // why\nb 1 }"), "wale 1\nlevels a {   // why\n  b 1\n}\n");
}

TEST(Format, KeepsOneBlankLineBetweenAndNoneAtTheEdges) {
  EXPECT_EQ(formatted("\n\nwale 1\n\n\n\nlevels a {\n\n  b 1\n\n\n  c 2\n\n}\n\n\n"),
            "wale 1\n\nlevels a {\n  b 1\n\n  c 2\n}\n");
}

TEST(Format, CommentsStayWhereTheyBelong) {
  EXPECT_EQ(
      formatted("wale 1 //a\n//b\nlet a=1;/*c*/let b=2 //d\n\n///e\nlet c=3 // f\nlet ddd = 44 // g"),
      "wale 1   // a\n// b\nlet a = 1\n/*c*/ let b = 2   // d\n\n/// e\nlet c   = 3    // f\nlet ddd = 44   // g\n");
  EXPECT_EQ(statement("let a = b + // first\n c // second"),
            "    let a = b +   // first\n      c           // second\n");
  EXPECT_EQ(formatted("wale 1\r\n/* a  \r\n   b */\r\nlet a = 1  \r\n"), "wale 1\n/* a\n   b */\nlet a = 1\n");
}

TEST(Format, DocumentationOfNothingBecomesAComment) {
  EXPECT_EQ(formatted("wale 1\nlet a = 1 /// of nothing\n;\nlet b = 2"),
            "wale 1\nlet a = 1   // of nothing\nlet b = 2\n");
}

TEST(Format, BrokenStatementsStayBrokenAndLongOnesBreakAtTheLoosestOperator) {
  EXPECT_EQ(statement("next v = lateral(\na,\n b(\n2))"), "    next v = lateral(\n      a,\n      b(\n        2))\n");
  EXPECT_EQ(statement("force = f(\na,\n)"), "    force = f(\n      a,\n    )\n");
  const std::string sum = "first_long_name * second_long_name + third_long_name * fourth_long_name";
  EXPECT_EQ(statement("let a = " + sum + " + " + sum), "    let a =\n      " + sum + " +\n      " + sum + "\n");
  EXPECT_EQ(formatted("wale 1\nfunction f(a: length, b: length) = " + sum + " + max(0, 1)"),
            "wale 1\nfunction f(a: length, b: length) =\n  " + sum + " + max(0, 1)\n");
}

TEST(Format, LeavesFilesWithErrorsAlone) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  EXPECT_EQ(format(sources, sources.add("test.wale", "wale 1\nlet a = (\n"), diagnostics), std::nullopt);
  EXPECT_TRUE(diagnostics.has_errors());
}

TEST(Format, TheShippedFilesAreFormatted) {
  for (const auto& [name, text] : wale::shipped_files()) EXPECT_EQ(formatted(text), text) << name;
}

/// Expects that formatting keeps the tree and the comments, and that formatting again changes nothing.
void expect_kept(const std::string& text, const std::vector<std::string>& comments) {
  const Reading before(text);
  const std::string once = formatted(text);
  const Reading after(once);
  ASSERT_EQ(after.errors(), before.errors()) << text << "\n=====\n" << once;
  EXPECT_EQ(after.printed(), before.printed()) << text;
  EXPECT_EQ(formatted(once), once) << text;
  std::size_t at = 0;
  for (const std::string& comment : comments) {
    at = once.find("<" + comment + ">", at);
    ASSERT_NE(at, std::string::npos) << comment << " is lost:\n" << text << "\n=====\n" << once;
  }
  for (std::size_t i = 1; i < once.size(); ++i) {
    if (once[i] != '\n') continue;
    EXPECT_NE(once[i - 1], ' ') << "a blank at the end of a line:\n" << once;
    EXPECT_FALSE(once.compare(i, 3, "\n\n\n") == 0) << once;
  }
}

TEST(RoundTrip, OfRandomFilesKeepsMeaningAndComments) {
  const Grammar grammar(wale::shipped_file("schema/wale.grammar"));
  std::mt19937 random(9);
  int formatted_files = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    std::vector<std::string> comments;
    const std::string text = grammar.sentence(random, 20 + i % 300, &comments);
    if (Reading(text).diagnostics.has_errors()) continue;
    expect_kept(text, comments);
    ++formatted_files;
  }
  EXPECT_GT(formatted_files, 1000);
}

TEST(RoundTrip, OfShippedFilesInOneLineOrMangledKeepsTheirMeaning) {
  std::mt19937 random(10);
  for (const auto& [name, text] : wale::shipped_files()) {
    expect_kept(text, {});
    for (int round = 0; round < 20; ++round) {
      std::string mangled;
      bool comment = false, quoted = false;
      for (std::size_t i = 0; i < text.size(); ++i) {
        comment = text[i] != '\n' && (comment || (!quoted && text.compare(i, 2, "//") == 0));
        if (!comment && text[i] == '"') quoted = !quoted;
        const bool blank = text[i] == ' ' && !comment && !quoted;
        mangled += text[i];
        if (blank && random() % 2 == 0) mangled += random() % 2 == 0 ? "\t " : " /* a */ ";
        if (text[i] == '\n' && random() % 3 == 0) mangled += "\n\n  ";
      }
      expect_kept(mangled, {});
    }
  }
}

}  // namespace
