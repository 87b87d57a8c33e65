// A session as a designer has one, through the real window.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QAccessible>
#include <QDir>
#include <QDockWidget>
#include <QSlider>
#include <QSpinBox>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

constexpr const char* kitchen = R"(wale 1

/// Mine.
material ridges {
  physical {
    param size = 1 N in 0 N .. 3 N  "how hard"
    force = vector(size * sin(2 * pi * x / 4 mm), 0 N)
  }
}

/// What lies on the table.
workspace kitchen {
  // the large one
  patch board = ridges {
    at   -40 mm, 20 mm
    size 50 mm, 40 mm
  }
  patch cloth = denim(roughness: 0.3) {
    at    40 mm, 20 mm
    size  50 mm, 40 mm
    shape ellipse
    mark  roughness, low 0.2, high 0.45, "still denim"
  }
}
)";

TEST_F(DrivenWindow, AFileIsLaidOutAndSavedAsItWas) {
  const QString file = write("kitchen.wale", kitchen);
  ASSERT_TRUE(window->open(file));
  ASSERT_EQ(contents().placed.size(), 2u);
  EXPECT_EQ(placed("board").patch.made_of, "ridges");
  EXPECT_NEAR(placed("cloth").patch.at.x, 0.04, 1e-9);
  EXPECT_EQ(placed("cloth").patch.shape, "ellipse");
  ASSERT_EQ(placed("cloth").patch.marks.size(), 1u);
  EXPECT_FALSE(window->feeling().is_on());  // it opens unfelt
  EXPECT_EQ(window->document().text(), kitchen);
  trigger("save");
  EXPECT_EQ(read(file), kitchen);
}

TEST_F(DrivenWindow, AMaterialIsDraggedInMovedAndUndone) {
  drop("denim", 10, -20);
  ASSERT_EQ(contents().placed.size(), 1u);
  EXPECT_NEAR(placed("denim").patch.at.x, 0.010, 1e-9);
  EXPECT_NEAR(placed("denim").patch.at.y, -0.020, 1e-9);
  wait_for_programs();
  EXPECT_TRUE(window->feeling().program(placed("denim").id));
  drag(pixels(10, -20), pixels(30, 5));
  EXPECT_NEAR(placed("denim").patch.at.x, 0.030, 0.0006);  // it snaps to millimetres
  EXPECT_NEAR(placed("denim").patch.at.y, 0.005, 0.0006);
  QTest::keyClick(&canvas(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_NEAR(placed("denim").patch.at.x, 0.020, 0.0006);
  trigger("undo");
  trigger("undo");
  EXPECT_NEAR(placed("denim").patch.at.x, 0.010, 1e-9);
  trigger("undo");
  EXPECT_TRUE(contents().placed.empty());
  for (int i = 0; i < 3; ++i) trigger("redo");
  EXPECT_NEAR(placed("denim").patch.at.x, 0.020, 0.0006);
}

TEST_F(DrivenWindow, ASliderChangesTheForceAtTheHandle) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  wait_for_programs();
  trigger("feel");
  ASSERT_TRUE(window->feeling().is_on()) << announced().toStdString();
  // On a busy machine the hand jumps, and the passivity observer may add its damping to one look.
  const auto pushes = [&](double newton) {
    return wait_until([&] { return std::abs(rub(-40, 20, 15) - newton) < 0.1 * newton; });
  };
  EXPECT_TRUE(pushes(1.0));  // of the sine's 1 N
  ASSERT_TRUE(wait_until([&] { return canvas().touched() == placed("board").id; }));
  // The touched patch's sliders are shown after a quarter of a second.
  ASSERT_TRUE(wait_until([&] { return window->findChild<QDoubleSpinBox*>("number_size"); }));
  window->findChild<QDoubleSpinBox*>("number_size")->setValue(2.5);
  QTest::qWait(100);
  EXPECT_TRUE(pushes(2.5));
  EXPECT_EQ(placed("board").patch.made_of, "ridges(size: 2.5 N)");
  window->findChild<QSlider*>("slider_size")->setValue(0);
  QTest::qWait(100);
  EXPECT_TRUE(wait_until([&] { return rub(-40, 20, 15, 1) < 0.2; }));
  trigger("undo");
  EXPECT_EQ(placed("board").patch.made_of, "ridges");  // the moves of one slider are one step
  QTest::qWait(100);
  EXPECT_TRUE(pushes(1.0));
}

TEST_F(DrivenWindow, TheSpaceBarTakesAllForceAway) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  wait_for_programs();
  trigger("feel");
  EXPECT_GT(rub(-40, 20, 15), 0.5);
  QTest::keyClick(&canvas(), Qt::Key_Space);
  EXPECT_FALSE(window->feeling().is_on());
  trigger("feel");
  text().setFocus();
  QTest::keyClick(&text(), Qt::Key_Space);  // nobody was typing
  EXPECT_FALSE(window->feeling().is_on());
  trigger("feel");
  QTest::keyClick(&text(), Qt::Key_A);
  QTest::keyClick(&text(), Qt::Key_Space);  // within a word's time: it belongs to the text
  EXPECT_TRUE(window->feeling().is_on());
  QTest::keyClick(&text(), Qt::Key_Escape);
  EXPECT_FALSE(window->feeling().is_on());
}

