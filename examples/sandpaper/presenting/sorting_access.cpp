// What a screen reader meets on the sorting table: each key is an item with a label, its pile and actions. The patch's
// name is told only where it is the label.
#include <QAccessibleWidget>
#include <QPointer>
#include <map>

#include "canvas/item_access.hpp"
#include "presenting/sorting_table.hpp"

namespace sandpaper {
namespace {

class KeyAccess : public ItemAccess {
 public:
  KeyAccess(SortingTable& table, int index) : ItemAccess(&table), table_(&table), index_(index) {}

  bool isValid() const override { return key() != nullptr; }

  QString text(QAccessible::Text kind) const override {
    const SortingKey* it = key();
    if (!it) return {};
    switch (kind) {
      case QAccessible::Name: return it->label;
      case QAccessible::Value:
      case QAccessible::Description: {
        if (it->pile == 0) return SortingTable::tr("in no pile");
        const QString says = table_->sorting().says(it->pile);
        return says.isEmpty() ? SortingTable::tr("in pile %1").arg(it->pile)
                              : SortingTable::tr("in pile %1, %2").arg(it->pile).arg(says);
      }
      default: return {};
    }
  }

 private:
  const SortingKey* key() const {
    if (!table_ || index_ >= static_cast<int>(table_->sorting().keys().size())) return nullptr;
    return &table_->sorting().keys()[static_cast<std::size_t>(index_)];
  }
  QRectF box() const override { return table_->box_of(*key()); }
  bool is_chosen() const override { return table_->sorting().chosen() == key(); }
  Actions actions() const override {
    if (!isValid()) return {};
    Sorting& sorting = table_->sorting();
    const auto index = static_cast<std::size_t>(index_);
    Actions all = {
        {pressAction(), [&sorting, index] { sorting.choose(index); }},
        {SortingTable::tr("new pile"), [&sorting, index] { sorting.put(index, sorting.new_pile()); }},
        {SortingTable::tr("take out"), [&sorting, index] { sorting.put(index, 0); }}};
    for (const int pile : sorting.piles()) {
      all.emplace_back(SortingTable::tr("into pile %1").arg(pile),
                       [&sorting, index, pile] { sorting.put(index, pile); });
      if (const int own = key()->pile; own != 0 && own != pile)
        all.emplace_back(SortingTable::tr("join its pile to pile %1").arg(pile),
                         [&sorting, own, pile] { sorting.join(own, pile); });
    }
    return all;
  }

  QPointer<SortingTable> table_;
  int index_;
};

class SortingAccess : public QAccessibleWidget {
 public:
  explicit SortingAccess(SortingTable& table) : QAccessibleWidget(&table, QAccessible::List), table_(table) {}
  ~SortingAccess() override {
    for (const auto& [index, id] : known_) QAccessible::deleteAccessibleInterface(id);
  }
  int childCount() const override { return static_cast<int>(table_.sorting().keys().size()); }
  QAccessibleInterface* child(int index) const override {
    if (index < 0 || index >= childCount()) return nullptr;
    if (const auto known = known_.find(index); known != known_.end())
      if (QAccessibleInterface* found = QAccessible::accessibleInterface(known->second)) return found;
    auto* made = new KeyAccess(table_, index);
    known_[index] = QAccessible::registerAccessibleInterface(made);
    return made;
  }
  int indexOfChild(const QAccessibleInterface* child) const override {
    for (const auto& [index, id] : known_)
      if (QAccessible::accessibleInterface(id) == child) return index;
    return -1;
  }
  QAccessibleInterface* childAt(int x, int y) const override {
    const auto key = table_.sorting().key_at(table_.to_metres(QPointF(table_.mapFromGlobal(QPoint(x, y)))));
    return key ? child(static_cast<int>(*key)) : nullptr;
  }
  QAccessibleInterface* focusChild() const override {
    const auto chosen = table_.sorting().chosen_index();
    return table_.hasFocus() && chosen ? child(static_cast<int>(*chosen)) : nullptr;
  }

 private:
  SortingTable& table_;
  mutable std::map<int, QAccessible::Id> known_;
};

QAccessibleInterface* make_access(const QString& of_class, QObject* object) {
  if (of_class == QLatin1String("sandpaper::SortingTable"))
    if (auto* table = qobject_cast<SortingTable*>(object)) return new SortingAccess(*table);
  return nullptr;
}

}  // namespace

void use_sorting_access() {
  static const bool once = [] {
    QAccessible::installFactory(make_access);
    return true;
  }();
  (void)once;
}

}  // namespace sandpaper
