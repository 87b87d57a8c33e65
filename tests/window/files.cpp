// What comes from other files into the window, and what leaves it in other formats.
#include <QDir>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFileInfo>
#include <QImage>
#include <QPrinter>
#include <QPushButton>
#include <QToolButton>
#include <cmath>
#include <wale/patch_program.hpp>
#include <set>
#include <sstream>
#include <wale/recording.hpp>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

const std::string golden = std::string(WALE_SOURCE_DIR) + "/tests/library/thesis_files/";

constexpr const char* table = R"(wale 1

import fabric.denim

/// Mine.
material ridges {
  physical {
    param size = 1 N in 0 N .. 3 N  "how hard"
    height wave = 0.5 mm * sin(2 * pi * x / 4 mm)
    force = vector(size * sin(2 * pi * x / 4 mm), 0 N)
    show relief(wave)
  }
}

workspace table {
  patch board = ridges {
    at   -40 mm, 20 mm
    size 37 mm, 18.5 mm
  }
  patch round = denim {
    at    30 mm, 20 mm
    size  40 mm, 40 mm
    shape ellipse
  }
}
)";

class Files : public DrivenWindow {
 protected:
  void open_table() {
    ASSERT_TRUE(window->open(write("table.wale", table)));
    wait_for_programs();
  }
  Exchange& exchange() { return window->exchange(); }
  QString path(const char* name) { return folder.filePath(name); }
  /// Answers the question of the window by what a person types.
  void answer(const std::vector<double>& numbers) {
    auto* question = window->findChild<Question*>("question");
    ASSERT_TRUE(question->isVisible()) << announced().toStdString();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      auto* number = question->findChild<QDoubleSpinBox*>(QString("question_%1").arg(i));
      ASSERT_TRUE(number);
      number->setValue(numbers[i]);
    }
    QTest::mouseClick(question->findChild<QPushButton*>("answer"), Qt::LeftButton);
  }
  void wait_for_work() {
    ASSERT_TRUE(wait_until([&] { return !window->findChild<LongWork*>("long_work")->is_busy(); }));
  }
  std::size_t files_in_folder() { return QDir(folder.path()).entryList(QDir::Files).size(); }
};

TEST_F(Files, AnArrayComesInWithItsFiguresAndLeavesAsTheSameBytes) {
  // An unsaved workspace has no place for the picture, and says so.
  exchange().import_files({QString::fromStdString(golden + "ramp.depth")});
  EXPECT_TRUE(announced().contains("Save the workspace first")) << announced().toStdString();
  open_table();
  exchange().import_files({QString::fromStdString(golden + "ramp.depth")});
  answer({6, 0.5});
  EXPECT_EQ(placed("ramp").patch.made_of, "ramp") << announced().toStdString();
  EXPECT_TRUE(QFile::exists(path("ramp.pgm")));
  EXPECT_NE(window->document().text().find("patch 6 mm, 5 mm"), std::string::npos);
  trigger("undo");
  EXPECT_EQ(window->document().text(), table);  // one step
  trigger("redo");
  wait_for_programs();
  ASSERT_TRUE(window->feeling().program(placed("ramp").id));
  // The same array once more has another name, as has its patch.
  exchange().import_files({QString::fromStdString(golden + "ramp.depth")});
  answer({6, 0.5});
  EXPECT_EQ(placed("ramp_2").patch.made_of, "ramp_2");
  window->document().choose({placed("ramp").id});
  exchange().export_array(path("back.depth"));
  answer({1});  // mm a cell: 6 by 5
  wait_for_work();
  const std::string back = read(path("back.depth"));
  ASSERT_EQ(back.size(), 34u) << announced().toStdString();
  EXPECT_EQ(back.substr(0, 4), std::string("\0\6\0\5", 4));
  // From 0 to 240 in the golden file; here the least is 0 and the greatest 255.
  for (int i = 0; i < 30; ++i)
    EXPECT_NEAR(static_cast<unsigned char>(back[4 + i]), (40 * (i % 6) + 10 * (i / 6)) * 255.0 / 240, 1.01) << i;
}

