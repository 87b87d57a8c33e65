#include "panels/palette_panel.hpp"

#include <QCoreApplication>
#include <QCryptographicHash>
#include <QDir>
#include <QFile>
#include <QMimeData>
#include <QPushButton>
#include <QStandardPaths>
#include <QVBoxLayout>

namespace sandpaper {
namespace {

constexpr int thumbnail_side = 48;           // pixels
constexpr glm::vec2 thumbnail_size{0.03f, 0.03f};  // m, of the part that is shown
constexpr int thumbnail_urgency = -1;
constexpr qsizetype most_kept = 2000;  // thumbnails on the disk, some kilobytes each
constexpr const char* of_materials = "application/x-wale-material";
/// What the thumbnails are compiled with: nothing but the library.
const std::string nothing_around = "wale 1\n";

/// The folder of kept thumbnails, with a slash. What is in it for too long, mostly of another build, is removed.
QString thumbnail_folder() {
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation) + "/wale/sandpaper");
  QDir().mkpath(folder.path());
  const QFileInfoList old_first = folder.entryInfoList(QDir::Files, QDir::Time | QDir::Reversed);
  for (qsizetype i = 0; i < old_first.size() - most_kept; ++i) QFile::remove(old_first[i].filePath());
  return folder.path() + "/";
}

}  // namespace

PaletteModel::PaletteModel(const wale::Catalogue& catalogue, Programs& programs, Pictures& pictures, QObject* parent)
    : QAbstractListModel(parent), catalogue_(catalogue), programs_(programs), pictures_(pictures) {
  const auto redraw = [this] {
    if (!entries_.empty()) emit dataChanged(index(0), index(rowCount() - 1), {Qt::DecorationRole});
  };
  connect(&programs_, &Programs::compiled, this, redraw);
  connect(&pictures_, &Pictures::drawn, this, redraw);
  search({}, {});
}

void PaletteModel::search(const QString& words, const QString& kind) {
  beginResetModel();
  entries_ = catalogue_.search(words.toStdString(), kind.toStdString());
  endResetModel();
}

int PaletteModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(entries_.size());
}

QString PaletteModel::kept_in(const wale::CatalogueEntry& entry) const {
  if (entry.content.empty()) return {};
  static const QString folder = thumbnail_folder();
  const QByteArray key = QByteArray::fromStdString(entry.content + programs_.device());
  return folder + QString::fromLatin1(QCryptographicHash::hash(key, QCryptographicHash::Sha256).toHex().left(32)) +
         ".png";
}