TEST_F(DrivenWindow, ATextWithAnErrorIsStaleUntilItIsMended) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  wait_for_programs();
  const auto* before = &window->feeling().program(placed("board").id)->decoded();
  const QString whole = QString::fromUtf8(kitchen);
  text().setPlainText(QString(whole).replace("size * sin", "sizz * sin"));
  ASSERT_TRUE(wait_until([&] { return window->document().is_stale(); }));
  ASSERT_FALSE(text().problems().empty());
  EXPECT_EQ(whole.mid(static_cast<int>(text().problems().front().begin), 0).size(), 0);
  EXPECT_EQ(&window->feeling().program(placed("board").id)->decoded(), before);  // the last good version stays felt
  // What is laid out cannot change meanwhile, and the window says why.
  window->document().choose({placed("board").id});
  QTest::keyClick(&canvas(), Qt::Key_Right);
  EXPECT_NEAR(placed("board").patch.at.x, -0.04, 1e-9);
  EXPECT_TRUE(announced().contains("errors")) << announced().toStdString();
  // One key mends it.
  QTest::keyClick(&text(), Qt::Key_Period, Qt::ControlModifier);
  ASSERT_TRUE(wait_until([&] { return !window->document().is_stale(); }));
  EXPECT_EQ(text().toPlainText().toStdString(), kitchen);
}

TEST_F(DrivenWindow, WhatIsTypedIsFelt) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  wait_for_programs();
  trigger("feel");
  EXPECT_NEAR(rub(-40, 20, 15), 1.0, 0.1);
  text().setPlainText(QString::fromUtf8(kitchen).replace("param size = 1 N", "param size = 2 N"));
  ASSERT_TRUE(wait_until([&] {
    const wale::Program* program = window->feeling().program(placed("board").id);
    return program && program->description().parameters.front().value == 2;
  }));
  EXPECT_TRUE(window->feeling().is_on());
  // On a busy machine the hand jumps, and the passivity observer may add its damping to one look.
  EXPECT_TRUE(wait_until([&] { return std::abs(rub(-40, 20, 15) - 2.0) < 0.2; }));
}

TEST_F(DrivenWindow, ABrokenFileOpensWithItsTextAndLosesNothing) {
  const std::string broken = std::string(kitchen) + "\nmaterial broken { physical { force = } }\n";
  const QString file = write("broken.wale", broken);
  ASSERT_TRUE(window->open(file));
  EXPECT_TRUE(window->document().is_stale());
  EXPECT_EQ(text().toPlainText().toStdString(), broken);
  EXPECT_EQ(contents().placed.size(), 2u);
  trigger("save");
  EXPECT_EQ(read(file), broken);
}

