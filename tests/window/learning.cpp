// The pages of examples/learn in the window, and the recipes that are placed from them.
#include <QDockWidget>
#include <QImage>
#include <QTextBlock>
#include <QTextCursor>

#include "document/recipe.hpp"
#include "driven_window.hpp"
#include "panels/pages_panel.hpp"

namespace sandpaper {
namespace {

class Learning : public DrivenWindow {
 protected:
  PageBrowser& page() { return *window->findChild<PageBrowser*>("page"); }
  /// The recipe of the open page whose text has these words.
  QString recipe(const std::string& words) {
    for (const std::string& each : page().recipes())
      if (each.find(words) != std::string::npos) return QString::fromStdString(each);
    ADD_FAILURE() << "no recipe has " << words;
    return {};
  }
  void drop_recipe(const QString& text, double x_mm, double y_mm) {
    QMimeData mime;
    mime.setData("application/x-wale-recipe", text.toUtf8());
    QDragEnterEvent enter(pixels(x_mm, y_mm), Qt::CopyAction, &mime, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent event(QPointF(pixels(x_mm, y_mm)), Qt::CopyAction, &mime, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &event);
  }
};

TEST_F(Learning, ARecipeIsDroppedAndFelt) {
  trigger("recipes");
  ASSERT_TRUE(window->findChild<QDockWidget*>("dock_pages")->isVisible());
  const std::string before = window->document().text();
  drop_recipe(recipe("material notch"), 20, 10);
  ASSERT_EQ(contents().placed.size(), 1u) << announced().toStdString();
  EXPECT_EQ(placed("notch").patch.made_of, "notch");
  EXPECT_NEAR(placed("notch").patch.at.x, 0.020, 0.0006);
  wait_for_programs();
  trigger("feel");
  EXPECT_NEAR(rub(20, 10, 12), 1.5, 0.6);  // the hollow's 1.5 N, with a little drag
  trigger("undo");                          // one step
  EXPECT_EQ(window->document().text(), before);
}

TEST_F(Learning, ATakenNameBecomesANewOneAndAnImportIsThereOnce) {
  trigger("recipes");
  for (const double x : {-30.0, 30.0}) drop_recipe(recipe("material notch"), x, 0);
  drop_recipe(recipe("material key"), 0, 50);
  ASSERT_EQ(contents().placed.size(), 6u) << announced().toStdString();
  EXPECT_EQ(placed("notch_2").patch.made_of, "notch_2");
  EXPECT_EQ(placed("four").patch.made_of, "key(depth: 2.4 N)");
  EXPECT_NEAR(placed("four").patch.at.y, 0.035, 0.0006);
  const QString text = QString::fromStdString(window->document().text());
  EXPECT_EQ(text.count("import std.detent"), 1) << text.toStdString();
  EXPECT_EQ(text.count("wale 1"), 1);
  wait_for_programs();
  EXPECT_TRUE(window->feeling().program(placed("four").id));
}

TEST_F(Learning, EveryRecipeOfEveryPageCanBePlaced) {
  for (const char* name : {"learn", "recipes", "forces"}) {
    trigger(name);
    const auto recipes = page().recipes();
    EXPECT_GE(recipes.size(), 3u) << name;
    for (const std::string& each : recipes) {
      const std::size_t patches = contents().placed.size();
      drop_recipe(QString::fromStdString(each), 0, 0);
      EXPECT_GT(contents().placed.size(), patches) << announced().toStdString() << "\n" << each;
    }
  }
  EXPECT_FALSE(window->document().is_stale());
}

TEST_F(Learning, TheMapOfARecipeIsLaidOutWhereItIsDropped) {
  trigger("recipes");
  drop_recipe(recipe("patches from picture"), 5, -10);
  EXPECT_NE(window->document().text().find("at     5 mm, -10 mm"), std::string::npos) << window->document().text();
  int areas = 0;
  for (const PlacedRef& each : contents().placed) areas += each->patch.is_of_picture;
  EXPECT_EQ(areas, 3);
}

TEST_F(Learning, ALinkPlacesByTheKeyboardAndOthersLeadToPages) {
  trigger("learn");
  page().setFocus();
  const auto place_link = [&] {
    for (QTextBlock block = page().document()->begin(); block.isValid(); block = block.next())
      if (block.text().startsWith("Place it")) return block;
    return QTextBlock();
  }();
  ASSERT_TRUE(place_link.isValid());
  QTextCursor cursor(place_link);
  cursor.movePosition(QTextCursor::EndOfBlock, QTextCursor::KeepAnchor);
  page().setTextCursor(cursor);
  QTest::keyClick(&page(), Qt::Key_Return);
  EXPECT_EQ(placed("washboard").patch.made_of, "washboard") << announced().toStdString();
  emit page().anchorClicked(QUrl("FORCES.md#sticky"));
  EXPECT_TRUE(page().source().path().endsWith("examples/learn/FORCES.md"));
  EXPECT_EQ(page().textCursor().block().text(), "sticky");
  emit page().anchorClicked(QUrl("../../schema/LANGUAGE.md#what-pushes"));
  EXPECT_EQ(page().textCursor().block().text(), "What pushes");
  emit page().anchorClicked(QUrl("nowhere.md"));
  EXPECT_TRUE(announced().contains("nowhere.md is not installed"));
}

TEST_F(Learning, WhatCannotBePlacedChangesNothing) {
  const std::string before = window->document().text();
  drop_recipe("wale 1\n\nmaterial broken { physical { force = nothing } }\n", 0, 0);
  EXPECT_EQ(window->document().text(), before);
  EXPECT_TRUE(announced().contains("cannot be placed")) << announced().toStdString();
  EXPECT_FALSE(window->document().is_stale());
  drop_recipe("", 0, 0);
  EXPECT_EQ(window->document().text(), before);
}

}  // namespace
}  // namespace sandpaper
