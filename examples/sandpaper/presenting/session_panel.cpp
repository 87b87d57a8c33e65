#include "presenting/session_panel.hpp"

#include <QFormLayout>
#include <QRandomGenerator>
#include <QRegularExpressionValidator>

namespace sandpaper {

SessionPanel::SessionPanel(Session& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      participant_(new QLineEdit),
      seed_(new QLineEdit),
      button_(new QPushButton),
      state_(new QLabel) {
  participant_->setObjectName("participant_id");
  participant_->setPlaceholderText(tr("an identifier, as S48"));
  participant_->setMaxLength(60);
  seed_->setObjectName("seed");
  seed_->setPlaceholderText(tr("any"));
  seed_->setValidator(new QRegularExpressionValidator(QRegularExpression("[0-9]{0,10}"), seed_));
  button_->setObjectName("session_button");
  state_->setObjectName("session_state");
  state_->setWordWrap(true);
  state_->setTextFormat(Qt::PlainText);
  state_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  state_->setMinimumHeight(4 * state_->fontMetrics().lineSpacing());  // a label that wraps has no height of its own
  auto* form = new QFormLayout(this);
  form->addRow(tr("&Participant"), participant_);
  form->addRow(tr("&Seed"), seed_);
  form->addRow(button_);
  form->addRow(state_);
  connect(button_, &QPushButton::clicked, this, [this] {
    if (session_.runs()) return session_.end("ended by the experimenter");
    bool is_number = false;
    const auto seed = seed_->text().toUInt(&is_number);
    if (!is_number && !seed_->text().isEmpty()) {
      state_->setText(tr("A seed is a number from 0 to 4294967295."));
      return seed_->setFocus();
    }
    emit begin_wanted(participant_->text(), is_number ? seed : QRandomGenerator::global()->generate());
  });
  connect(&session_, &Session::changed, this, &SessionPanel::update_state);
  update_state();
}

void SessionPanel::update_state() {
  button_->setText(session_.runs() ? tr("End the session") : tr("Begin a session"));
  for (QLineEdit* each : {participant_, seed_}) each->setEnabled(!session_.runs());
  state_->setText(!session_.runs() ? tr("No session: nothing is logged.")
                  : session_.trouble().isEmpty()
                      ? tr("Seed %1. Logged in %2").arg(session_.seed()).arg(session_.path())
                      : tr("%1 cannot be written: %2").arg(session_.path(), session_.trouble()));
}

}  // namespace sandpaper