TEST_F(DrivenWindow, MarksOfASliderAreSaved) {
  const QString file = write("kitchen.wale", kitchen);
  ASSERT_TRUE(window->open(file));
  wait_for_programs();
  window->document().choose({placed("board").id});
  ASSERT_TRUE(wait_until([&] { return window->findChild<QDoubleSpinBox*>("number_size"); }));
  auto* row = window->findChild<SliderRow*>();
  ASSERT_TRUE(row);
  emit row->mark_wanted(false);
  window->findChild<QDoubleSpinBox*>("number_size")->setValue(1.5);
  emit row->mark_wanted(true);
  // What it still felt like is written below the slider, by whom it felt so.
  auto* says = window->findChild<QLineEdit*>("says_size");
  ASSERT_TRUE(says && says->isVisible());
  QTest::keyClicks(says, "fine \"comb\"");
  QTest::keyClick(says, Qt::Key_Return);
  trigger("save");
  EXPECT_NE(read(file).find("mark size, low 1 N, high 1.5 N, \"fine \\\"comb\\\"\""), std::string::npos) << read(file);
  begin();
  ASSERT_TRUE(window->open(file));
  wait_for_programs();
  ASSERT_EQ(placed("board").patch.marks.size(), 1u);
  EXPECT_NEAR(*placed("board").patch.marks.front().mark.high, 1.5, 1e-6);
  window->document().choose({placed("board").id});
  ASSERT_TRUE(wait_until([&] { return window->findChild<QLineEdit*>("says_size"); }));
  EXPECT_EQ(window->findChild<QLineEdit*>("says_size")->text(), "fine \"comb\"");
  emit window->findChild<SliderRow*>()->unmark_wanted();
  EXPECT_FALSE(window->findChild<QLineEdit*>("says_size")->isVisible());
}

TEST_F(DrivenWindow, SlidersAreInTheOrderPerceptsParametersWeights) {
  ASSERT_TRUE(window->open(
      write("blend.wale", "wale 1\n\nworkspace w { patch p = 0.7 corduroy + 0.3 denim { at 0 mm, 0 mm } }\n")));
  wait_for_programs();
  window->document().choose({placed("p").id});
  ASSERT_TRUE(wait_until([&] { return !window->findChildren<SliderRow*>().isEmpty(); }));
  int rank = 0;
  std::set<int> seen;
  for (const SliderRow* row : window->findChildren<SliderRow*>()) {
    const int own = row->is_percept() ? 0 : row->name() == "corduroy_weight" || row->name() == "denim_weight" ? 2 : 1;
    EXPECT_GE(own, rank) << row->name();
    seen.insert(rank = own);
  }
  EXPECT_TRUE(seen.contains(1) && seen.contains(2)) << testing::PrintToString(seen);
}

TEST_F(DrivenWindow, ThePreviewOfTheShownPatchHasItsSpectrum) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  wait_for_programs();
  auto* preview = window->findChild<PreviewPanel*>();
  window->document().choose({placed("board").id});
  QTest::qWait(400);
  EXPECT_TRUE(preview->pictures().empty());  // nobody sees it, and nobody draws it
  window->findChild<QDockWidget*>("dock_preview")->raise();
  ASSERT_TRUE(wait_until([&] { return !preview->pictures().empty(); }));
  std::set<QString> names;
  for (const PreviewPicture& each : preview->pictures()) {
    EXPECT_FALSE(each.image.isNull()) << each.name.toStdString();
    names.insert(each.name);
  }
  EXPECT_TRUE(names.contains("spectrum") && names.contains("force"));
  const QImage first = preview->pictures().back().image;
  window->findChild<QDoubleSpinBox*>("number_size")->setValue(2.5);  // it follows the sliders
  ASSERT_TRUE(wait_until([&] { return preview->pictures().back().image != first; }));
  const QImage second = preview->pictures().back().image;
  window->document().choose({placed("cloth").id});
  ASSERT_TRUE(wait_until([&] { return preview->pictures().back().image != second; }));
}

TEST_F(DrivenWindow, NumbersHideMaterialsFromAParticipantWhoListens) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  const auto told = [](Canvas& canvas) {
    QString all;
    QAccessibleInterface* list = QAccessible::queryAccessibleInterface(&canvas);
    for (int i = 0; i < list->childCount(); ++i)
      for (const auto kind : {QAccessible::Name, QAccessible::Value, QAccessible::Description})
        all += list->child(i)->text(kind) + "\n";
    return all;
  };
  EXPECT_TRUE(told(canvas()).contains("denim"));
  trigger("random_numbers");
  trigger("participant");
  auto* participant = window->findChild<Canvas*>("participant_canvas");
  ASSERT_TRUE(participant);
  for (const char* each : {"denim", "ridges", "board", "cloth"})
    EXPECT_FALSE(told(*participant).contains(each)) << told(*participant).toStdString();
  QAccessibleInterface* list = QAccessible::queryAccessibleInterface(participant);
  ASSERT_EQ(list->childCount(), 2);
  EXPECT_TRUE(list->child(0)->actionInterface()->actionNames().isEmpty());  // nobody moves or deletes there
}

