#pragma once

#include <QLineEdit>
#include <QPushButton>

#include "presenting/sorting_table.hpp"

namespace sandpaper {

/// The sorting table and what belongs to it: the label of the chosen key's pile, and buttons.
class SortingPage : public QWidget {
  Q_OBJECT

 public:
  SortingPage(Sorting& sorting, Feeling& feeling, QWidget* parent = nullptr);
  SortingTable& table() const { return *table_; }
  /// Lets somebody type the label of the chosen key's pile, if it is in one.
  void ask_label();

 signals:
  void done();

 private:
  void update_bar();

  Sorting& sorting_;
  SortingTable* table_;
  QLineEdit* label_;
  QPushButton *new_pile_, *take_out_, *take_back_;
  int shown_ = 0;  // the pile whose label is shown
};

}  // namespace sandpaper
