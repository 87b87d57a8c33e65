// Sandpaper: a window in which materials are laid out, felt and changed.
#include <QApplication>
#include <QCommandLineParser>
#include <QDir>
#include <QFileInfo>
#include <QTimer>
#include <cstdio>
#include <cstdlib>
#include <wale/language_service.hpp>

#include "window/main_window.hpp"

namespace {

QtMessageHandler usual = nullptr;

/// Qt ends a process that finds no screen as a crash; a person gets a sentence and a status instead.
void end_without_a_screen(QtMsgType type, const QMessageLogContext& context, const QString& text) {
  if (type != QtFatalMsg) return;  // its other lines tell the same in words of Qt
  if (!text.contains("platform plugin")) return usual(type, context, text);
  std::fputs(
      "sandpaper: there is no screen to open a window on; log in to a desktop, or feel without a window: wale feel\n",
      stderr);
  std::_Exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  usual = qInstallMessageHandler(end_without_a_screen);
  QApplication application(argc, argv);
  qInstallMessageHandler(usual);
  QApplication::setApplicationName("sandpaper");
  QApplication::setOrganizationName("wale");
  QApplication::setApplicationDisplayName("Sandpaper");
  // Where the pages are installed; in a clone, the folder of the project, in which `./wale` builds.
  const QString here = QApplication::applicationDirPath();
  QDir::setSearchPaths("pages", {here + "/" WALE_PAGES, here + "/.."});
  QCommandLineParser parser;
  parser.setApplicationDescription("Lays materials out, lets a hand feel them and changes them.");
  parser.addHelpOption();
  const QCommandLineOption device("device", "The device to feel with, as `wale feel --device` spells it.", "DEVICE");
  const QCommandLineOption look("screenshot", "Writes a picture of the window when everything is drawn, and ends.",
                                "FILE");
  parser.addOptions({device, look});
  parser.addPositionalArgument("FILE", "A Wale file with a workspace.", "[FILE…]");
  parser.process(application);

  const wale::Library library;
  const wale::LanguageService language;
  const QStringList files = parser.positionalArguments();
  // One window for each file; without one, an empty workspace.
  std::vector<std::unique_ptr<sandpaper::MainWindow>> windows;
  for (const QString& file : files.isEmpty() ? QStringList{QString()} : files) {
    auto window = std::make_unique<sandpaper::MainWindow>(library, language);
    if (!file.isEmpty() && !window->open(file)) {
      std::fprintf(stderr, "sandpaper: %s cannot be opened\n", qPrintable(file));
      if (parser.isSet(look)) return 1;
    }
    if (parser.isSet(device)) window->feeling().open(parser.value(device));
    window->show();
    windows.push_back(std::move(window));
  }
  QTimer waiting;
  if (parser.isSet(look)) {
    int quiet = 0;
    QObject::connect(&waiting, &QTimer::timeout, [&] {
      quiet = windows.front()->is_busy() ? 0 : quiet + 1;
      if (quiet < 5) return;
      waiting.stop();
      QApplication::exit(windows.front()->grab().save(parser.value(look)) ? 0 : 1);
    });
    waiting.start(100);
  }
  return QApplication::exec();
}
