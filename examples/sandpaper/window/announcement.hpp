#pragma once

#include <QFrame>
#include <QLabel>
#include <QTimer>
#include <QToolButton>
#include <functional>
#include <optional>

namespace sandpaper {

/// A line that says what went wrong or what can be done, where others would open a box. It goes away by itself, or when
/// it is closed; screen readers read it out.
class Announcement : public QFrame {
  Q_OBJECT

 public:
  /// Lies over the top of a widget, which stays where it is: what a hand feels there would move under it.
  explicit Announcement(QWidget* over);

  void say(const QString& words);
  /// With a button that does something about it; then the line stays until another comes.
  void offer(const QString& words, const QString& button, const std::function<void()>& act);
  /// An offer that comes back when another line goes, until it is closed or withdrawn.
  void keep_offering(const QString& words, const QString& button, const std::function<void()>& act);
  /// Takes a line away that is no longer true, and does not offer it again.
  void withdraw(const QString& words);
  QString text() const { return words_->text(); }
  /// Whether nothing is read out: with a participant, who hears the same loudspeaker and must not hear of materials.
  void set_quiet(bool quiet) { quiet_ = quiet; }

 signals:
  void read_out(const QString& words);  ///< screen readers are told

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Offer {
    QString words, button;
    std::function<void()> act;
  };

  void take_place();
  void show_line(const Offer& line);
  /// Shows what is still offered, or nothing.
  void go_on();

  QLabel* words_;
  QToolButton* button_;
  QTimer timer_;
  std::function<void()> act_;
  std::optional<Offer> kept_;  ///< what comes back
  bool quiet_ = false;
};

}  // namespace sandpaper
