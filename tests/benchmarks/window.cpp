// Measures the window of Sandpaper on the screen that it is given, for tests/benchmarks/window: how soon it opens, how
// many pictures a second it draws, and how late the loop is with and without it.
#include <QApplication>
#include <QElapsedTimer>
#include <QEvent>
#include <QTemporaryDir>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>
#include <wale/recording.hpp>

#include "window/main_window.hpp"

namespace sandpaper {
namespace {

constexpr double bar_open = 1, bar_animated = 60, bar_many = 30, bar_late = 1.1;
constexpr int mouse_milliseconds = 8;  // between the reports of a mouse

/// Counts the pictures of a widget.
class Pictured : public QObject {
 public:
  long count = 0;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    count += event->type() == QEvent::Paint;
    return QObject::eventFilter(watched, event);
  }
};

void run_for(double seconds) {
  QElapsedTimer timer;
  timer.start();
  while (timer.nsecsElapsed() < 1e9 * seconds) QApplication::processEvents(QEventLoop::WaitForMoreEvents, 5);
}

void wait_until_quiet(MainWindow& window) {
  for (int quiet = 0; quiet < 10;) {
    run_for(0.05);
    quiet = window.is_busy() ? 0 : quiet + 1;
  }
}

/// A grid of patches of a surface that moves, over the whole reach of the device.
std::string patches(int side) {
  std::string text = R"(wale 1

material stream {
  physical {
    height waves = 0.3 mm * sin(2 * pi * x / 5 mm)
    force = vector(0.3 N * sin(2 * pi * (x - 20 mm/s * time) / 5 mm), 0 N)
    show relief(waves)
    show circle(vector(3 mm * sin(2 * pi * 1 Hz * time), 0 mm), 2 mm)
  }
}

workspace many {
)";
  const double pitch = 160.0 / side;
  for (int i = 0; i < side * side; ++i)
    text += "  patch p" + std::to_string(i) + " = stream { at " + std::to_string(pitch * (i % side) - 80 + pitch / 2) +
            " mm, " + std::to_string(pitch * (i / side) - 80 + pitch / 2) + " mm; size " + std::to_string(0.8 * pitch) +
            " mm, " + std::to_string(0.8 * pitch) + " mm }\n";
  return text + "}\n";
}

double pictures_a_second(MainWindow& window, double seconds, bool pans) {
  Pictured pictured;
  window.canvas().installEventFilter(&pictured);
  QTimer panning;
  QObject::connect(&panning, &QTimer::timeout, [&] { window.canvas().zoom(pictured.count % 2 ? 1.001 : 1 / 1.001); });
  if (pans) panning.start(mouse_milliseconds);
  run_for(seconds);
  return static_cast<double>(pictured.count) / seconds;
}

/// The 99th percentile of how late a run of so many seconds is, s; negative if it could not be measured.
double lateness(MainWindow& window, const QString& file, double seconds) {
  window.feeling().record(file);
  window.feeling().set_on(true);
  run_for(seconds);
  window.feeling().set_on(false);
  const auto recording = wale::Recording::open(file.toStdString());
  if (!recording) {
    std::fprintf(stderr, "%s\n", wale::in_words(recording.error()).c_str());
    return -1;
  }
  std::vector<double> late;
  for (std::size_t i = 0; i < recording->ticks(); ++i)
    late.push_back(1e-9 * static_cast<double>(recording->tick(i).lateness));
  if (late.empty()) return -1;
  const auto place = late.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(late.size() - 1));
  std::nth_element(late.begin(), place, late.end());
  return *place;
}

int verdict(const char* what, double value, const char* unit, double bar, bool at_most) {
  const bool good = at_most ? value <= bar : value >= bar;
  std::printf("%-58s %9.3g %-4s  %s %.3g%s\n", what, value, unit, at_most ? "at most" : "at least", bar,
              good ? "" : "  MISSED");
  return good ? 0 : 1;
}

int measure(double seconds) {
  const QTemporaryDir folder;
  const auto written = [&](const char* name, const std::string& text) {
    const QString path = folder.filePath(name);
    std::ofstream(path.toStdString()) << text;
    return path;
  };
  int missed = 0;
  QElapsedTimer timer;
  timer.start();
  const wale::Library library;
  const wale::LanguageService language;
  MainWindow window(library, language);
  Pictured first;
  window.canvas().installEventFilter(&first);
  window.showFullScreen();
  window.resize(1920, 1080);
  while (first.count == 0) QApplication::processEvents(QEventLoop::WaitForMoreEvents, 5);
  missed += verdict("opens with the palette", 1e-9 * static_cast<double>(timer.nsecsElapsed()), "s", bar_open, true);

  window.feeling().open("simulated:sandpaper");
  run_for(1);
  if (!window.open(written("animated.wale", patches(10)))) return 2;
  wait_until_quiet(window);
  window.feeling().set_on(true);
  missed +=
      verdict("100 animated patches, felt", pictures_a_second(window, seconds, false), "/s", bar_animated - 1, false);
  missed += verdict("100 animated patches, panned and felt", pictures_a_second(window, seconds, true), "/s",
                    bar_animated - 1, false);
  window.feeling().set_on(false);

  // By turns, so that other load on the computer falls on both.
  std::vector<double> with, without;
  for (int turn = 0; turn < 3; ++turn) {
    window.showFullScreen();
    with.push_back(lateness(window, folder.filePath(QString("with%1.wrec").arg(turn)), seconds));
    window.hide();
    without.push_back(lateness(window, folder.filePath(QString("without%1.wrec").arg(turn)), seconds));
  }
  std::ranges::sort(with), std::ranges::sort(without);
  std::printf("%-58s %9.3g and %.3g us\n", "lateness p99 with and without the window", 1e6 * with[1], 1e6 * without[1]);
  missed += verdict("  their ratio", with[1] / without[1], "", bar_late, true);

  window.showFullScreen();
  if (!window.open(written("many.wale", patches(100)))) return 2;
  wait_until_quiet(window);
  missed += verdict("10 000 patches, panned", pictures_a_second(window, seconds, true), "/s", bar_many, false);
  window.feeling().set_on(true);
  missed += verdict("10 000 patches, panned and felt", pictures_a_second(window, seconds, true), "/s", bar_many, false);
  window.feeling().set_on(false);
  return missed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace sandpaper

int main(int argc, char** argv) {
  const QTemporaryDir home;
  for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"})
    qputenv(name, home.path().toUtf8());
  QApplication application(argc, argv);
  QApplication::setOrganizationName("wale");
  QApplication::setApplicationName("sandpaper");
  return sandpaper::measure(argc > 1 ? std::max(1.0, std::atof(argv[1])) : 5);
}
