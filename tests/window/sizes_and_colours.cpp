// The window from 1280 x 720 to 4K, in light and in dark colours. WALE_PICTURES=FOLDER keeps the pictures to look at.
#include <QDockWidget>
#include <QListWidget>
#include <QMenuBar>
#include <QStyleFactory>
#include <QTextBlock>
#include <QTextLayout>
#include <cmath>

#include "driven_window.hpp"

namespace sandpaper {
namespace {

QPalette dark() {
  QPalette dark;
  for (const auto role : {QPalette::Window, QPalette::Button, QPalette::AlternateBase, QPalette::ToolTipBase})
    dark.setColor(role, QColor(45, 45, 48));
  dark.setColor(QPalette::Base, QColor(30, 30, 30));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText})
    dark.setColor(role, QColor(225, 225, 225));
  dark.setColor(QPalette::PlaceholderText, QColor(150, 150, 150));
  dark.setColor(QPalette::Mid, QColor(110, 110, 110));
  dark.setColor(QPalette::Highlight, QColor(60, 120, 215));
  dark.setColor(QPalette::HighlightedText, Qt::white);
  return dark;
}

/// How well a colour stands out from another, 1 .. 21 (WCAG 2.1, contrast ratio).
double contrast(const QColor& a, const QColor& b) {
  const auto luminance = [](const QColor& colour) {
    const auto linear = [](double x) { return x <= 0.03928 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) + 0.0722 * linear(colour.blueF());
  };
  const double one = luminance(a) + 0.05, other = luminance(b) + 0.05;
  return std::max(one, other) / std::min(one, other);
}

class ShownWindow : public DrivenWindow, public ::testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    usual_ = QApplication::palette();
    QApplication::setStyle(QStyleFactory::create("Fusion"));
    if (GetParam()) QApplication::setPalette(dark());
    begin();
  }
  void TearDown() override {
    window.reset();
    QApplication::setPalette(usual_);
  }
  void keep(const QString& name) {
    const QString folder = qEnvironmentVariable("WALE_PICTURES");
    if (!folder.isEmpty()) EXPECT_TRUE(window->grab().save(folder + "/" + name + (GetParam() ? "_dark" : "") + ".png"));
  }

 private:
  QPalette usual_;
};

TEST_P(ShownWindow, FitsAndStaysLegible) {
  ASSERT_TRUE(window->open(WALE_SOURCE_DIR "/examples/sandpaper/kitchen.wale"));
  wait_for_programs();
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080), QSize(3840, 2160)}) {
    window->resize(size);
    window->document().choose({placed("mat").id});
    ASSERT_TRUE(wait_until([&] { return !window->is_busy(); }, 60000));
    EXPECT_EQ(window->size(), size);  // nothing in it needs more
    for (const QDockWidget* dock : window->findChildren<QDockWidget*>())
      if (!dock->visibleRegion().isEmpty())  // not behind another tab
        EXPECT_TRUE(window->rect().contains(dock->geometry())) << dock->objectName().toStdString();
    EXPECT_GT(canvas().width() * canvas().height(), size.width() * size.height() / 6);
    keep(QString::number(size.width()));
  }
  // The colours that are not the palette's: of errors, and of the words of the text.
  text().setPlainText("wale 1\n\n/// A comment.\nmaterial m { physical { force = vector(1 N * sin(2 * pi * x / 4 m), z N) } }\n"
                      "workspace w { patch p = m(\"a\") {} }\n");
  ASSERT_TRUE(wait_until([&] {
    auto* problems = window->findChild<QListWidget*>();
    return problems && problems->count() > 0 && !window->is_busy();
  }, 20000));
  const QColor base = text().palette().color(QPalette::Base);
  auto* problems = window->findChild<QListWidget*>();
  for (int i = 0; i < problems->count(); ++i)
    EXPECT_GT(contrast(problems->item(i)->foreground().color(), base), 4.5) << problems->item(i)->text().toStdString();
  for (QTextBlock block = text().document()->begin(); block.isValid(); block = block.next())
    for (const QTextLayout::FormatRange& each : block.layout()->formats())
      if (each.format.foreground().style() != Qt::NoBrush)
        EXPECT_GT(contrast(each.format.foreground().color(), base), 4.5) << block.text().toStdString();
  keep("errors");
  trigger("feel");
  rub(-10, -19, 15, 1);
  keep("felt");
}
INSTANTIATE_TEST_SUITE_P(LightAndDark, ShownWindow, ::testing::Bool(),
                         [](const auto& of) { return of.param ? "Dark" : "Light"; });

}  // namespace
}  // namespace sandpaper
