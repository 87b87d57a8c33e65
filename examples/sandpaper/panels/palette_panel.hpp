#pragma once

#include <QAbstractListModel>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QWidget>
#include <map>
#include <vector>
#include <wale/catalogue.hpp>

#include "canvas/pictures.hpp"
#include "feeling/programs.hpp"

namespace sandpaper {

/// The materials that were found, with thumbnails that come as they are drawn. Those of the shipped library are kept
/// from one run to the next, so that nothing is compiled for them again.
class PaletteModel : public QAbstractListModel {
  Q_OBJECT

 public:
  PaletteModel(const wale::Catalogue& catalogue, Programs& programs, Pictures& pictures, QObject* parent = nullptr);

  void search(const QString& words, const QString& kind);
  const wale::CatalogueEntry& entry(int row) const { return entries_[static_cast<std::size_t>(row)]; }

  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QStringList mimeTypes() const override;
  QMimeData* mimeData(const QModelIndexList& indexes) const override;

 private:
  QVariant thumbnail(const wale::CatalogueEntry& entry) const;
  QString kept_in(const wale::CatalogueEntry& entry) const;

  const wale::Catalogue& catalogue_;
  Programs& programs_;
  Pictures& pictures_;
  std::vector<wale::CatalogueEntry> entries_;
  mutable std::map<QString, QImage> kept_;  // by the files that they are kept in
};

/// The whole library, to search and to drag from. In the window's thread.
class PalettePanel : public QWidget {
  Q_OBJECT

 public:
  PalettePanel(const wale::Catalogue& catalogue, Programs& programs, Pictures& pictures, QWidget* parent = nullptr);

  /// Shows which material is touched now; the empty text for none.
  void set_touched(const QString& made_of);

 signals:
  /// A person wants a patch of this material: by a double click or the Enter key.
  void wanted(const QString& spelling);

 private:
  void search();

  PaletteModel* model_;
  QLineEdit* words_;
  QComboBox* kind_;
  QListView* list_;
  QLabel* nothing_;
};

}  // namespace sandpaper