TEST_F(DrivenWindow, CommentsAndUnknownStatementsAreKept) {
  const std::string odd = R"(wale 1

/* in front */
workspace odd {
  // of a
  patch a = oak // behind a
  /// told of b
  patch b = oak {
    // inside b
    at 10 mm, 0 mm
  }
  patches from picture("map.png", scale: 0.3 mm/px) { colour "#c04020" = brick }
  // at the end
}

// after all
)";
  const auto checked = language().check(odd);
  ASSERT_EQ(checked.layouts.size(), 1u);
  const wale::Layout& layout = checked.layouts.front();
  const std::string text = wale::layout_text(layout);
  for (const char* each :
       {"// of a", "// behind a", "/// told of b", "// inside b", "patches from picture", "// at the end"})
    EXPECT_NE(text.find(each), std::string::npos) << each << "\n" << text;
  const std::string again = odd.substr(0, layout.begin) + text + odd.substr(layout.end);
  const auto twice = language().check(again);
  ASSERT_EQ(twice.layouts.size(), 1u);
  EXPECT_EQ(wale::layout_text(twice.layouts.front()), text);
}

TEST_F(DrivenWindow, AKilledProcessLosesNothing) {
  const QString file = write("kitchen.wale", kitchen);
  ASSERT_TRUE(window->open(file));
  window->document().choose({placed("board").id});
  QTest::keyClick(&canvas(), Qt::Key_Right);
  QTest::qWait(1500);
  // Its autosave, under the number of a process that is no more.
  const QDir kept(qEnvironmentVariable("XDG_DATA_HOME") + "/wale/sandpaper");
  ASSERT_EQ(kept.entryList({"*.json"}, QDir::Files).size(), 1);
  QFile::copy(kept.filePath(kept.entryList({"*.json"}, QDir::Files).front()), kept.filePath("999999999.json"));
  begin();
  EXPECT_TRUE(announced().contains("kept")) << announced().toStdString();
  for (auto* button : window->findChildren<QToolButton*>())
    if (button->text() == "Restore it") button->click();
  EXPECT_NEAR(placed("board").patch.at.x, -0.039, 1e-9);
  EXPECT_EQ(window->document().file(), QFileInfo(file).absoluteFilePath());
  EXPECT_TRUE(window->isWindowModified());
  EXPECT_FALSE(kept.exists("999999999.json"));
}

TEST_F(DrivenWindow, AProcessThatIsDeadAndStillListedHasLeftItsWork) {
  const QDir kept(qEnvironmentVariable("XDG_DATA_HOME") + "/wale/sandpaper");
  const pid_t child = fork();
  if (child == 0) _exit(0);
  siginfo_t ended;
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);  // nobody has asked for its status
  ASSERT_EQ(kill(child, 0), 0);
  const QString name = kept.filePath(QString::number(child));
  std::ofstream((name + ".lock").toStdString());
  std::ofstream((name + "-1.json").toStdString()) << R"({"file": "", "text": "wale 1\n\nworkspace left {}\n"})";
  begin();
  EXPECT_TRUE(announced().contains("kept")) << announced().toStdString();
  QFile::remove(name + "-1.json");
  QFile::remove(name + ".lock");
  waitpid(child, nullptr, 0);
}

TEST_F(DrivenWindow, WhatIsTypedWithoutAPauseIsKeptToo) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  const QDir kept(qEnvironmentVariable("XDG_DATA_HOME") + "/wale/sandpaper");
  text().moveCursor(QTextCursor::End);
  // One key after the other, without the pause after which the text is checked.
  for (int i = 0; i < 100 && kept.entryList({"*.json"}, QDir::Files).isEmpty(); ++i) {
    QTest::keyClick(&text(), Qt::Key_X);
    QTest::qWait(100);
  }
  ASSERT_EQ(kept.entryList({"*.json"}, QDir::Files).size(), 1);
  EXPECT_NE(read(kept.filePath(kept.entryList({"*.json"}, QDir::Files).front())).find("xxx"), std::string::npos);
}

TEST_F(DrivenWindow, TwoWindowsOfOneProcessKeepTheirOwnWork) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  MainWindow other(library(), language());
  other.show();
  ASSERT_TRUE(other.open(write("other.wale", "wale 1\n\nworkspace w { patch p = oak { at 0 mm, 0 mm } }\n")));
  for (MainWindow* each : {window.get(), &other})
    each->document().change_placed("Move", {each->document().contents().placed.front()->id},
                                   [](Placed& placed) { placed.patch.at.y = 0.01; });
  const QDir kept(qEnvironmentVariable("XDG_DATA_HOME") + "/wale/sandpaper");
  ASSERT_TRUE(wait_until([&] { return kept.entryList({"*.json"}, QDir::Files).size() == 2; }, 3000));
  ASSERT_TRUE(window->document().save(window->document().file()));
  EXPECT_EQ(kept.entryList({"*.json"}, QDir::Files).size(), 1);
}