TEST_F(Files, MoviesAndShufflesGoBothWays) {
  open_table();
  exchange().import_files(
      {QString::fromStdString(golden + "demo.movie"), QString::fromStdString(golden + "demo.shuffle")});
  EXPECT_TRUE(announced().contains("demo_shuffle")) << announced().toStdString();
  EXPECT_NE(window->document().text().find("movie demo { frames warm_up, grids, warm_up }"), std::string::npos);
  exchange().export_movie(path("out.movie"), "demo");
  EXPECT_EQ(read(path("out.movie")), "warm_up\ngrids\nwarm_up\n");
  exchange().shuffle_movie(path("new.shuffle"), "demo_shuffle", 7);
  const auto shuffle = wale::read_thesis_shuffle(read(path("new.shuffle")), "new.shuffle");
  ASSERT_TRUE(shuffle) << wale::in_words(shuffle.error());
  EXPECT_EQ(shuffle->movie, "demo_shuffle");
  ASSERT_EQ(shuffle->frames.size(), 3u);
  const std::vector<std::string> before = {"plain_cloth", "grids", "oil"};
  for (const auto& each : shuffle->frames) EXPECT_EQ(each.name, before[each.original]);
  EXPECT_NE(window->document().text().find("seed 7"), std::string::npos);
  exchange().export_shuffle(path("not.shuffle"), "demo", "demo_shuffle");  // other frames
  EXPECT_FALSE(QFile::exists(path("not.shuffle")));
}

TEST_F(Files, MalformedFilesAreSaidAndChangeNothing) {
  open_table();
  const std::size_t before = files_in_folder();
  for (const auto& [name, bytes] :
       std::vector<std::pair<const char*, std::string>>{{"a.depth", "abc"},
                                                        {"b.shuffle", "Movie: m\n"},
                                                        {"c", std::string("\x01\x20\x03\x00\x01\xff", 6)},
                                                        {"d.movie", "\n\n"}}) {
    exchange().import_files({write(name, bytes)});
    EXPECT_TRUE(announced().contains(name)) << announced().toStdString();
    EXPECT_FALSE(window->findChild<Question*>("question")->isVisible()) << name;
  }
  exchange().merge(write("e.wale", "wale 1\nmaterial {\n"));
  EXPECT_TRUE(announced().contains("e.wale")) << announced().toStdString();
  exchange().merge(path("missing.wale"));
  EXPECT_TRUE(announced().contains("missing.wale")) << announced().toStdString();
  EXPECT_EQ(window->document().text(), table);
  EXPECT_EQ(files_in_folder(), before + 5);
}

TEST_F(Files, AnotherWorkspaceIsMergedInOneStep) {
  open_table();
  QDir(folder.path()).mkdir("other");
  QFile::copy(QString(WALE_SOURCE_DIR) + "/library/stone/slate.png", path("other/slate.png"));
  const QString other = write("other/other.wale", R"(wale 1

import fabric.denim
import fabric.corduroy

/// Theirs.
material ridges { physical { force = vector(0 N, 0 N) } }
material rock {
  physical {
    let picture = relief("slate.png", scale: 0.2 mm/px, height: 1 mm)
    height surface = picture(hand)
    force = lateral(surface, amplitude: 1 N)
  }
}

workspace theirs {
  patch board = ridges { at 0 mm, -40 mm; size 20 mm, 20 mm }
  patch cord = corduroy { at 30 mm, -40 mm; size 20 mm, 20 mm }
  patch stone = rock { at -30 mm, -40 mm; size 20 mm, 20 mm }
}

workspace empty {}

/// What they show.
movie both { frames theirs, empty }
)");
  exchange().merge(other);
  window->findChild<Question*>("question")->answer();  // the first of two
  EXPECT_TRUE(announced().startsWith("Merged theirs")) << announced().toStdString();
  EXPECT_EQ(contents().placed.size(), 5u);
  EXPECT_EQ(placed("board").patch.made_of, "ridges");
  EXPECT_EQ(placed("board_2").patch.made_of, "ridges_2");
  EXPECT_NEAR(placed("board_2").patch.at.y, -0.04, 1e-9);
  const std::string text = window->document().text();
  EXPECT_NE(text.find("import fabric.corduroy"), std::string::npos);
  EXPECT_EQ(text.find("import fabric.denim"), text.rfind("import fabric.denim"));
  EXPECT_EQ(text.find("movie both"), std::string::npos);
  EXPECT_EQ(text.find("What they show"), std::string::npos);
  wait_for_programs();
  EXPECT_TRUE(window->feeling().program(placed("stone").id)) << "its picture lies in the other folder";
  trigger("undo");
  EXPECT_EQ(window->document().text(), table);
}

