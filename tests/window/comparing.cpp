// What the window says of a patch while its sliders move, and of two patches beside each other.
#include <QPlainTextEdit>
#include <QTableWidget>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

constexpr const char* benches = R"(wale 1

material bench {
  physical {
    param size = 1 N in 0 N .. 4 N  "how hard"
    param every = 4 mm in 1 mm .. 8 mm  "from ridge to ridge"
    force = vector(size * sin(2 * pi * x / every), 0 N)
  }
}

workspace two {
  patch near = bench { at -40 mm, 0 mm; size 60 mm, 60 mm }
  patch far = bench(size: 1.02 N) { at 40 mm, 0 mm; size 60 mm, 60 mm }
  patch rough = denim { at 0 mm, 60 mm; size 40 mm, 40 mm }
}
)";

class ToldWindow : public DrivenWindow {
 protected:
  void SetUp() override {
    begin();
    ASSERT_TRUE(window->open(write("two.wale", benches)));
    wait_for_programs();
  }
  QString described() {
    EXPECT_TRUE(wait_until([&] { return !window->is_busy(); }, 60000));
    return window->findChild<QWidget*>("dock_description")->findChild<QPlainTextEdit*>()->toPlainText();
  }
  void choose(std::set<const char*> names) {
    std::set<std::uint64_t> ids;
    for (const char* each : names) ids.insert(placed(each).id);
    window->document().choose(ids);
  }
};

TEST_F(ToldWindow, TwoChosenPatchesAreCompared) {
  choose({"near", "far"});
  // 2 % of force: far less than anyone notices.
  EXPECT_TRUE(described().contains("hard to tell apart")) << described().toStdString();
  EXPECT_TRUE(described().startsWith("near and far")) << described().toStdString();
  // Three times the force is told apart by everyone.
  window->document().set_argument(placed("far").id, "size", 3, "3 N", 0);
  EXPECT_TRUE(described().contains("can tell them apart")) << described().toStdString();
  EXPECT_TRUE(described().contains("3 N")) << described().toStdString();
  trigger("undo");
  EXPECT_TRUE(described().contains("hard to tell apart")) << described().toStdString();
  choose({"near", "rough"});
  EXPECT_TRUE(described().startsWith("near and rough")) << described().toStdString();
  choose({"near"});
  EXPECT_TRUE(described().startsWith("near = bench")) << described().toStdString();
}

TEST_F(ToldWindow, TheDescriptionIsOfWhatTheSlidersSay) {
  choose({"near"});
  EXPECT_TRUE(described().contains("\n  1 N")) << described().toStdString();
  EXPECT_TRUE(described().contains("fading over 1 mm")) << described().toStdString();  // as it is felt beside others
  window->document().set_argument(placed("near").id, "size", 2.5, "2.5 N", 0);
  EXPECT_TRUE(described().startsWith("near = bench(size: 2.5 N)")) << described().toStdString();
  EXPECT_TRUE(described().contains("\n  2.5 N")) << described().toStdString();
  EXPECT_FALSE(described().contains("\n  1 N")) << described().toStdString();
  choose({"rough"});
  const auto asked = [&] {
    described();
    auto* table = window->findChild<QWidget*>("dock_description")->findChild<QTableWidget*>();
    for (int row = 0; row < table->rowCount(); ++row)
      if (table->item(row, 0)->text() == "roughness") return table->item(row, 1)->text() + table->item(row, 2)->text();
    return QString();
  };
  const QString before = asked();
  window->document().set_argument(placed("rough").id, "roughness", 0.5f, "0.5", 0);
  EXPECT_EQ(asked(), "0.500.50");
  EXPECT_NE(before, asked());
}

TEST_F(ToldWindow, ByKeyboardToo) {
  canvas().setFocus();
  QTest::keyClick(&canvas(), Qt::Key_N);
  EXPECT_EQ(window->document().chosen(), (std::set{placed("near").id}));
  QTest::keyClick(&canvas(), Qt::Key_N, Qt::ShiftModifier);
  EXPECT_EQ(window->document().chosen(), (std::set{placed("near").id, placed("far").id}));
  trigger("compare");
  EXPECT_TRUE(described().startsWith("near and far")) << described().toStdString();
  QTest::keyClick(&canvas(), Qt::Key_P, Qt::ShiftModifier);  // before the first: the last
  EXPECT_EQ(window->document().chosen().size(), 3u);
  EXPECT_FALSE(window->action("compare")->isEnabled());
}

}  // namespace
}  // namespace sandpaper
