#pragma once

#include <QTextBrowser>
#include <QUrl>
#include <QWidget>
#include <string>
#include <vector>

namespace sandpaper {

/// A page of Markdown. Below each block of Wale in it is a link that places it, by a click, by the keyboard, or by
/// being dragged onto the workspace.
class PageBrowser : public QTextBrowser {
  Q_OBJECT

 public:
  explicit PageBrowser(QWidget* parent = nullptr);

  /// Opens a page, scrolled to a heading if the address has a fragment. False if there is none.
  bool open(const QUrl& address);
  const std::vector<std::string>& recipes() const { return recipes_; }

 signals:
  void recipe_wanted(const QString& recipe);
  void refused(const QString& why);

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void follow(const QUrl& link);
  void offer_recipes();
  void fit_pictures();
  const std::string* recipe_of(const QUrl& link) const;

  QUrl shown_;
  std::vector<std::string> recipes_;
  QPoint pressed_at_;
  QString pressed_link_;
};

/// The pages from which a beginner learns, beside the editor. They are found as `pages:` (QDir::setSearchPaths).
class PagesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PagesPanel(QWidget* parent = nullptr);

  /// Opens a page by its path in the project, "examples/learn/README.md". False, and `refused`, if it is not installed.
  bool open(const QString& page);

 signals:
  void recipe_wanted(const QString& recipe);
  void refused(const QString& why);

 private:
  PageBrowser* browser_;
};

}  // namespace sandpaper