TEST_F(DrivenWindow, ThumbnailsAreKeptFromOneRunToTheNext) {
  const QDir kept(qEnvironmentVariable("XDG_CACHE_HOME") + "/wale/sandpaper");
  for (const QString& each : kept.entryList(QDir::Files)) QFile::remove(kept.filePath(each));
  begin();
  auto* palette = window->findChild<QListView*>("palette");
  const auto search = [&] { window->findChild<QLineEdit*>("search")->setText("corduroy"); };
  search();
  const auto look_at_all = [&] {
    for (int row = 0; row < palette->model()->rowCount(); ++row)
      palette->model()->index(row, 0).data(Qt::DecorationRole);
  };
  const int all = palette->model()->rowCount();
  ASSERT_GT(all, 0);
  EXPECT_TRUE(wait_until(
      [&] {
        look_at_all();
        return kept.entryList({"*.png"}, QDir::Files).size() >= all;
      },
      60000));
  const QImage first = palette->model()->index(0, 0).data(Qt::DecorationRole).value<QImage>();
  begin();  // another window has it at once
  palette = window->findChild<QListView*>("palette");
  search();
  EXPECT_EQ(palette->model()->index(0, 0).data(Qt::DecorationRole).value<QImage>(), first);
}

TEST_F(DrivenWindow, PatchesAreArranged) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  trigger("choose_all");
  trigger("align_bottom");
  EXPECT_NEAR(placed("board").patch.at.y, placed("cloth").patch.at.y, 1e-9);
  trigger("align_left");
  EXPECT_NEAR(placed("board").patch.at.x, placed("cloth").patch.at.x, 1e-9);
  EXPECT_EQ(canvas().patch_at(placed("board").patch.at)->patch.name, "cloth");
  window->document().choose({placed("board").id});
  trigger("front");
  EXPECT_EQ(canvas().patch_at(placed("board").patch.at)->patch.name, "board");
  trigger("duplicate");
  EXPECT_EQ(contents().placed.size(), 3u);
  EXPECT_EQ(contents().placed.back()->patch.name, "board_2");
  for (int i = 0; i < 30; ++i) QTest::keyClick(&canvas(), Qt::Key_Right, Qt::ShiftModifier);
  trigger("fit");
  const glm::dvec2 far = placed("board_2").patch.at + 0.5 * canvas().size_of(placed("board_2"));
  EXPECT_LE(std::hypot(far.x, far.y), window->feeling().profile().workspace_diameter / 2 + 1e-9);
  EXPECT_NEAR(canvas().size_of(placed("board_2")).x, 0.05, 1e-9);  // never scaled
  trigger("lock");
  const glm::dvec2 at = placed("board_2").patch.at;
  QTest::keyClick(&canvas(), Qt::Key_Left);
  EXPECT_EQ(placed("board_2").patch.at, at);
}

TEST_F(DrivenWindow, AMovieStepsThroughTheWorkspacesOfAFile) {
  const std::string two = std::string(kitchen) + R"(
workspace workshop { patch mat = corduroy { at 5 mm, 0 mm } }

movie demo { frames workshop, kitchen }
)";
  const QString file = write("two.wale", two);
  ASSERT_TRUE(window->open(file));
  ASSERT_EQ(contents().name, "kitchen");
  trigger("next_frame");
  EXPECT_EQ(contents().name, "workshop") << announced().toStdString();
  ASSERT_EQ(contents().placed.size(), 1u);
  window->document().choose({placed("mat").id});
  QTest::keyClick(&canvas(), Qt::Key_Right);
  trigger("next_frame");
  EXPECT_EQ(contents().name, "kitchen");
  trigger("save");
  EXPECT_NE(read(file).find("at 6 mm, 0 mm"), std::string::npos) << read(file);
  EXPECT_NE(read(file).find("patch board = ridges {"), std::string::npos);
}

