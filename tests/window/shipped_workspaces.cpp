// The workspaces that come with the window: the haptic desktop, the demonstrations of the thesis, a keypad and a
// kitchen.
#include <filesystem>
#include <wale/program.hpp>

#include "canvas/surface_image.hpp"
#include "driven_window.hpp"

namespace sandpaper {
namespace {

const std::filesystem::path folder_of_window = WALE_SOURCE_DIR "/examples/sandpaper";

class ShippedWorkspace : public DrivenWindow, public ::testing::WithParamInterface<std::string> {
 protected:
  QString file() const { return QString::fromStdString((folder_of_window / (GetParam() + ".wale")).string()); }

  /// Rubs over each patch until a force comes, in newtons; that of the strongest. On a busy machine the mouse leaps, and
  /// balls that fly about come to rest where nobody rubs, so it rubs over the whole of each patch before it gives up.
  double felt() {
    double most = felt_in({0, 0.2}, 20);
    for (int times = 0; times < 3 && most <= least_told; ++times)
      most = std::max(most, felt_in({-0.4, -0.2, 0, 0.2, 0.4}, 200));
    return most;
  }
  /// Along some lines, of each patch's height from its middle, up to `farthest` mm to each side.
  double felt_in(std::initializer_list<double> lines, double farthest) {
    double most = 0;
    for (const PlacedRef& each : contents().placed) {
      if (!each->is_laid_out()) continue;
      const glm::dvec2 at = 1e3 * each->patch.at;  // mm
      const double half = std::min(farthest, 400 * canvas().size_of(*each).x);
      // Beside its middle too: a detent pulls nowhere in its middle.
      for (const double beside : lines)
        most = std::max(most, rub(at.x, at.y + 1e3 * beside * canvas().size_of(*each).y, half, 1));
      if (most > least_told) break;
    }
    return most;
  }

  static constexpr double least_told = 0.05;  // N
};

TEST_P(ShippedWorkspace, HasNoErrorsNorWarnings) {
  const std::string text = read(file());
  ASSERT_FALSE(text.empty());
  for (const wale::Problem& each : language().check(text).problems) ADD_FAILURE() << wale::in_words(each.error);
  const auto shown = library().presentation(text);
  ASSERT_TRUE(shown) << wale::explained(shown.error());
  ASSERT_FALSE(shown->workspaces.empty());
  for (const std::string& name : shown->workspaces) {
    const auto compiled = library().workspace(text, {.workspace = name, .legibility = true});
    ASSERT_TRUE(compiled) << name << ": " << wale::explained(compiled.error());
    EXPECT_FALSE(compiled->workspace.documentation.empty()) << name;
    for (const wale::Error& each : compiled->warnings) ADD_FAILURE() << name << ": " << wale::in_words(each);
  }
}

TEST_P(ShippedWorkspace, OpensAndIsFeltFrameByFrame) {
  ASSERT_TRUE(window->open(file()));
  const std::string text = window->document().text();
  EXPECT_EQ(text, read(file()));
  const auto shown = library().presentation(text);
  ASSERT_TRUE(shown);
  const std::vector<std::string> frames =
      shown->movies.empty() ? shown->workspaces : shown->movies.front().frames;
  if (GetParam() == "demonstrations") EXPECT_GE(frames.size(), 20u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0) trigger("next_frame");
    ASSERT_EQ(contents().name, frames[i]);
    ASSERT_FALSE(contents().placed.empty());
    wait_for_programs();
    if (!window->feeling().is_on()) trigger("feel");
    ASSERT_TRUE(window->feeling().is_on()) << frames[i] << ": " << announced().toStdString();
    EXPECT_GT(felt(), least_told) << frames[i] << ": " << announced().toStdString() << ", after "
                                  << window->feeling().now().ticks_run << " ticks";
  }
  EXPECT_EQ(window->document().text(), text);  // stepping through changes nothing
}

/// The light comes from the upper left, so that side of a hill is bright and that of a hollow dark.
TEST(SurfaceImage, AHillIsBrightTowardsTheLight) {
  for (const int sign : {1, -1}) {
    const wale::LanguageService language;
    const auto compiled = language.compile(
        "wale 1\nmaterial hill { physical {\n patch 20 mm, 20 mm\n force = vector(0 N, 0 N)\n"
        " show relief(" +
        std::string(sign > 0 ? "" : "-") + "exp(-dot(hand, hand) / (6 mm)^2))\n} }\n");
    ASSERT_TRUE(compiled.program);
    const wale::Bank bank(*compiled.program);
    const QImage image = surface_image(bank, nullptr, {0.02f, 0.02f}, {}, {40, 40}, Look::relief, Qt::lightGray);
    EXPECT_GT(sign * (qGray(image.pixel(13, 13)) - qGray(image.pixel(26, 26))), 40) << sign;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorkspace,
                         ::testing::Values("desktop", "demonstrations", "keypad", "kitchen"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace sandpaper