QVariant PaletteModel::thumbnail(const wale::CatalogueEntry& entry) const {
  const QString file = kept_in(entry);
  if (!file.isEmpty()) {
    const auto [known, is_new] = kept_.try_emplace(file);
    if (is_new) known->second.load(file);
    if (!known->second.isNull()) return known->second;
  }
  QImage image;
  if (const auto material = programs_.find(nothing_around, {}, entry.spelling, thumbnail_urgency);
      material && material->program) {
    const wale::Program& program = *material->program;
    image = pictures_.find(program, program.default_parameters(), thumbnail_size, {}, {thumbnail_side, thumbnail_side},
                           Look::relief, colour_of(entry.spelling), thumbnail_urgency);
    if (!image.isNull() && !file.isEmpty()) {
      image = image.scaled(thumbnail_side, thumbnail_side, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
      kept_[file] = image;
      // Under another name first: nobody reads half a picture. A disk that does not take it costs the picture only.
      const QString part = file + QString(".%1").arg(QCoreApplication::applicationPid());
      if (!image.save(part, "PNG") || !QFile::rename(part, file)) QFile::remove(part);
    }
  }
  if (image.isNull()) {
    image = QImage(thumbnail_side, thumbnail_side, QImage::Format_RGB32);
    image.fill(QColor(200, 200, 200));
  }
  return image.scaled(thumbnail_side, thumbnail_side, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
}

QVariant PaletteModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const wale::CatalogueEntry& each = entry(index.row());
  const QString name = QString::fromStdString(each.name), title = QString::fromStdString(each.title);
  switch (role) {
    case Qt::DisplayRole:
      return title.isEmpty() || title.compare(name, Qt::CaseInsensitive) == 0 ? name : name + "\n" + title;
    case Qt::DecorationRole: return thumbnail(each);
    case Qt::AccessibleTextRole:
      return tr("%1, %2").arg(title.isEmpty() ? name : title, QString::fromStdString(each.kind));
    case Qt::AccessibleDescriptionRole: return QString::fromStdString(each.documentation);
    case Qt::ToolTipRole: {
      QString tip = "<b>" + (title.isEmpty() ? name : title).toHtmlEscaped() + "</b> " +
                    QString::fromStdString(each.kind).toHtmlEscaped();
      if (!each.documentation.empty()) tip += "<br>" + QString::fromStdString(each.documentation).toHtmlEscaped();
      for (const std::string& like : each.feels)
        tip += "<br><i>" + QString::fromStdString(like).toHtmlEscaped() + "</i>";
      return tip;
    }
    case Qt::UserRole: return QString::fromStdString(each.spelling);
    default: return {};
  }
}

Qt::ItemFlags PaletteModel::flags(const QModelIndex& index) const {
  return QAbstractListModel::flags(index) | Qt::ItemIsDragEnabled;
}

QStringList PaletteModel::mimeTypes() const { return {of_materials, "text/plain"}; }

QMimeData* PaletteModel::mimeData(const QModelIndexList& indexes) const {
  if (indexes.isEmpty()) return nullptr;
  auto* mime = new QMimeData;
  const QString spelling = data(indexes.front(), Qt::UserRole).toString();
  mime->setData(of_materials, spelling.toUtf8());
  mime->setText(spelling);
  return mime;
}

PalettePanel::PalettePanel(const wale::Catalogue& catalogue, Programs& programs, Pictures& pictures, QWidget* parent)
    : QWidget(parent),
      model_(new PaletteModel(catalogue, programs, pictures, this)),
      words_(new QLineEdit),
      kind_(new QComboBox),
      list_(new QListView),
      nothing_(new QLabel(tr("No material is called so. Fewer words, or all kinds, may find one."))) {
  words_->setPlaceholderText(tr("Search the library"));
  words_->setClearButtonEnabled(true);
  words_->setAccessibleName(tr("Search the library"));
  kind_->setAccessibleName(tr("Kind of material"));
  kind_->addItem(tr("all kinds"), QString());
  for (const std::string& each : catalogue.kinds())
    kind_->addItem(QString::fromStdString(each), QString::fromStdString(each));
  list_->setModel(model_);
  list_->setIconSize({thumbnail_side, thumbnail_side});
  list_->setDragEnabled(true);
  list_->setUniformItemSizes(true);
  list_->setAccessibleName(tr("Materials of the library"));
  list_->setObjectName("palette");
  words_->setObjectName("search");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(words_);
  layout->addWidget(kind_);
  layout->addWidget(list_);
  nothing_->setWordWrap(true);
  nothing_->setObjectName("nothing_found");
  nothing_->hide();
  layout->addWidget(nothing_);
  auto* place = new QPushButton(tr("Place on the workspace"));
  place->setAccessibleName(tr("Place on the workspace"));
  place->setObjectName("place");
  layout->addWidget(place);
  connect(place, &QPushButton::clicked, this, [this] {
    const QModelIndexList chosen = list_->selectionModel()->selectedIndexes();
    const QModelIndex index = chosen.isEmpty() ? list_->currentIndex() : chosen.front();
    if (index.isValid()) emit wanted(index.data(Qt::UserRole).toString());
  });
  connect(words_, &QLineEdit::textChanged, this, &PalettePanel::search);
  connect(kind_, &QComboBox::currentIndexChanged, this, &PalettePanel::search);
  connect(words_, &QLineEdit::returnPressed, this, [this] {
    if (model_->rowCount() > 0) list_->setCurrentIndex(model_->index(0)), list_->setFocus();
  });
  connect(list_, &QListView::activated, this,
          [this](const QModelIndex& index) { emit wanted(index.data(Qt::UserRole).toString()); });
}

void PalettePanel::search() {
  model_->search(words_->text(), kind_->currentData().toString());
  const bool found = model_->rowCount() > 0;
  if (found) list_->setCurrentIndex(model_->index(0));  // the best answer
  nothing_->setVisible(!found);
}

void PalettePanel::set_touched(const QString& made_of) {
  const QString material = made_of.section('(', 0, 0).trimmed();
  list_->clearSelection();
  for (int row = 0; row < model_->rowCount() && !material.isEmpty(); ++row)
    if (model_->index(row).data(Qt::UserRole).toString() == material) {
      list_->selectionModel()->select(model_->index(row), QItemSelectionModel::ClearAndSelect);
      list_->scrollTo(model_->index(row));
      return;
    }
}

}  // namespace sandpaper