TEST_F(DrivenWindow, AWorkspaceThatAMovieKeysAndGroupsNameIsFelt) {
  const std::string named = std::string(kitchen) + R"(
movie demo { frames kitchen }
keys sorting { of kitchen; area 40 mm, 40 mm }
groups sorted { of kitchen; group board, "hard"; group cloth }
)";
  ASSERT_TRUE(window->open(write("named.wale", named)));
  wait_for_programs();
  ASSERT_TRUE(window->feeling().program(placed("board").id));
  trigger("feel");
  EXPECT_NEAR(rub(-40, 20, 15), 1.0, 0.1);
}

TEST_F(DrivenWindow, NeighboursThatFeelAlikeAreToldAndMended) {
  ASSERT_TRUE(window->open(write("alike.wale", R"(wale 1

workspace alike {
  patch one   = corduroy(roughness: 0.50) { at -20 mm, 0 mm; size 40 mm, 40 mm }
  patch other = corduroy(roughness: 0.51) { at 20 mm, 0 mm; size 40 mm, 40 mm }
}
)")));
  const auto told = [&] {
    for (const wale::Problem& each : text().problems())
      if (wale::code_name(each.error.code) == "W0428") return true;
    return false;
  };
  ASSERT_TRUE(wait_until(told));
  text().setPlainText(text().toPlainText().replace("0.51", "0.90"));
  ASSERT_TRUE(wait_until([&] { return contents().placed.back()->patch.made_of == "corduroy(roughness: 0.90)"; }));
  ASSERT_TRUE(wait_until([&] { return !window->is_busy() && !told(); }));
}

TEST_F(DrivenWindow, AShuffleIsOneStepOfUndo) {
  ASSERT_TRUE(window->open(write("kitchen.wale", kitchen)));
  const glm::dvec2 board = placed("board").patch.at, cloth = placed("cloth").patch.at;
  trigger("shuffle");
  EXPECT_NE(placed("board").patch.at, board);
  EXPECT_NE(placed("cloth").patch.at, cloth);
  trigger("undo");
  EXPECT_EQ(window->document().text(), kitchen);
}

TEST_F(DrivenWindow, ItsPageAndItsWorkspaceAreRight) {
  const QString folder_of_window = QStringLiteral(WALE_SOURCE_DIR "/examples/sandpaper/");
  const QString page = QString::fromStdString(read(folder_of_window + "README.md"));
  // The one program that the page shows; it is indented there.
  const QString block = page.section("```wale\n", 1, 1).section("```", 0, 0).replace("\n   ", "\n").trimmed();
  EXPECT_TRUE(language().compile(block.toStdString()).program) << block.toStdString();
  for (const wale::Problem& each : language().check(read(folder_of_window + "kitchen.wale")).problems)
    ADD_FAILURE() << wale::in_words(each.error);
  ASSERT_TRUE(window->open(folder_of_window + "kitchen.wale"));
  EXPECT_EQ(window->document().text(), read(folder_of_window + "kitchen.wale"));
}

TEST_F(DrivenWindow, ASliderOfABlendGivesItANameInTheFile) {
  const QString file = write("blend.wale", R"(wale 1

workspace w {
  patch mixed = 0.5 oak + 0.5 denim { at 0 mm, 0 mm }
}
)");
  ASSERT_TRUE(window->open(file));
  wait_for_programs();
  window->document().choose({placed("mixed").id});
  ASSERT_TRUE(wait_until([&] { return !window->findChildren<SliderRow*>().empty(); }));
  SliderRow* row = window->findChildren<SliderRow*>().front();
  const float wanted = 0.5f * (row->parameter().soft_low + row->parameter().soft_high) +
                       0.1f * (row->parameter().soft_high - row->parameter().soft_low);
  emit row->moved(wanted, true);
  trigger("save");
  const std::string text = read(file);
  EXPECT_NE(text.find("material mixed_material = 0.5 oak + 0.5 denim"), std::string::npos) << text;
  EXPECT_NE(text.find("patch mixed = mixed_material("), std::string::npos) << text;
  EXPECT_FALSE(language().check(text).has_errors()) << text;
}

TEST_F(DrivenWindow, ControlSpaceInATextProposesAndDoesNotPush) {
  text().setFocus();
  QTest::keyClick(&text(), Qt::Key_Space, Qt::ControlModifier);
  EXPECT_FALSE(window->feeling().is_on());
  QTest::keyClick(&canvas(), Qt::Key_Space, Qt::ControlModifier);
  EXPECT_TRUE(window->feeling().is_on());
}

}  // namespace
}  // namespace sandpaper
