#pragma once

#include <gtest/gtest.h>

#include <QApplication>
#include <QDropEvent>
#include <QLabel>
#include <QListView>
#include <QMimeData>
#include <QTemporaryDir>
#include <QtTest/QTest>
#include <fstream>
#include <memory>

#include "window/main_window.hpp"

namespace sandpaper {

/// The real window, driven as a person does, in a folder of its own.
class DrivenWindow : public ::testing::Test {
 protected:
  void SetUp() override { begin(); }
  void TearDown() override { window.reset(); }

  /// Opens a new window; the one before is closed without a word.
  void begin() {
    window.reset();
    window = std::make_unique<MainWindow>(library(), language());
    window->resize(1280, 800);
    window->show();
    QTest::qWait(20);
  }

  static wale::Library& library() {
    static wale::Library all;
    return all;
  }
  static wale::LanguageService& language() {
    static wale::LanguageService all;
    return all;
  }

  /// Waits longer under a sanitizer: so many times as WALE_PATIENCE says (tests/sanitize).
  template <typename Condition>
  bool wait_until(const Condition& condition, int milliseconds = 20000) {
    const int times = std::max(1, qEnvironmentVariableIntValue("WALE_PATIENCE"));
    for (int waited = 0; waited < times * milliseconds; waited += 10) {
      if (condition()) return true;
      QTest::qWait(10);
    }
    return condition();
  }
  void wait_for_programs() {
    ASSERT_TRUE(wait_until([&] {
      return std::ranges::all_of(contents().placed, [&](const PlacedRef& each) {
        return !each->is_laid_out() || window->feeling().material(each->id);
      });
    }, 60000)) << "materials are not compiled";
  }

  const Contents& contents() { return window->document().contents(); }
  const Placed& placed(const std::string& name) {
    for (const PlacedRef& each : contents().placed)
      if (each->patch.name == name) return *each;
    ADD_FAILURE() << "no patch " << name;
    static const Placed none;
    return none;
  }
  Canvas& canvas() { return window->canvas(); }
  QPoint pixels(double x_mm, double y_mm) { return canvas().to_pixels({x_mm / 1000, y_mm / 1000}).toPoint(); }
  TextField& text() { return *window->findChild<TextField*>("text"); }
  QString announced() { return window->findChild<QLabel*>("announcement")->text(); }
  void trigger(const char* name) {
    QAction* action = window->action(name);
    ASSERT_TRUE(action) << name;
    ASSERT_TRUE(action->isEnabled()) << name;
    action->trigger();
  }

  /// Drops a material of the palette onto a place, as the mouse does.
  void drop(const char* material, double x_mm, double y_mm) {
    auto* palette = window->findChild<QListView*>("palette");
    const auto found =
        palette->model()->match(palette->model()->index(0, 0), Qt::UserRole, material, 1, Qt::MatchExactly);
    ASSERT_FALSE(found.isEmpty()) << material;
    const std::unique_ptr<QMimeData> mime(palette->model()->mimeData({found.front()}));
    QDragEnterEvent enter(pixels(x_mm, y_mm), Qt::CopyAction, mime.get(), Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &enter);
    QDropEvent event(QPointF(pixels(x_mm, y_mm)), Qt::CopyAction, mime.get(), Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas(), &event);
  }
  void drag(QPoint from, QPoint to) {
    QTest::mousePress(&canvas(), Qt::LeftButton, {}, from);
    for (int i = 1; i <= 4; ++i) QTest::mouseMove(&canvas(), from + (to - from) * i / 4, 5);
    QTest::mouseRelease(&canvas(), Qt::LeftButton, {}, to);
  }
  /// Rubs the mouse over a place for a while, and gives the greatest force.
  double rub(double x_mm, double y_mm, double half_mm, int times = 3) {
    double most = 0;
    for (int i = 0; i < times * 20; ++i) {
      const double share = i % 20 < 10 ? i % 10 / 10.0 : 1 - i % 10 / 10.0;
      QTest::mouseMove(&canvas(), pixels(x_mm + (2 * share - 1) * half_mm, y_mm), 5);
      QTest::qWait(12);
      const wale::Force force = window->feeling().now().force;
      most = std::max<double>(most, std::hypot(force.x, force.y));
    }
    return most;
  }

  QString write(const char* name, const std::string& text) {
    const QString path = folder.filePath(name);
    std::ofstream(path.toStdString()) << text;
    return path;
  }
  static std::string read(const QString& path) {
    std::ifstream file(path.toStdString());
    return {std::istreambuf_iterator<char>(file), {}};
  }

  QTemporaryDir folder;
  std::unique_ptr<MainWindow> window;
};

}  // namespace sandpaper
