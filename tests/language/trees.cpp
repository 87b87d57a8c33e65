#include <gtest/gtest.h>

#include "tests/language/reading.hpp"

namespace {

TEST(Expressions, BindAsInMathematics) {
  EXPECT_EQ(expression("a + b * c"), "(+ a (* b c))");
  EXPECT_EQ(expression("a - b - c"), "(- (- a b) c)");
  EXPECT_EQ(expression("a / b * c"), "(* (/ a b) c)");
  EXPECT_EQ(expression("(a - b) / c"), "(/ (- a b) c)");
  EXPECT_EQ(expression("-a * b"), "(* (- a) b)");
  EXPECT_EQ(expression("a * -b"), "(* a (- b))");
  EXPECT_EQ(expression("a + b < c * d"), "(< (+ a b) (* c d))");
}

TEST(Expressions, APowerBindsTighterThanTheSignBeforeIt) {
  EXPECT_EQ(expression("-2^2"), "(- (^ 2 2))");
  EXPECT_EQ(expression("2^3^2"), "(^ 2 (^ 3 2))");
  EXPECT_EQ(expression("2^-1"), "(^ 2 (- 1))");
  EXPECT_EQ(expression("a^2 * b"), "(* (^ a 2) b)");
  EXPECT_EQ(expression("f(x)^2"), "(^ (f x) 2)");
}

TEST(Expressions, Conditionals) {
  EXPECT_EQ(expression("if a < 0 then -a else a + 1"), "(if (< a 0) (- a) (+ a 1))");
  EXPECT_EQ(expression("if a < 0 then 1 else if a > 1 then 2 else 3"), "(if (< a 0) 1 (if (> a 1) 2 3))");
  EXPECT_EQ(expression("2 * (if a >= b then 1 else 2)"), "(* 2 (if (>= a b) 1 2))");
  EXPECT_EQ(expression("if a < 0\n  then 1\n  else 2"), "(if (< a 0) 1 2)");
}

TEST(Expressions, CallsTakeNamedArguments) {
  EXPECT_EQ(expression("grating(x, period: 2.5 mm, duty: 0.5)"), "(grating x period: [2.5 mm] duty: 0.5)");
  EXPECT_EQ(expression("patch_fade()"), "(patch_fade)");
  EXPECT_EQ(expression("f(\n  a,\n  b,\n)"), "(f a b)");
  EXPECT_EQ(expression("image(\"slate.tif\", scale: 0.1 mm/px)"), "(image \"slate.tif\" scale: [0.1 mm/px])");
  EXPECT_EQ(expression("fabric.corduroy(wale: 1.2 mm)"), "(fabric.corduroy wale: [1.2 mm])");
}

TEST(Expressions, ASpanCoversItsParentheses) {
  const Reading reading("wale 1\nlet a = k * (b + c)\n");
  const auto& tree = reading.tree;
  const auto& value = std::get<wale::Constant>(tree.declarations.at(0)).value;
  EXPECT_EQ(reading.sources.text(tree.span(value)), "k * (b + c)");
  EXPECT_EQ(reading.sources.text(tree.span(std::get<wale::Binary>(tree.expr(value)).right)), "(b + c)");
}

TEST(Suffixes, AreTheNamesBehindANumber) {
  EXPECT_EQ(expression("120 N/m"), "[120 N/m]");
  EXPECT_EQ(expression("0.8 N s/m"), "[0.8 N s/m]");
  EXPECT_EQ(expression("1 kg m^2/s^2"), "[1 kg m^2/s^2]");
  EXPECT_EQ(expression("1 s^-1"), "[1 s^-1]");
  EXPECT_EQ(expression("50 %"), "[50 %]");
  EXPECT_EQ(expression("50%"), "[50 %]");
  EXPECT_EQ(expression("5mm"), "[5 mm]");
  EXPECT_EQ(expression("0.1 mm/px"), "[0.1 mm/px]");
  EXPECT_EQ(expression("0.7 corduroy + 0.3 denim"), "(+ [0.7 corduroy] [0.3 denim])");
}

TEST(Suffixes, EndWhereArithmeticBegins) {
  EXPECT_EQ(expression("10 N / 512"), "(/ [10 N] 512)");
  EXPECT_EQ(expression("24/256"), "(/ 24 256)");
  EXPECT_EQ(expression("2 m * k"), "(* [2 m] k)");
  EXPECT_EQ(expression("2 / sin(x)"), "(/ 2 (sin x))");
  EXPECT_EQ(expression("2 N / sin(x)"), "(/ [2 N] (sin x))");
  EXPECT_EQ(expression("1 / x^2.5"), "(/ 1 (^ x 2.5))");
  EXPECT_EQ(expression("1 / x^n"), "(/ 1 (^ x n))");
  EXPECT_EQ(expression("1 / 1 s"), "(/ 1 [1 s])");
  EXPECT_EQ(expression("2^2 m"), "(^ 2 [2 m])");
  EXPECT_EQ(expression("f(2 m, period: 3 s)"), "(f [2 m] period: [3 s])");
}

TEST(Suffixes, EndAtTheLimitOfAForce) {
  EXPECT_EQ(physical("force = k * 5 mm limit 3 N"), "(force (* k [5 mm]) (limit [3 N]))");
  EXPECT_EQ(physical("force drag = viscous(2 N s/m) limit\n  a + b"), "expected a value after `limit`");
  EXPECT_EQ(physical("force drag = a limit b / 2"), "(force drag a (limit (/ b 2)))");
  EXPECT_EQ(physical("force = limit limit 3"), "(force limit (limit 3))");
  EXPECT_EQ(physical("force = 3 limit limit"), "(force 3 (limit limit))");
  EXPECT_EQ(physical("let a = 2 limit"), "(let a [2 limit])");
  EXPECT_EQ(physical("let limit = 2\nforce = limit"), "(let limit 2)\n    (force limit)");
}

TEST(Suffixes, DoNotCrossALineUnlessInParentheses) {
  EXPECT_EQ(physical("let a = 5\nforce = a"), "(let a 5)\n    (force a)");
  EXPECT_EQ(expression("(5\n  mm)"), "[5 mm]");
}

TEST(Lines, ContinueAfterAnOperatorACommaOrAnEqualsSign) {
  EXPECT_EQ(expression("b +\n  c"), "(+ b c)");
  EXPECT_EQ(expression("\n  b *\n  // why\n  c"), "(* b c)");
  EXPECT_EQ(physical("patch 95 mm,\n  95 mm"), "(patch [95 mm] [95 mm])");
  EXPECT_EQ(physical("param a = 1 in 0 ..\n  2"), "(param a 1 (in 0 2))");
  EXPECT_EQ(physical("let a = b; let c = d"), "(let a b)\n    (let c d)");
}

TEST(Names, AreFreeForDesigners) {
  for (const char* name : {"k",    "b",    "p",     "v",   "s",    "m",    "g",    "force",     "material", "param",
                           "next", "show", "state", "map", "unit", "hand", "wale", "essential", "physical", "x1_"}) {
    EXPECT_EQ(expression(std::string(name) + " + 1"), "(+ " + std::string(name) + " 1)");
    EXPECT_EQ(physical("let " + std::string(name) + " = 1"), "(let " + std::string(name) + " 1)");
  }
}

TEST(Declarations, OfDimensionsUnitsAndFunctions) {
  EXPECT_EQ(Reading("wale 1\n"
                    "import fabric.denim\n"
                    "dimension length\n"
                    "dimension force = mass * length / time^2\n"
                    "unit m : length\n"
                    "unit N = 1 kg m/s^2\n"
                    "unit % = 0.01\n"
                    "/// The circle's.\n"
                    "let pi = 3.14\n"
                    "function grating(along: length, duty = 0.5, h: height = open) = along / duty\n")
                .printed(),
            "(import fabric.denim)\n"
            "(dimension length)\n"
            "(dimension force (/ (* mass length) (^ time 2)))\n"
            "(unit m : length)\n"
            "(unit N [1 kg m/s^2])\n"
            "(unit % 0.01)\n"
            "(documented \"The circle's.\") (let pi 3.14)\n"
            "(function (grating along : length duty = 0.5 h : height = open) (/ along duty))\n");
}

TEST(Declarations, RecordsHoldSettings) {
  const Reading reading(
      "wale 1\n"
      "percept roughness {\n"
      "  one  lateral amplitude 194 pu, period 10 mm on sandpaper\n"
      "  zero nothing\n"
      "}\n"
      "map roughness from amplitude {\n"
      "  law      log10(magnitude) = 0.759593 * log10(amplitude / 1 pu) - 0.513365\n"
      "  valid    amplitude 9 pu .. 194 pu; period 0.7 mm .. 10 mm\n"
      "  evidence slope measured, anchor measured\n"
      "  on       sandpaper\n"
      "  source   \"Minsky 1995, figure 19\"\n"
      "}\n"
      "device sandpaper { workspace disc(228.6 mm); force 10 N, 2048 counts; mass 0.3 kg assumed\n"
      "  slew assumed 200 N/s; offset x -3 mm .. 3 mm\n"
      "  realise roughness = lateral(grating(x, period: 2.5 mm)) }\n"
      "levels roughness { polished 0.1; smooth 0.17 }\n");
  EXPECT_EQ(reading.errors(), std::vector<std::string>{});
  EXPECT_EQ(reading.printed(),
            "(percept roughness\n"
            "  (one {lateral amplitude [194 pu]} {period [10 mm]} on sandpaper)\n"
            "  (zero nothing))\n"
            "(map roughness from amplitude\n"
            "  (law {(log10 magnitude) = (- (* 0.759593 (log10 (/ amplitude [1 pu]))) 0.513365)})\n"
            "  (valid {amplitude [9 pu] .. [194 pu]})\n"
            "  (period {[0.7 mm] .. [10 mm]})\n"
            "  (evidence {slope measured} {anchor measured})\n"
            "  (on sandpaper)\n"
            "  (source \"Minsky 1995, figure 19\"))\n"
            "(device sandpaper\n"
            "  (workspace (disc [228.6 mm]))\n"
            "  (force [10 N] [2048 counts])\n"
            "  (mass {[0.3 kg] assumed})\n"
            "  (slew {assumed [200 N/s]})\n"
            "  (offset {x (- [3 mm]) .. [3 mm]})\n"
            "  (realise {roughness = (lateral (grating x period: [2.5 mm]))}))\n"
            "(levels roughness\n"
            "  (polished 0.1)\n"
            "  (smooth 0.17))\n");
}

TEST(Materials, HaveThreeLayers) {
  const Reading reading(
      "wale 1\n"
      "/// Ribbed.\n"
      "material corduroy {\n"
      "  representative {\n"
      "    title  \"Wide-wale corduroy\"\n"
      "    called \"corduroy\", \"ribbed cotton\"\n"
      "    kind   fabric.woven\n"
      "    like   denim\n"
      "  }\n"
      "  perceptual { roughness coarse; stickiness 0.3 +- 0.1; essential softness 0.8 ± 0.05 }\n"
      "  physical {\n"
      "    /// How far apart.\n"
      "    param wale = 2.5mm in 1mm..5mm  \"distance between ribs\"\n"
      "    height ribs = grating(x, period: wale)\n"
      "    force = lateral(ribs)\n"
      "    patch 95 mm, 95 mm\n"
      "  }\n"
      "}\n");
  EXPECT_EQ(reading.errors(), std::vector<std::string>{});
  EXPECT_EQ(reading.printed(),
            "(documented \"Ribbed.\") (material corduroy\n"
            "  (representative\n"
            "    (title \"Wide-wale corduroy\")\n"
            "    (called \"corduroy\" \"ribbed cotton\")\n"
            "    (kind fabric.woven)\n"
            "    (like denim))\n"
            "  (perceptual\n"
            "    (roughness 'coarse)\n"
            "    (stickiness 0.3 ± 0.1)\n"
            "    (essential softness 0.8 ± 0.05))\n"
            "  (physical\n"
            "    (documented \"How far apart.\") (param wale [2.5 mm] (in [1 mm] [5 mm]) \"distance between ribs\")\n"
            "    (height ribs (grating x period: wale))\n"
            "    (force (lateral ribs))\n"
            "    (patch [95 mm] [95 mm])))\n");
}

TEST(Materials, HaveStatesAndUpdates) {
  EXPECT_EQ(physical("state p : position = hand in -60 mm .. 60 mm\n"
                     "state v = 0 m/s\n"
                     "let pull = k * (hand - p)\n"
                     "v' = (pull - b * v) / mass\n"
                     "next p = p + 1 mm\n"
                     "force = -pull\n"
                     "show box(p, 20 mm, 10 mm)"),
            "(state p : position hand (in (- [60 mm]) [60 mm]))\n"
            "    (state v [0 m/s])\n"
            "    (let pull (* k (- hand p)))\n"
            "    (derivative v (/ (- pull (* b v)) mass))\n"
            "    (next p (+ p [1 mm]))\n"
            "    (force (- pull))\n"
            "    (show (box p [20 mm] [10 mm]))");
}

TEST(Materials, DeriveFromOthers) {
  EXPECT_EQ(Reading("wale 1\n"
                    "material workwear      = 0.7 corduroy + 0.3 denim { perceptual { roughness 0.5 } }\n"
                    "material fine_corduroy = corduroy(wale: 1.2 mm)\n"
                    "material heavy = 2 * denim\n"
                    "{ perceptual { roughness 0.5 } }\n"
                    "material slate { physical { force = x } perceptual { roughness 0.8 } }\n")
                .printed(),
            "(material workwear = (+ [0.7 corduroy] [0.3 denim])\n  (perceptual\n    (roughness 0.5)))\n"
            "(material fine_corduroy = (corduroy wale: [1.2 mm]))\n"
            "(material heavy = (* 2 denim)\n  (perceptual\n    (roughness 0.5)))\n"
            "(material slate\n  (perceptual\n    (roughness 0.8))\n  (physical\n    (force x)))\n");
}

TEST(Lists, OfExpressionsComeFromTheCommandLine) {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  wale::SyntaxTree tree;
  const auto read = [&](const char* text) {
    std::string printed;
    for (const wale::ExprId id : parse_expressions(sources, sources.add("--at", text), tree, diagnostics)) {
      printed += print_expression(tree, id) + ";";
    }
    return printed;
  };
  EXPECT_EQ(read("10 mm, 5 mm, 0.1 m/s, 0 m/s"), "[10 mm];[5 mm];[0.1 m/s];[0 m/s];");
  EXPECT_EQ(read("-1 mm"), "(- [1 mm]);");
  EXPECT_FALSE(diagnostics.has_errors());
  for (const char* wrong : {"", "1 mm,", "1 mm 2 mm", "1; 2", "a }", "(1", "@"}) {
    wale::Diagnostics each;
    EXPECT_TRUE(parse_expressions(sources, sources.add("--at", wrong), tree, each).empty()) << wrong;
    EXPECT_EQ(each.error_count(), 1u) << wrong;
  }
}

}  // namespace
