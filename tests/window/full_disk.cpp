// A disk that takes nothing: what is said names the file, what was there stays, and no work is lost.
#include <sys/resource.h>

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <csignal>
#include <wale/recording.hpp>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

constexpr const char* on_disk = R"(wale 1

material ridges {
  physical {
    param size = 1 N in 0 N .. 3 N  "how hard"
    height wave = 0.5 mm * sin(2 * pi * x / 4 mm)
    force = vector(size * sin(2 * pi * x / 4 mm), 0 N)
    show relief(wave)
  }
}

workspace table { patch board = ridges { at -40 mm, 20 mm; size 40 mm, 20 mm } }
workspace second { patch board = ridges { at 0 mm, 0 mm; size 40 mm, 20 mm } }

movie demo { frames table, second }
)";

/// While it lives, no file of this process can grow.
class FullDisk {
 public:
  FullDisk() : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class OnAFullDisk : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    ASSERT_TRUE(window->open(write("table.wale", on_disk)));
    wait_for_programs();
    window->document().choose({placed("board").id});
  }
  QString path(const QString& name) { return folder.filePath(name); }
  void wait_for_work() {
    ASSERT_TRUE(wait_until([&] { return !window->findChild<LongWork*>("long_work")->is_busy(); }));
  }
  QStringList files() { return QDir(folder.path()).entryList(QDir::Files | QDir::Hidden); }
  void rub_recorded(const QString& file) {
    window->exchange().record(file);
    trigger("feel");
    ASSERT_TRUE(window->feeling().is_on()) << announced().toStdString();
    EXPECT_GT(rub(-40, 20, 10, 1), 0.5);
  }
};

TEST_F(OnAFullDisk, ExportsLeaveTheOldFileAndSayWhichTheyCouldNotWrite) {
  const std::string before = window->document().text();
  Exchange& exchange = window->exchange();
  const std::vector<std::pair<QString, std::function<void(const QString&)>>> exports = {
      {"a.png", [&](const QString& file) { exchange.export_picture(file); }},
      {"b.png", [&](const QString& file) { exchange.export_preview(file); }},
      {"c.pdf", [&](const QString& file) { exchange.export_pdf(file); }},
      {"d.wpp", [&](const QString& file) { exchange.export_program(file); }},
      {"e.movie", [&](const QString& file) { exchange.export_movie(file, "demo"); }},
      {"f.shuffle", [&](const QString& file) { exchange.shuffle_movie(file, "demo", 1); }},
      {"g.depth", [&](const QString& file) {
         exchange.export_array(file);
         QTest::mouseClick(window->findChild<Question*>("question")->findChild<QPushButton*>("answer"), Qt::LeftButton);
       }}};
  for (const auto& [name, act] : exports) write(name.toStdString().c_str(), "old");
  const QStringList there = files();
  for (const auto& [name, act] : exports) {
    {
      const FullDisk full;
      act(path(name));
      wait_for_work();
      EXPECT_TRUE(announced().contains(path(name))) << name.toStdString() << ": " << announced().toStdString();
    }
    EXPECT_EQ(read(path(name)), "old") << name.toStdString();
    EXPECT_EQ(files(), there) << name.toStdString();
    EXPECT_EQ(window->document().text(), before) << name.toStdString();
    act(path(name));  // there is room again
    wait_for_work();
    EXPECT_NE(read(path(name)), "old") << name.toStdString() << ": " << announced().toStdString();
    if (window->document().text() != before) trigger("undo");  // a shuffle is declared
  }
}

TEST_F(OnAFullDisk, SavingFailsAndTheWorkStays) {
  canvas().setFocus();
  QTest::keyClick(&canvas(), Qt::Key_Right);
  const std::string changed = window->document().text();
  ASSERT_TRUE(window->document().is_modified());
  const QStringList there = files();
  {
    const FullDisk full;
    trigger("save");
    EXPECT_TRUE(announced().contains(path("table.wale"))) << announced().toStdString();
  }
  EXPECT_TRUE(window->document().is_modified());
  EXPECT_EQ(window->document().text(), changed);
  EXPECT_EQ(read(path("table.wale")), on_disk);
  EXPECT_EQ(files(), there);
  trigger("save");
  EXPECT_EQ(read(path("table.wale")), changed);
  EXPECT_FALSE(window->document().is_modified());
}

