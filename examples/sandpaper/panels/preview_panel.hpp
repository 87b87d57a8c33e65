#pragma once

#include <QImage>
#include <QScrollArea>
#include <QTimer>
#include <memory>
#include <optional>
#include <vector>
#include <wale/language_service.hpp>

#include "feeling/hand_over.hpp"
#include "feeling/work_thread.hpp"

namespace sandpaper {

/// A picture of the preview; a plot's title is in it, too.
struct PreviewPicture {
  QString name, title;
  QImage image;
};

/// Pictures below one another in a narrow place, and side by side in a low one.
class PreviewSheet : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;
  void show(std::vector<PreviewPicture> pictures, const QString& words);
  const std::vector<PreviewPicture>& pictures() const { return pictures_; }
  /// Takes the size that the pictures need in that room.
  void fit(QSize room);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<PreviewPicture> pictures_;
  std::vector<QRect> boxes_;  // of the images
  QString words_;             // where there is no picture
  QSize room_;
};

/// What `wale preview` shows, of the shown patch: its surface, its profile, its force and the spectrum of the force. It
/// is drawn in the background, and only while somebody can see it. In the window's thread.
class PreviewPanel : public QScrollArea {
  Q_OBJECT

 public:
  explicit PreviewPanel(const wale::LanguageService& language, QWidget* parent = nullptr);

  /// Shows what is felt of a patch, or nothing.
  void show(const QString& name, std::optional<wale::PlacedProgram> what);
  bool is_busy() const { return waiting_.isActive() || thread_.waiting() > 0; }
  const std::vector<PreviewPicture>& pictures() const { return sheet_->pictures(); }

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  void draw();
  static bool alike(const std::optional<wale::PlacedProgram>& a, const std::optional<wale::PlacedProgram>& b);

  const wale::LanguageService& language_;
  PreviewSheet* sheet_;
  QString name_;
  std::optional<wale::PlacedProgram> wanted_, drawn_;
  QTimer waiting_;
  HandOver window_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