TEST_F(Files, ProgramsPicturesAndPagesAreWritten) {
  open_table();
  window->document().choose({placed("board").id});
  exchange().export_program(path("board.wpp"));
  const std::string program = read(path("board.wpp"));
  EXPECT_TRUE(wale::Program::load(std::as_bytes(std::span(program)))) << announced().toStdString();
  exchange().export_picture(path("all.png"));
  EXPECT_FALSE(QImage(path("all.png")).isNull());
  exchange().export_pdf(path("all.pdf"));
  wait_for_work();
  const std::string pdf = read(path("all.pdf"));
  EXPECT_TRUE(pdf.starts_with("%PDF")) << announced().toStdString();
  EXPECT_NE(pdf.rfind("%%EOF"), std::string::npos);
  // What cannot be written is said, and nothing is left.
  const std::size_t before = files_in_folder();
  exchange().export_pdf(path("nowhere/all.pdf"));
  wait_for_work();
  EXPECT_TRUE(announced().contains("nowhere/all.pdf")) << announced().toStdString();
  exchange().export_program(path("nowhere/board.wpp"));
  EXPECT_TRUE(announced().contains("nowhere/board.wpp")) << announced().toStdString();
  exchange().record(path("nowhere/run.wrec"));
  EXPECT_TRUE(announced().contains("nowhere/run.wrec")) << announced().toStdString();
  EXPECT_EQ(files_in_folder(), before);
}

TEST_F(Files, APrinterGetsAPageOfA4OrNothing) {
  open_table();
  WorkspacePage page{.name = "table", .diameter = 0.15, .patches = {}};
  for (const PlacedRef& each : contents().placed) {
    const wale::Program* program = window->feeling().program(each->id);
    ASSERT_TRUE(program);
    page.patches.push_back({each, *each->patch.size, *program, program->default_parameters()});
  }
  const auto set_up = [&](QPrinter& printer, const char* name) {
    printer.setOutputFormat(QPrinter::PdfFormat);
    printer.setOutputFileName(path(name));
  };
  QPrinter printer;
  set_up(printer, "printed.pdf");
  EXPECT_TRUE(print_pages(printer, page, [](double) { return true; }));
  const std::string printed = read(path("printed.pdf"));
  EXPECT_TRUE(printed.starts_with("%PDF"));
  double left = -1, bottom = -1, right = 0, top = 0;  // in 1/72 inch
  const std::size_t box = printed.find("/MediaBox [");
  ASSERT_NE(box, std::string::npos);
  std::istringstream(printed.substr(box + 11)) >> left >> bottom >> right >> top;
  EXPECT_EQ(left, 0);
  EXPECT_EQ(bottom, 0);
  EXPECT_NEAR(right, 210 / 25.4 * 72, 1);
  EXPECT_NEAR(top, 297 / 25.4 * 72, 1);
  EXPECT_NE(printed.find("/Count 1"), std::string::npos);
  QPrinter cancelled;
  set_up(cancelled, "cancelled.pdf");
  int calls = 0;
  EXPECT_FALSE(print_pages(cancelled, page, [&](double) { return ++calls < 2; }));
  EXPECT_FALSE(QFile::exists(path("cancelled.pdf"))) << "half a page is printed";
}

TEST_F(Files, LongWorkIsCancelled) {
  std::string text = "wale 1\n\nworkspace many {\n";
  for (int i = 0; i < 400; ++i)
    text += "  patch p" + std::to_string(i) + " = denim { at 0 mm, 0 mm; size 60 mm, 60 mm }\n";
  ASSERT_TRUE(window->open(write("many.wale", text + "}\n")));
  wait_for_programs();
  exchange().export_pdf(path("many.pdf"));
  auto* work = window->findChild<LongWork*>("long_work");
  ASSERT_TRUE(work->isVisible());
  exchange().export_pdf(path("second.pdf"));
  EXPECT_TRUE(announced().contains("Other work")) << announced().toStdString();
  QTest::mouseClick(work->findChild<QToolButton*>("cancel_work"), Qt::LeftButton);
  wait_for_work();
  EXPECT_TRUE(announced().startsWith("Cancelled")) << announced().toStdString();
  EXPECT_FALSE(QFile::exists(path("many.pdf")));
}

TEST_F(Files, WhatIsFeltIsRecordedAndHeard) {
  open_table();
  for (const char* name : {"run.wrec", "run.wav"}) {
    exchange().record(path(name));
    trigger("feel");
    ASSERT_TRUE(window->feeling().is_on()) << announced().toStdString();
    EXPECT_GT(rub(-40, 20, 10), 0.5);
    trigger("feel");
    wait_for_work();
    ASSERT_TRUE(QFile::exists(path(name))) << announced().toStdString();
    EXPECT_FALSE(QFile::exists(path(name) + ".part"));
  }
  const auto recording = wale::Recording::open(path("run.wrec").toStdString());
  ASSERT_TRUE(recording) << wale::in_words(recording.error());
  std::set<std::string> names;
  for (const wale::RecordedProgram& each : recording->programs()) {
    const auto program = wale::Program::load(each.bytes);
    ASSERT_TRUE(program);
    names.insert(program->description().material);
  }
  EXPECT_TRUE(names.contains("ridges")) << testing::PrintToString(names);
  const auto again = wale::replay(*recording);
  ASSERT_TRUE(again) << wale::in_words(again.error());
  const std::string sound = read(path("run.wav"));
  EXPECT_TRUE(sound.starts_with("RIFF"));
  // It holds some force: not all samples are 0.
  EXPECT_NE(sound.find_first_not_of('\0', 64), std::string::npos);
  trigger("feel");  // and goes on without a recording
  EXPECT_TRUE(window->feeling().is_on());
}

