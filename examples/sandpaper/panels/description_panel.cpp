#include "panels/description_panel.hpp"

#include <QFontDatabase>
#include <QHeaderView>
#include <QVBoxLayout>

namespace sandpaper {
namespace {

constexpr std::size_t most_known = 500;

QString level(const std::optional<double>& level) {
  return level ? QString::number(*level, 'f', 2) : QStringLiteral("–");
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

void DescriptionPanel::show(const QString& name, const wale::Program* program, const QString& why_none) {
  title_->setText(name);
  if (!program) {
    shown_ = nullptr;
    percepts_->setRowCount(0);
    text_->setPlainText(why_none);
    return;
  }
  const void* key = &program->decoded();
  if (key == shown_) return;
  shown_ = key;
  if (known_.size() > most_known) known_.clear();
  const auto [found, is_new] = known_.try_emplace(key, *program, nullptr);
  if (found->second.second) return fill(found->second.second);
  percepts_->setRowCount(0);
  text_->setPlainText(tr("reading …"));
  if (!is_new) return;
  thread_.post(0, std::to_string(reinterpret_cast<std::uintptr_t>(key)), [this, key, program = *program] {
    const Told told = std::make_shared<const wale::Result<wale::ToldMaterial>>(language_.tell(program));
    QMetaObject::invokeMethod(this, [this, key, told] {
      const auto waits = known_.find(key);
      if (waits != known_.end()) waits->second.second = told;
      if (key == shown_) fill(told);
    });
  });
}

void DescriptionPanel::fill(const Told& told) {
  if (!*told) {
    percepts_->setRowCount(0);
    text_->setPlainText(QString::fromStdString(wale::in_words(told->error())));
    return;
  }
  const wale::ToldMaterial& material = **told;
  percepts_->setRowCount(static_cast<int>(material.percepts.size()));
  for (int row = 0; row < percepts_->rowCount(); ++row) {
    const wale::ToldPercept& each = material.percepts[static_cast<std::size_t>(row)];
    const QString why = QString::fromStdString(each.why);
    const QString columns[] = {QString::fromStdString(each.name), level(each.asked), level(each.reads),
                               QString::fromStdString(each.evidence)};
    for (int column = 0; column < 4; ++column) {
      auto* item = new QTableWidgetItem(columns[column]);
      item->setToolTip(why);
      percepts_->setItem(row, column, item);
    }
  }
  // The first line is the material's name, which the patch has here.
  const QString text = QString::fromStdString(material.text);
  text_->setPlainText(title_->text() + text.mid(text.indexOf('\n')));
}

}  // namespace sandpaper