TEST_F(OnAFullDisk, AnAutosaveThatIsNotKeptIsSaidOnce) {
  QStringList said;
  QObject::connect(window->findChild<Announcement*>(), &Announcement::read_out,
                   [&](const QString& words) { said << words; });
  {
    const FullDisk full;
    for (int i = 0; i < 3; ++i) {
      QTest::keyClick(&canvas(), Qt::Key_Right);
      QTest::qWait(1100);
    }
  }
  ASSERT_EQ(said.size(), 1) << said.join("\n").toStdString();
  EXPECT_TRUE(said.front().contains("sandpaper/") && said.front().contains("save it")) << said.front().toStdString();
}

TEST_F(OnAFullDisk, AnImportLeavesNoHalfPicture) {
  const QString ramp = QString(WALE_SOURCE_DIR) + "/tests/library/thesis_files/ramp.depth";
  const QStringList there = files();
  {
    const FullDisk full;
    window->exchange().import_files({ramp});
    QTest::mouseClick(window->findChild<Question*>("question")->findChild<QPushButton*>("answer"), Qt::LeftButton);
  }
  EXPECT_TRUE(announced().contains(path("ramp.pgm"))) << announced().toStdString();
  EXPECT_EQ(window->document().text(), on_disk);
  EXPECT_EQ(files(), there);
}

TEST_F(OnAFullDisk, WhatWasFeltIsKeptWhereTheSoundCannotBe) {
  rub_recorded(path("run.wav"));
  ASSERT_TRUE(QDir(folder.path()).mkdir("run.wav"));  // a sound cannot be written there
  trigger("feel");
  wait_for_work();
  EXPECT_TRUE(announced().contains(path("run.wav"))) << announced().toStdString();
  EXPECT_TRUE(announced().contains(path("run.wrec"))) << announced().toStdString();
  EXPECT_TRUE(wale::Recording::open(path("run.wrec").toStdString()));
  EXPECT_FALSE(QFile::exists(path("run.wav.part")));
}

TEST_F(OnAFullDisk, ARecordingThatCannotHaveItsNameIsKeptUnderAnother) {
  rub_recorded(path("run.wrec"));
  ASSERT_TRUE(QDir(folder.path()).mkdir("run.wrec"));
  trigger("feel");
  wait_for_work();
  EXPECT_TRUE(announced().contains(path("run.wrec") + " cannot be written")) << announced().toStdString();
  EXPECT_TRUE(announced().contains(path("run-2.wrec"))) << announced().toStdString();
  EXPECT_TRUE(wale::Recording::open(path("run-2.wrec").toStdString()));
  EXPECT_FALSE(QFile::exists(path("run.wrec.part")));
  trigger("feel");  // without a recording, one feels on
  EXPECT_TRUE(window->feeling().is_on());
}

TEST_F(OnAFullDisk, ARecordingThatCannotBeginIsSaidAndOneFeelsOnWithoutIt) {
  write("run.wrec", "old");
  window->exchange().record(path("run.wrec"));
  {
    const FullDisk full;
    trigger("feel");
    EXPECT_TRUE(announced().contains(path("run.wrec"))) << announced().toStdString();
    EXPECT_FALSE(window->feeling().is_on());
    trigger("feel");  // nobody has to find out how to end it
    EXPECT_TRUE(window->feeling().is_on()) << announced().toStdString();
  }
  EXPECT_EQ(read(path("run.wrec")), "old");
  EXPECT_FALSE(QFile::exists(path("run.wrec.part")));
}

}  // namespace
}  // namespace sandpaper
