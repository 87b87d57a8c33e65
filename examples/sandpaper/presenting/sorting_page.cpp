#include "presenting/sorting_page.hpp"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace sandpaper {

SortingPage::SortingPage(Sorting& sorting, Feeling& feeling, QWidget* parent)
    : QWidget(parent),
      sorting_(sorting),
      table_(new SortingTable(sorting, feeling)),
      label_(new QLineEdit),
      new_pile_(new QPushButton(tr("New pile (+)"))),
      take_out_(new QPushButton(tr("Take out (0)"))),
      take_back_(new QPushButton(tr("Take back (⌫)"))) {
  table_->setObjectName("table");
  label_->setObjectName("pile_label");
  label_->setAccessibleName(tr("Label of the chosen key's pile"));
  label_->setMaxLength(200);
  auto* done = new QPushButton(tr("Done"));
  new_pile_->setObjectName("new_pile"), take_out_->setObjectName("take_out"), take_back_->setObjectName("take_back");
  done->setObjectName("sorting_done");
  auto* bar = new QHBoxLayout;
  bar->setContentsMargins(6, 4, 6, 6);
  bar->addWidget(label_, 1);
  for (QPushButton* each : {new_pile_, take_out_, take_back_, done}) bar->addWidget(each);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(table_, 1);
  layout->addLayout(bar);
  connect(&sorting_, &Sorting::changed, this, &SortingPage::update_bar);
  connect(table_, &SortingTable::label_wanted, this, &SortingPage::ask_label);
  connect(label_, &QLineEdit::editingFinished, this, [this] { sorting_.label(shown_, label_->text()); });
  connect(label_, &QLineEdit::returnPressed, table_, qOverload<>(&QWidget::setFocus));
  connect(new_pile_, &QPushButton::clicked, this, [this] {
    if (const auto chosen = sorting_.chosen_index()) sorting_.put(*chosen, sorting_.new_pile());
  });
  connect(take_out_, &QPushButton::clicked, this, [this] {
    if (const auto chosen = sorting_.chosen_index()) sorting_.put(*chosen, 0);
  });
  connect(take_back_, &QPushButton::clicked, this, [this] { sorting_.take_back(); });
  connect(done, &QPushButton::clicked, this, &SortingPage::done);
  setFocusProxy(table_);
  update_bar();
}

void SortingPage::ask_label() {
  if (!label_->isEnabled()) return;
  label_->setFocus();
  label_->selectAll();
}

void SortingPage::update_bar() {
  const SortingKey* chosen = sorting_.chosen();
  const int pile = chosen ? chosen->pile : 0;
  if (pile != shown_ || !label_->hasFocus()) label_->setText(sorting_.says(pile));
  shown_ = pile;
  label_->setEnabled(pile != 0);
  label_->setPlaceholderText(pile != 0 ? tr("What is alike in pile %1?").arg(pile)
                                       : tr("The chosen key is in no pile"));
  new_pile_->setEnabled(chosen);
  take_out_->setEnabled(pile != 0);
  take_back_->setEnabled(sorting_.can_take_back());
}

}  // namespace sandpaper
