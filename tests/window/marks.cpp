// What moves on the canvas: the marks of all patches, surfaces that remember, and the hand.
#include <QPainter>
#include <QScreen>
#include <QWindow>
#include <set>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

constexpr const char* shown = R"(wale 1

material target {
  physical {
    force = vector(0.1 N, 0 N)
    show point(vector(0 mm, 0 mm), 6 mm, colour: "#00ff00")
  }
}

material pendulum {
  physical {
    force = vector(0.1 N, 0 N)
    show point(vector(12 mm * sin(2 * pi * 3 Hz * time), 0 mm), 4 mm, colour: "#ff00ff")
  }
}

material follower {
  physical {
    state p : length = x in -50 mm .. 15 mm
    p' = (x - p) / 50 ms
    force = vector(0.1 N, 0 N)
    show point(vector(p, 0 mm), 4 mm, colour: "#0000ff")
  }
}

material snow {
  physical {
    memory packed = 0 in 0 .. 1, cell 8 mm
    next packed = packed + dt / 20 ms
    force = vector(0.1 N, 0 N)
    show colour(1, 1 - packed, 1 - packed)
  }
}

workspace all {
  patch left = target { at -40 mm, 40 mm; size 40 mm, 40 mm }
  patch middle = pendulum { at 0 mm, -10 mm; size 40 mm, 40 mm }
  patch right = follower { at 45 mm, 30 mm; size 40 mm, 40 mm }
  patch field = snow { at -45 mm, -40 mm; size 40 mm, 40 mm }
}
)";

class MovingWindow : public DrivenWindow {
 protected:
  void SetUp() override {
    begin();
    ASSERT_TRUE(window->open(write("all.wale", shown)));
    wait_for_programs();
    ASSERT_TRUE(wait_until([&] { return !window->is_busy(); }, 30000));
    QTest::qWait(50);
  }
  QRgb colour_at(double x_mm, double y_mm) { return canvas().grab().toImage().pixel(pixels(x_mm, y_mm)); }
  /// How many pixels of the canvas have that colour.
  int count(QRgb colour) {
    const QImage image = canvas().grab().toImage();
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) count += image.pixel(x, y) == colour;
    return count;
  }
};

constexpr QRgb green = 0xff00ff00, magenta = 0xffff00ff, blue = 0xff0000ff;

TEST_F(MovingWindow, MarksAreSeenBeforeAHandComes) {
  EXPECT_EQ(colour_at(-40, 40), green);
  EXPECT_EQ(colour_at(45, 30), blue);  // where a hand in the middle would have it
  const double per_mm = canvas().pixels_per_metre() / 1000;
  EXPECT_NEAR(count(green), 3.14159 * 9 * per_mm * per_mm, 0.2 * 3.14159 * 9 * per_mm * per_mm);
  trigger("look_blind");  // nothing tells which is which
  QTest::qWait(50);
  EXPECT_EQ(count(green), 0);
}

TEST_F(MovingWindow, APatchInFrontHidesThem) {
  drop("denim", -40, 40);
  QTest::qWait(50);
  EXPECT_EQ(count(green), 0);
  trigger("undo");
  QTest::qWait(50);
  EXPECT_GT(count(green), 0);
}

TEST_F(MovingWindow, TheyMoveWithoutAHandAndStayWhereItLeavesThem) {
  trigger("feel");
  std::set<int> places;
  for (int i = 0; i < 30; ++i) {
    QTest::qWait(20);
    const QImage image = canvas().grab().toImage();
    for (int x = 0; x < image.width(); ++x)
      if (image.pixel(x, pixels(0, -10).y()) == magenta) {
        places.insert(x);
        break;
      }
  }
  EXPECT_GT(places.size(), 5u);  // nobody touches the pendulum
  // The hand pulls the follower to 15 mm, the most, and leaves it there.
  for (int i = 0; i < 40; ++i) {
    QTest::mouseMove(&canvas(), pixels(60, 30 + i % 2), 5);
    QTest::qWait(15);
  }
  QTest::mouseMove(&canvas(), pixels(75, 30), 5);
  ASSERT_TRUE(wait_until([&] { return canvas().touched() != placed("right").id; }));
  QTest::qWait(100);
  EXPECT_EQ(colour_at(60, 30), blue);
  trigger("feel");
  QTest::qWait(50);
  EXPECT_EQ(colour_at(60, 30), blue);
}

TEST_F(MovingWindow, WhatMovesLeavesNoTrace) {
  trigger("feel");
  rub(-40, 40, 60, 2);
  trigger("feel");
  QTest::qWait(100);
  // What is on the screen, of which only the parts that changed were painted, and the canvas painted anew.
  const QPoint corner = canvas().mapTo(window.get(), QPoint(0, 0));
  const QImage screen = window->screen()->grabWindow(window->winId(), corner.x(), corner.y(), canvas().width(), canvas().height())
                            .toImage().convertToFormat(QImage::Format_RGB32);
  ASSERT_EQ(screen.size(), canvas().size());
  EXPECT_EQ(screen, canvas().grab().toImage().convertToFormat(QImage::Format_RGB32));
}

TEST_F(MovingWindow, ASurfaceShowsWhatItRemembers) {
  const QRgb white = colour_at(-45, -40);
  EXPECT_EQ(qRed(white), qGreen(white));
  trigger("feel");
  rub(-45, -40, 12, 2);
  ASSERT_TRUE(wait_until([&] {
    const QRgb trodden = colour_at(-45, -37);
    QTest::mouseMove(&canvas(), pixels(-45, -37), 5);
    return qRed(trodden) > qGreen(trodden) + 50;
  }, 10000));
  const QRgb beside = colour_at(-45, -55);
  EXPECT_EQ(qRed(beside), qGreen(beside));
  // It stays when the hand and the force are gone; the next run begins anew.
  QTest::mouseMove(&canvas(), pixels(0, 60), 5);
  QTest::qWait(200);
  trigger("feel");
  EXPECT_GT(qRed(colour_at(-45, -40)), qGreen(colour_at(-45, -40)) + 50);
  trigger("feel");
  ASSERT_TRUE(wait_until([&] { return qRed(colour_at(-45, -40)) == qGreen(colour_at(-45, -40)); }));
}

}  // namespace
}  // namespace sandpaper