TEST_F(Files, APictureDroppedTwiceIsDeclaredUnderTwoNames) {
  QFile::copy(QString(WALE_SOURCE_DIR) + "/library/stone/slate.png", path("slate.png"));
  open_table();
  for (int i = 0; i < 2; ++i) {
    emit canvas().others_dropped({path("slate.png")}, {0.0, -0.03 * i});
    answer({0.2});
  }
  const std::string text = window->document().text();
  EXPECT_NE(text.find("material slate {"), std::string::npos) << text;
  EXPECT_NE(text.find("material slate_2 {"), std::string::npos) << text;
  EXPECT_FALSE(language().check(text, {.name = path("table.wale").toStdString()}).has_errors());
}

TEST_F(Files, SeveralFilesAreDroppedAtOnce) {
  for (const char* name : {"slate.png", "marble.png"})
    QFile::copy(QString(WALE_SOURCE_DIR) + "/library/stone/slate.png", path(name));
  open_table();
  const auto drop_files = [&](const QStringList& names) {
    QMimeData mime;
    QList<QUrl> urls;
    for (const QString& each : names) urls << QUrl::fromLocalFile(each);
    mime.setUrls(urls);
    QDragEnterEvent enter(pixels(0, 0), Qt::CopyAction, &mime, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &enter);
    QDropEvent event(QPointF(pixels(0, 0)), Qt::CopyAction, &mime, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &event);
  };
  drop_files({path("slate.png"), path("marble.png")});
  answer({0.2});
  EXPECT_EQ(placed("slate_patch").patch.made_of, "slate");
  EXPECT_EQ(placed("marble_patch").patch.made_of, "marble");
  EXPECT_EQ(window->document().chosen().size(), 2u);
  trigger("undo");
  EXPECT_EQ(window->document().text(), table);  // one step
  // A file of the thesis is no picture.
  drop_files({QString::fromStdString(golden + "demo.movie")});
  EXPECT_NE(window->document().text().find("movie demo"), std::string::npos) << announced().toStdString();
}

TEST_F(Files, TheMiddleIsWrittenWhereItWasWritten) {
  const std::string text = "wale 1\n\nworkspace table {\n  patch a = oak { at 0 mm, 0 mm }\n"
                           "  patch b = oak { size 20 mm, 20 mm }\n}\n";
  ASSERT_TRUE(window->open(write("middle.wale", text)));
  EXPECT_EQ(window->document().text(), text);
}

TEST_F(Files, ADocumentOfAWordProcessorIsNamedAsSuch) {
  window->open(write("rich.wale", "{\\rtf1\\ansi {\\fonttbl {\\f0 Times;}}\nwale 1\\par\n}"));
  ASSERT_FALSE(window->document().problems().empty());
  const wale::Error& first = window->document().problems().front().error;
  EXPECT_NE(first.sentence.find("word processor"), std::string::npos) << first.sentence;
  EXPECT_NE(first.mend.find("plain text"), std::string::npos) << first.mend;
}

TEST_F(Files, SavingKeepsWhatIsWrittenByHand) {
  const std::string by_hand =
      "wale 1 \n// mine\nworkspace w {\n  patch p = oak { size 40 mm, 40 mm; at -50 mm, 0 mm } // why\n"
      "  patch q = denim { at 50.00 mm, 0 mm\n     size 5 cm, 4 cm // in cm\n     rim 2 mm }\n}\n";
  ASSERT_TRUE(window->open(write("hand.wale", by_hand)));
  EXPECT_EQ(window->document().text(), by_hand);
  window->document().change_placed("Move", {placed("p").id}, [](Placed& each) { each.patch.at.x = -0.02; });
  ASSERT_TRUE(window->document().save(path("hand.wale")));
  std::string moved = by_hand;
  moved.replace(moved.find("-50 mm"), 6, "-20 mm");
  EXPECT_EQ(read(path("hand.wale")), moved);
}

}  // namespace
}  // namespace sandpaper
