// What other programs write into the file that is open, and files that are no text.
#include <QComboBox>
#include <QToolButton>

#include "driven_window.hpp"
#include "window/announcement.hpp"

namespace sandpaper {
namespace {

constexpr const char* one_patch = "wale 1\n\nworkspace one {\n  patch p = oak { at 0 mm, 0 mm; size 40 mm, 40 mm }\n}\n";
constexpr const char* added = "\nworkspace other {\n  patch q = denim\n}\n";

class SharedFile : public DrivenWindow {
 protected:
  void SetUp() override {
    begin();
    file = write("shared.wale", one_patch);
    ASSERT_TRUE(window->open(file));
    wait_for_programs();
  }
  void append() { std::ofstream(file.toStdString(), std::ios::app) << added; }
  void move() {
    window->document().choose({placed("p").id});
    QTest::keyClick(&canvas(), Qt::Key_Left);
  }
  QString file;
};

TEST_F(SharedFile, WhatAnotherProgramWroteIsShown) {
  append();
  ASSERT_TRUE(wait_until([&] { return window->document().workspaces().size() == 2; }, 5000));
  EXPECT_TRUE(announced().contains("changed by another program")) << announced().toStdString();
  EXPECT_FALSE(window->document().is_modified());
  EXPECT_EQ(window->document().text(), std::string(one_patch) + added);
  trigger("undo");  // it was a step like any other
  EXPECT_EQ(window->document().text(), one_patch);
  EXPECT_TRUE(window->document().is_modified());
}

TEST_F(SharedFile, SavingDoesNotTakeItAway) {
  move();
  append();
  trigger("save");
  EXPECT_EQ(read(file), std::string(one_patch) + added);
  EXPECT_TRUE(window->document().is_modified());
  EXPECT_TRUE(announced().contains("was changed by another program")) << announced().toStdString();
  // Its author can say that this version counts.
  QToolButton* over = nullptr;
  for (QToolButton* each : window->findChildren<QToolButton*>())
    if (each->text() == "Save over it") over = each;
  ASSERT_TRUE(over);
  over->click();
  EXPECT_EQ(read(file), window->document().text());
  EXPECT_EQ(read(file).find("other"), std::string::npos);
  EXPECT_FALSE(window->document().is_modified());
  move();
  trigger("save");  // and it is not asked again
  EXPECT_EQ(read(file), window->document().text());
}

TEST_F(SharedFile, AnotherWindowsWorkIsKept) {
  MainWindow other(library(), language());
  ASSERT_TRUE(other.open(file));
  move();
  other.document().set_text(std::string(one_patch) + "// the other's\n", "Type");
  ASSERT_TRUE(other.document().save(file));
  trigger("save");
  EXPECT_NE(read(file).find("the other's"), std::string::npos);
}

TEST_F(SharedFile, AFileOfBytesIsNoText) {
  const QString noise = write("noise.wale", std::string("wale 1\n\xff\xfe\0\x01", 11));
  EXPECT_FALSE(window->open(noise));
  EXPECT_TRUE(announced().contains("UTF-8")) << announced().toStdString();
  EXPECT_EQ(contents().placed.size(), 1u);  // what was open stays
  EXPECT_EQ(window->document().file(), file);
  // A picture is placed, as if it were dropped.
  const QString picture = write("map.png", "\x89PNG\r\n");
  window->open(picture);
  EXPECT_TRUE(window->findChild<QWidget*>("question")->isVisible());
  EXPECT_EQ(read(picture), "\x89PNG\r\n");
}

TEST_F(SharedFile, OfSeveralWorkspacesOneIsChosenToMerge) {
  const QString two = write("two.wale", "wale 1\n\nworkspace a {\n  patch first = oak\n}\n\nworkspace b {\n  patch second = denim\n}\n");
  window->exchange().merge(two);
  auto* choice = window->findChild<QComboBox*>("question_0");
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->count(), 2);
  choice->setCurrentIndex(1);
  QTest::keyClick(window->findChild<QWidget*>("question"), Qt::Key_Return);
  ASSERT_EQ(contents().placed.size(), 2u);
  EXPECT_EQ(placed("second").patch.made_of, "denim");
}

TEST_F(SharedFile, TheCanvasStaysWhereItIsUnderAMessage) {
  const QPoint corner = canvas().mapTo(window.get(), QPoint(0, 0));
  const QSize size = canvas().size();
  const double scale = canvas().pixels_per_metre();
  trigger("feel");
  QTest::keyClick(&canvas(), Qt::Key_Space);
  ASSERT_TRUE(announced().contains("All force")) << announced().toStdString();
  QTest::qWait(50);
  EXPECT_EQ(canvas().mapTo(window.get(), QPoint(0, 0)), corner);
  EXPECT_EQ(canvas().size(), size);
  EXPECT_EQ(canvas().pixels_per_metre(), scale);
  trigger("feel");  // now it would be untrue
  EXPECT_FALSE(window->findChild<QLabel*>("announcement")->isVisible());
}

TEST(ALineOfTheWindow, WhatIsOfferedComesBackUntilItIsClosedOrWithdrawn) {
  QWidget window;
  Announcement line(&window);
  window.show();
  const auto button = [&](const QString& text) -> QToolButton* {
    for (QToolButton* each : line.findChildren<QToolButton*>())
      if (each->text() == text && !each->isHidden()) return each;
    return nullptr;
  };
  int taken = 0;
  line.keep_offering("Work was kept.", "Restore", [&] { ++taken; });
  line.say("Another thing.");
  EXPECT_EQ(line.text(), "Another thing.");
  EXPECT_FALSE(button("Restore"));
  button("✕")->click();
  EXPECT_EQ(line.text(), "Work was kept.");
  ASSERT_TRUE(button("Restore"));
  // Taken up without success, as when one keeps what is open instead: it is still offered.
  button("Restore")->click();
  EXPECT_EQ(taken, 1);
  EXPECT_TRUE(line.isVisible());
  line.offer("Sure?", "Yes", [&] { line.withdraw("Work was kept."); });
  button("Yes")->click();
  EXPECT_FALSE(line.isVisible());
  line.keep_offering("Work was kept.", "Restore", [&] { ++taken; });
  button("✕")->click();
  line.say("Another thing.");
  button("✕")->click();
  EXPECT_FALSE(line.isVisible());
}

TEST_F(SharedFile, TheKeyThatTakesForceAwayIsNotTyped) {
  trigger("feel");
  text().setFocus();
  text().moveCursor(QTextCursor::Start);
  QTest::keyClick(&text(), Qt::Key_Space);
  EXPECT_FALSE(window->feeling().is_on());
  EXPECT_EQ(text().toPlainText().toStdString(), one_patch);
}

}  // namespace
}  // namespace sandpaper
