#include "panels/description_panel.hpp"

#include <QFontDatabase>
#include <QHeaderView>
#include <QVBoxLayout>
#include <bit>
#include <utility>

namespace sandpaper {
namespace {

constexpr std::size_t most_known = 500;

QString level(const std::optional<double>& level) {
  return level ? QString::number(*level, 'f', 2) : QStringLiteral("–");
}

/// The same only for the same program, values and size.
std::string key_of(const wale::PlacedProgram& patch) {
  const auto bits = [](float each) { return std::to_string(std::bit_cast<std::uint32_t>(each)); };
  std::string key = std::to_string(reinterpret_cast<std::uintptr_t>(&patch.program.decoded()));
  for (const float each : patch.parameters) key += " " + bits(each);
  return key + "@" + bits(patch.size.width) + " " + bits(patch.size.height) + " " + bits(patch.size.rim);
}

}  // namespace

DescriptionPanel::DescriptionPanel(const wale::LanguageService& language, QWidget* parent)
    : QWidget(parent), language_(language), title_(new QLabel), percepts_(new QTableWidget), text_(new QPlainTextEdit) {
  title_->setTextFormat(Qt::PlainText);
  title_->setWordWrap(true);
  percepts_->setColumnCount(4);
  percepts_->setHorizontalHeaderLabels({tr("percept"), tr("asked"), tr("reads"), tr("evidence")});
  percepts_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  percepts_->horizontalHeader()->setStretchLastSection(true);
  percepts_->verticalHeader()->hide();
  percepts_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  percepts_->setAccessibleName(tr("Percepts"));
  percepts_->setMaximumHeight(150);
  text_->setReadOnly(true);
  text_->setLineWrapMode(QPlainTextEdit::NoWrap);
  text_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  text_->setAccessibleName(tr("Description"));
  text_->setTabChangesFocus(true);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(title_);
  layout->addWidget(percepts_);
  layout->addWidget(text_);
}

void DescriptionPanel::show_none(const QString& name, const QString& why) {
  title_->setText(name);
  shown_.clear();
  program_ = nullptr;
  is_reading_ = false;
  percepts_->setRowCount(0);
  text_->setPlainText(why);
}

void DescriptionPanel::show(const QString& name, const wale::PlacedProgram& patch) {
  show_read(name, key_of(patch), &patch.program.decoded(), [&language = language_, patch] {
    const auto told = language.tell(patch.program, patch.parameters, patch.size);
    if (!told) return Told{.text = QString::fromStdString(wale::in_words(told.error())), .of = {patch.program}};
    return Told{QString::fromStdString(told->text), told->percepts, {patch.program}, true};
  });
}

void DescriptionPanel::show_pair(const QString& names, const wale::PlacedProgram& a, const wale::PlacedProgram& b) {
  const std::string key = key_of(a) + "|" + key_of(b) + "|" + a.called + "|" + b.called;
  show_read(names, key, &a.program.decoded(), [&language = language_, a, b] {
    const auto compared = language.compare(a, b);
    return Told{.text = QString::fromStdString(compared ? *compared : wale::in_words(compared.error())),
                .of = {a.program, b.program}};
  });
}

void DescriptionPanel::show_read(const QString& name, const std::string& key, const void* program,
                                 std::function<Told()> read) {
  title_->setText(name);
  if (key == shown_) return;
  shown_ = key;
  if (const auto known = known_.find(key); known != known_.end()) {
    program_ = program;
    return fill(*known->second);
  }
  if (std::exchange(program_, program) != program) {
    percepts_->setRowCount(0);
    text_->setPlainText(tr("reading …"));
  }
  is_reading_ = true;
  // Of what a moving slider asks for, only the newest is read.
  thread_.post(0, "shown", [this, key, read = std::move(read)] {
    const auto told = std::make_shared<const Told>(read());
    window_.post([this, key, told] {
      if (known_.size() > most_known) known_.clear();
      known_[key] = told;
      if (key == shown_) fill(*told);
    });
  });
}

void DescriptionPanel::fill(const Told& told) {
  is_reading_ = false;
  percepts_->setVisible(!told.percepts.empty());
  percepts_->setRowCount(static_cast<int>(told.percepts.size()));
  for (int row = 0; row < percepts_->rowCount(); ++row) {
    const wale::ToldPercept& each = told.percepts[static_cast<std::size_t>(row)];
    const QString why = QString::fromStdString(each.why);
    const QString columns[] = {QString::fromStdString(each.name), level(each.asked), level(each.reads),
                               QString::fromStdString(each.evidence)};
    for (int column = 0; column < 4; ++column) {
      auto* item = new QTableWidgetItem(columns[column]);
      item->setToolTip(why);
      percepts_->setItem(row, column, item);
    }
  }
  text_->setPlainText(told.names_itself ? title_->text() + told.text.mid(told.text.indexOf('\n')) : told.text);
}

}  // namespace sandpaper
