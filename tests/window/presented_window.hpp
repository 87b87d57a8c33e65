#pragma once

#include <cmath>
#include <wale/library.hpp>

#include "driven_window.hpp"

namespace sandpaper {

inline constexpr const char* surfaces = R"(wale 1

material ridges {
  physical {
    param size = 1 N in 0 N .. 3 N  "how hard"
    force = vector(size * sin(2 * pi * x / 4 mm), 0 N)
  }
}

workspace table {
  patch oak_one   = ridges(size: 2 N) { at -50 mm, 40 mm; size 40 mm, 40 mm }
  patch oak_two   = ridges(size: 0.5 N) { at 50 mm, 40 mm; size 40 mm, 40 mm }
  patch oak_three = ridges(size: 2 N) { at -50 mm, -40 mm; size 40 mm, 40 mm }
  patch oak_four  = ridges(size: 0.5 N) { at 50 mm, -40 mm; size 40 mm, 40 mm }
}
workspace second { patch only = ridges { at 0 mm, 0 mm; size 40 mm, 40 mm } }
workspace third { patch only = ridges(size: 3 N) { at 10 mm, 0 mm; size 40 mm, 40 mm } }

movie demo { frames table, second, third, second }

keys sorting { of table; area 60 mm, 60 mm; labels random }
keys by_name { of table; area 60 mm, 60 mm; labels names }
)";

class PresentedWindow : public DrivenWindow {
 protected:
  void SetUp() override {
    DrivenWindow::SetUp();
    file = write("surfaces.wale", surfaces);
    ASSERT_TRUE(window->open(file));
    wait_for_programs();
  }
  /// By the panel, as an experimenter does.
  void begin_session(const char* participant = "S48", const char* seed = "1995") {
    window->findChild<QLineEdit*>("participant_id")->setText(participant);
    window->findChild<QLineEdit*>("seed")->setText(seed);
    window->findChild<QPushButton*>("session_button")->click();
  }
  Session& session() { return window->presenting().session(); }
  Sorting& sorting() { return window->presenting().sorting(); }
  SortingTable& table() { return *window->findChild<QWidget*>("sorting")->findChild<SortingTable*>("table"); }
  wale::SessionRecord log() {
    auto record = wale::open_session_log(session().path().toStdString());
    EXPECT_TRUE(record);
    return record ? *record : wale::SessionRecord();
  }
  template <class Event>
  static std::vector<Event> all_of(const wale::SessionRecord& record) {
    std::vector<Event> all;
    for (const wale::SessionEntry& each : record.entries)
      if (const auto* event = std::get_if<Event>(&each.event)) all.push_back(*event);
    return all;
  }
  void start_sorting() {
    trigger("start_sorting");
    ASSERT_TRUE(wait_until([&] { return sorting().runs(); })) << announced().toStdString();
    QTest::qWait(30);  // for the table's place
  }
  /// Rubs over the touching area with the mouse, and gives the greatest force.
  double felt_in_area() {
    double most = 0;
    for (int i = 0; i < 50; ++i) {
      const double x = sorting().area_at().x + 0.02 * std::sin(0.5 * i);
      QTest::mouseMove(&table(), table().to_pixels({x, sorting().area_at().y}).toPoint(), 5);
      QTest::qWait(12);
      const wale::Force force = window->feeling().now().force;
      most = std::max<double>(most, std::hypot(force.x, force.y));
    }
    return most;
  }
  void click_key(std::size_t key) {
    QTest::mouseClick(&table(), Qt::LeftButton, {}, table().box_of(sorting().keys()[key]).center().toPoint());
  }
  void drag_key(std::size_t key, QPoint to) {
    const QPoint from = table().box_of(sorting().keys()[key]).center().toPoint();
    QTest::mousePress(&table(), Qt::LeftButton, {}, from);
    for (int i = 1; i <= 4; ++i) QTest::mouseMove(&table(), from + (to - from) * i / 4, 5);
    QTest::mouseRelease(&table(), Qt::LeftButton, {}, to);
  }
  std::size_t key_of(const std::string& patch) {
    for (std::size_t i = 0; i < sorting().keys().size(); ++i)
      if (sorting().keys()[i].name == patch) return i;
    ADD_FAILURE() << patch;
    return 0;
  }

  QString file;
};

}  // namespace sandpaper
