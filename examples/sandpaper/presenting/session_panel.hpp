#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QWidget>

#include "presenting/session.hpp"

namespace sandpaper {

/// Who takes part, the seed, and the button that begins and ends a session.
class SessionPanel : public QWidget {
  Q_OBJECT

 public:
  explicit SessionPanel(Session& session, QWidget* parent = nullptr);

 signals:
  void begin_wanted(const QString& participant, std::uint32_t seed);

 private:
  void update_state();

  Session& session_;
  QLineEdit *participant_, *seed_;
  QPushButton* button_;
  QLabel* state_;
};

}  // namespace sandpaper
