#include "panels/pages_panel.hpp"

#include <QApplication>
#include <QDesktopServices>
#include <QDrag>
#include <QFile>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QMimeData>
#include <QMouseEvent>
#include <QPushButton>
#include <QScrollBar>
#include <QTextBlock>
#include <QTextCursor>
#include <QVBoxLayout>

#include "document/recipe.hpp"

namespace sandpaper {
namespace {

constexpr const char* of_recipes = "application/x-wale-recipe";
constexpr const char* to_place = "place";  // the scheme of a link that places a recipe: place:3

bool is_recipe(const QTextBlock& block) {
  return block.blockFormat().stringProperty(QTextFormat::BlockCodeLanguage) == "wale";
}

/// A heading's anchor: small letters, blanks as hyphens, no other signs.
QString anchor_of(const QString& heading) {
  QString anchor;
  for (const QChar letter : heading.toLower())
    if (letter.isLetterOrNumber() || letter == '_' || letter == '-') anchor += letter;
    else if (letter == ' ') anchor += '-';
  return anchor;
}

}  // namespace

PageBrowser::PageBrowser(QWidget* parent) : QTextBrowser(parent) {
  setOpenLinks(false);
  connect(this, &QTextBrowser::anchorClicked, this, &PageBrowser::follow);
  connect(this, &QTextBrowser::sourceChanged, this, [this](const QUrl& page) {
    shown_ = page;  // source() is still the page before
    offer_recipes();
    fit_pictures();
  });
}

bool PageBrowser::open(const QUrl& address) {
  QUrl page = address;
  page.setFragment({});
  if (!QFileInfo(page.toLocalFile()).isFile()) return false;
  if (page != source()) setSource(page);
  const QString anchor = address.fragment();
  for (QTextBlock block = document()->begin(); block.isValid() && !anchor.isEmpty(); block = block.next())
    if (block.blockFormat().headingLevel() > 0 && anchor_of(block.text()) == anchor) {
      setTextCursor(QTextCursor(block));
      verticalScrollBar()->setValue(verticalScrollBar()->value() + cursorRect().top());
      break;
    }
  return true;
}

const std::string* PageBrowser::recipe_of(const QUrl& link) const {
  if (link.scheme() != to_place) return nullptr;
  const std::size_t at = link.path().toULong();
  return at < recipes_.size() ? &recipes_[at] : nullptr;
}

void PageBrowser::follow(const QUrl& link) {
  if (const std::string* recipe = recipe_of(link)) return emit recipe_wanted(QString::fromStdString(*recipe));
  if (link.scheme().startsWith("http")) {
    QDesktopServices::openUrl(link);
    return;
  }
  if (!open(source().resolved(link))) emit refused(tr("%1 is not installed").arg(link.toString()));
}

void PageBrowser::offer_recipes() {
  recipes_.clear();
  QFile file(shown_.toLocalFile());
  if (!file.fileName().endsWith(".md") || !file.open(QIODevice::ReadOnly)) return;
  recipes_ = recipes_of(file.readAll().toStdString(), QFileInfo(file.fileName()).absolutePath().toStdString());
  std::vector<int> ends;  // of the blocks of Wale in the document
  for (QTextBlock block = document()->begin(); block.isValid(); block = block.next())
    if (is_recipe(block) && !is_recipe(block.next())) ends.push_back(block.position() + block.length() - 1);
  if (ends.size() != recipes_.size()) return recipes_.clear();
  for (std::size_t i = ends.size(); i-- > 0;) {
    QTextCursor cursor(document());
    cursor.setPosition(ends[i]);
    QTextBlockFormat plain;
    plain.setBottomMargin(8);
    QTextCharFormat link;
    link.setAnchor(true);
    link.setAnchorHref(QString("%1:%2").arg(to_place).arg(i));
    link.setForeground(palette().link());
    link.setFontUnderline(true);
    cursor.insertBlock(plain, link);
    cursor.insertText(tr("Place it on the workspace (or drag this there)"), link);
  }
  document()->setModified(false);
}

void PageBrowser::fit_pictures() {
  const double most = viewport()->width() - 2 * document()->documentMargin() - 4;
  for (QTextBlock block = document()->begin(); block.isValid(); block = block.next()) {
    std::vector<QTextFragment> pictures;
    for (auto each = block.begin(); !each.atEnd(); ++each)
      if (each.fragment().charFormat().isImageFormat()) pictures.push_back(each.fragment());
    for (const QTextFragment& each : pictures) {
      QTextImageFormat format = each.charFormat().toImageFormat();
      const QImage image(shown_.resolved(QUrl(format.name())).toLocalFile());
      if (image.isNull() || most < 16) continue;
      format.setWidth(std::min<double>(most, image.width()));
      QTextCursor cursor(document());
      cursor.setPosition(each.position());
      cursor.setPosition(each.position() + each.length(), QTextCursor::KeepAnchor);
      cursor.setCharFormat(format);
    }
  }
}

void PageBrowser::mousePressEvent(QMouseEvent* event) {
  pressed_at_ = event->pos();
  pressed_link_ = anchorAt(event->pos());
  QTextBrowser::mousePressEvent(event);
}

void PageBrowser::mouseMoveEvent(QMouseEvent* event) {
  const std::string* recipe = event->buttons() & Qt::LeftButton ? recipe_of(QUrl(pressed_link_)) : nullptr;
  if (!recipe) return QTextBrowser::mouseMoveEvent(event);
  if ((event->pos() - pressed_at_).manhattanLength() < QApplication::startDragDistance()) return;
  pressed_link_.clear();
  auto* mime = new QMimeData;
  mime->setData(of_recipes, QByteArray::fromStdString(*recipe));
  mime->setText(QString::fromStdString(*recipe));
  auto* drag = new QDrag(this);
  drag->setMimeData(mime);
  drag->exec(Qt::CopyAction);
}

void PageBrowser::resizeEvent(QResizeEvent* event) {
  QTextBrowser::resizeEvent(event);
  fit_pictures();
}

PagesPanel::PagesPanel(QWidget* parent) : QWidget(parent), browser_(new PageBrowser) {
  browser_->setObjectName("page");
  browser_->setAccessibleName(tr("Page"));
  auto* back = new QPushButton(tr("Bac&k"));
  back->setEnabled(false);
  auto* row = new QHBoxLayout;
  row->addWidget(back);
  const std::pair<QString, QString> ways[] = {{tr("A &quarter of an hour"), "README.md"},
                                              {tr("&Recipes"), "RECIPES.md"},
                                              {tr("&Words and forces"), "FORCES.md"}};
  for (const auto& [text, file] : ways) {
    auto* button = new QPushButton(text);
    row->addWidget(button);
    connect(button, &QPushButton::clicked, this, [this, file = file] { open("examples/learn/" + file); });
  }
  row->addStretch();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(row);
  layout->addWidget(browser_);
  connect(back, &QPushButton::clicked, browser_, &QTextBrowser::backward);
  connect(browser_, &QTextBrowser::backwardAvailable, back, &QWidget::setEnabled);
  connect(browser_, &PageBrowser::recipe_wanted, this, &PagesPanel::recipe_wanted);
  connect(browser_, &PageBrowser::refused, this, &PagesPanel::refused);
}

bool PagesPanel::open(const QString& page) {
  const QFileInfo file("pages:" + page);
  if (file.isFile() && browser_->open(QUrl::fromLocalFile(file.canonicalFilePath()))) return true;
  emit refused(tr("The page %1 is not installed; it comes with Wale's documentation").arg(page));
  return false;
}

}  // namespace sandpaper
