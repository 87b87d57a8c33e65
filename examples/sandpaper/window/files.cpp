// Files: opening, saving, exporting, and what is dropped onto the canvas.
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QSettings>
#include <algorithm>

#include "document/counted.hpp"
#include "document/recipe.hpp"
#include "window/main_window.hpp"

namespace sandpaper {
namespace {

const char* const wale_files = QT_TRANSLATE_NOOP("sandpaper", "Wale files (*.wale)");
const QStringList of_1995 = {"depth", "shade", "wave", "movie", "shuffle"};  // names of the thesis's files end so
const QStringList of_pictures = {"png", "jpg", "jpeg", "tif", "tiff", "bmp", "exr", "hdr", "webp", "gif"};
constexpr double beside = 0.01;                                              // m, from one dropped picture to the next
const char* const trusted_key = "felt_when_opened";

}  // namespace

bool MainWindow::save() {
  editor_->commit();
  if (document_.file().isEmpty()) return save_as();
  if (document_.is_changed_elsewhere()) {
    announcement_->offer(
        tr("%1 was changed by another program, and is not saved: that would be lost. Save as (Ctrl+Shift+S) keeps both.")
            .arg(document_.title()),
        tr("Save over it"), [this] { write(document_.file()); });
    return false;
  }
  return write(document_.file());
}

bool MainWindow::write(const QString& file) {
  if (const auto saved = document_.save(file); !saved) {
    announce(saved.error());
    return false;
  }
  announcement_->say(tr("Saved %1").arg(document_.file()));
  return true;
}

void MainWindow::watch() {
  if (!watched_.files().isEmpty()) watched_.removePaths(watched_.files());
  if (!document_.file().isEmpty()) watched_.addPath(document_.file());
}

void MainWindow::follow_file() {
  watch();  // a program that writes a new file in its place has ended the watch
  if (!document_.is_changed_elsewhere()) return;
  editor_->commit();
  if (document_.is_modified())
    return announcement_->say(
        tr("%1 was changed by another program, too. Here it stays as it is; saving will ask.").arg(document_.title()));
  if (const auto taken = document_.take_over(); !taken) return announce(taken.error());
  announcement_->say(tr("%1 was changed by another program, and is shown as it is now.").arg(document_.title()));
}

bool MainWindow::save_as() {
  QString file = QFileDialog::getSaveFileName(this, tr("Save the workspace"), document_.file(), tr(wale_files));
  if (file.isEmpty()) return false;
  if (!file.endsWith(".wale")) file += ".wale";
  return write(file);
}

bool MainWindow::is_picture(const QString& file) { return of_pictures.contains(QFileInfo(file).suffix().toLower()); }

void MainWindow::when_saved(const QString& what, const std::function<void()>& then) {
  if (!document_.is_modified()) return then();
  announcement_->offer(
      tr("%1 has changes that are not saved. Save it first (Ctrl+S), or %2 without them.").arg(document_.title(), what),
      tr("Discard the changes and %1").arg(what), then);
}

void MainWindow::open_asked() {
  when_saved(tr("open another file"), [this] {
    const QString file =
        QFileDialog::getOpenFileName(this, tr("Open a workspace"), QFileInfo(document_.file()).path(), tr(wale_files));
    if (!file.isEmpty()) open(file);
  });
}

void MainWindow::feel_if_trusted() {
  const bool is_trusted = QSettings().value(trusted_key).toStringList().contains(document_.file());
  if (QAction* trust = action("feel_when_opened")) trust->setChecked(is_trusted);
  if (is_trusted) feeling_.set_on(true);
}

void MainWindow::place_material(const QString& spelling, glm::dvec2 at) {
  wale::LaidOutPatch patch{.made_of = spelling.toStdString(), .at = at, .size = glm::dvec2(0.04, 0.04)};
  patch.name = spelling.section('.', -1).toStdString();
  const auto ids = document_.add(tr("Place %1").arg(spelling), {std::move(patch)});
  document_.choose({ids.begin(), ids.end()});
  canvas_->setFocus();
}

void MainWindow::place_recipe(const QString& recipe, glm::dvec2 at) {
  editor_->commit();
  if (document_.is_stale())
    return announcement_->say(tr("The text has errors: mend them first, then this can be placed"));
  const WithRecipe placed = with_recipe(language_, document_.contents(), recipe.toStdString(), at);
  const std::string text = document_.text_of(placed.contents);
  const std::string name = document_.file().isEmpty() ? "untitled.wale" : document_.file().toStdString();
  for (const wale::Problem& each : language_.check(text, {.name = name}).problems)
    if (wale::severity_of(each.error.code) == wale::Severity::error)
      return announcement_->say(
          tr("This cannot be placed here: %1").arg(QString::fromStdString(wale::in_words(each.error))));
  document_.set_text(text, tr("Place a recipe"));
  std::set<std::uint64_t> ids;
  for (const PlacedRef& each : document_.contents().placed)
    if (std::ranges::count(placed.patches, each->patch.name) > 0) ids.insert(each->id);
  document_.choose(ids);
  canvas_->setFocus();
}

void MainWindow::take_dropped(const QStringList& files, glm::dvec2 at) {
  editor_->commit();
  if (document_.is_stale())
    return announcement_->say(tr("The text has errors: mend them first, then this can be placed"));
  QStringList of_thesis, pictures;
  for (const QString& each : files)
    (of_1995.contains(QFileInfo(each).suffix().toLower()) ? of_thesis : pictures) << each;
  if (!of_thesis.isEmpty()) exchange_->import_files(of_thesis);
  if (pictures.isEmpty()) return;
  if (!of_thesis.isEmpty()) return announcement_->say(tr("Drop the pictures again, without the other files"));
  QStringList names;
  for (const QString& each : pictures) names << QFileInfo(each).fileName();
  // No picture is opened here: only the compiler's decoder, which has no rights, reads a stranger's file.
  question_->ask(
      pictures.size() == 1 ? tr("%1\nHow many millimetres is one of its pixels?").arg(names.front())
                           : tr("%1\nHow many millimetres is one of their pixels?").arg(names.join(", ")),
      {{tr("&pixel"), tr("mm"), 0.2, 0.001, 10, 3}}, pictures.size() == 1 ? tr("Place it") : tr("Place them"),
      [this, pictures, at](const std::vector<double>& answers) { place_pictures(pictures, at, answers.front()); });
}

void MainWindow::place_pictures(const QStringList& files, glm::dvec2 at, double scale) {
  editor_->commit();
  if (document_.is_stale())
    return announcement_->say(tr("The text has errors: mend them first, then this can be placed"));
  document_.undo_stack().beginMacro(files.size() == 1
                                        ? tr("Import %1").arg(QFileInfo(files.front()).fileName())
                                        : tr("Import %1").arg(counted(files.size(), "picture", "pictures")));
  std::set<std::uint64_t> ids;
  for (const QString& each : files) {
    ids.insert(place_picture(each, at, scale));
    at += glm::dvec2(beside, -beside);
  }
  document_.undo_stack().endMacro();
  document_.choose(ids);
}

std::uint64_t MainWindow::place_picture(const QString& path, glm::dvec2 at, double scale) {
  const QString file =
      document_.file().isEmpty() ? path : QDir(QFileInfo(document_.file()).path()).relativeFilePath(path);
  QString quoted = file;
  quoted.replace('\\', "\\\\").replace('"', "\\\"");
  Contents next = document_.contents();
  const QString name = QString::fromStdString(next.new_declared_name(QFileInfo(path).completeBaseName().toStdString()));
  next.head += QString("material %1 {\n  physical {\n    let picture = relief(\"%2\", scale: %3 mm/px, height: 1 mm)\n"
                       "    height surface = picture(hand)\n    force = lateral(surface, amplitude: 1 N)\n"
                       "    show relief(surface)\n  }\n}\n\n")
                   .arg(name, quoted, QString::number(scale, 'g', 5))
                   .toStdString();
  document_.change(tr("Import %1").arg(name), std::move(next));
  wale::LaidOutPatch patch{.name = name.toStdString() + "_patch", .made_of = name.toStdString(), .at = at};
  const auto ids = document_.add(tr("Place %1").arg(name), {std::move(patch)});
  return ids.front();
}

}  // namespace sandpaper
