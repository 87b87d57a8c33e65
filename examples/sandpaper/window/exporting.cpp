// What leaves the window in other formats, and the commands of the File menu.
#include <QBuffer>
#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QPrinter>
#include <QPrinterInfo>
#include <QRandomGenerator>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <sstream>
#include <wale/patch_program.hpp>
#include <wale/recording.hpp>

#include "window/exchange.hpp"
#include "document/saving.hpp"

namespace sandpaper {
namespace {

constexpr double most_cells = 65535;

QString told(const wale::Result<>& saved, const QString& file) {
  return saved ? Exchange::tr("Exported %1").arg(file) : QString::fromStdString(wale::in_words(saved.error()));
}

/// What somebody has felt is not thrown away because it could not become the file that was asked for: it is kept beside
/// it as a recording under a name that is free. Says so. From any thread.
QString kept_recording(const QString& part, const QString& file) {
  if (!wale::Recording::open(part.toStdString())) {
    QFile::remove(part);
    return Exchange::tr("Nothing was recorded");
  }
  const QFileInfo wanted(file);
  const QString base = wanted.dir().filePath(wanted.completeBaseName());
  QString kept = base + ".wrec";
  for (int number = 2; QFileInfo::exists(kept); ++number) kept = QString("%1-%2.wrec").arg(base).arg(number);
  if (!QFile::rename(part, kept)) kept = part;
  return Exchange::tr("What was felt is kept in %1").arg(kept);
}

QByteArray bytes_in(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), static_cast<qsizetype>(bytes.size())};
}

std::optional<wale::ThesisMovie> frames_of(const wale::Presentation& shown, const QString& name) {
  for (const wale::Movie& each : shown.movies)
    if (each.name == name.toStdString()) return wale::ThesisMovie{each.frames};
  return std::nullopt;
}

}  // namespace

Exchange::Exchange(const wale::Library& library, const wale::LanguageService& language, Document& document,
                   Feeling& feeling, Canvas& canvas, TextEditor& editor, Question& question, LongWork& work)
    : library_(library),
      language_(language),
      document_(document),
      feeling_(feeling),
      canvas_(canvas),
      editor_(editor),
      question_(question),
      work_(work),
      shown_([] { return std::optional<std::uint64_t>(); }) {
  connect(&work_, &LongWork::ended, this, &Exchange::said);
  connect(&feeling_, &Feeling::recorded, this, &Exchange::keep_recording);
}

void Exchange::add_to(QMenu& menu, QWidget& window) {
  const auto add = [&](QMenu& to, const char* name, const QString& text, const std::function<void()>& act) {
    auto* action = to.addAction(text);
    action->setObjectName(name);
    connect(action, &QAction::triggered, this, act);
  };
  const auto folder_of_file = [this] {
    return document_.file().isEmpty() ? QString() : QFileInfo(document_.file()).path() + "/";
  };
  const auto saved_as = [folder_of_file, &window](const QString& title, const QString& name, const QString& filter) {
    const QString folder = folder_of_file();
    return QFileDialog::getSaveFileName(&window, title, folder + name, filter);
  };
  add(menu, "merge", tr("&Merge another workspace …"), [this, folder_of_file, &window] {
    const QString file =
        QFileDialog::getOpenFileName(&window, tr("Merge a workspace"), folder_of_file(), tr("Wale files (*.wale)"));
    if (!file.isEmpty()) merge(file);
  });
  QMenu& imports = *menu.addMenu(tr("&Import"));
  for (const bool waves : {false, true})
    add(imports, waves ? "import_waves" : "import_files",
        waves ? tr("&Waves of the thesis …") : tr("&Arrays, movies and shuffles of the thesis …"),
        [this, waves, folder_of_file, &window] {
          import_files(
              QFileDialog::getOpenFileNames(&window, tr("Import files of the Sandpaper of 1995"), folder_of_file()),
              waves);
        });
  QMenu& exports = *menu.addMenu(tr("&Export"));
  const auto add_export = [&, saved_as](const char* name, const QString& text, const QString& ending,
                                        const QString& filter, void (Exchange::*to)(const QString&)) {
    add(exports, name, text, [this, saved_as, text, ending, filter, to] {
      QString file = saved_as(QString(text).remove('&').remove(" …"), {}, filter);
      if (file.isEmpty()) return;
      if (!ending.isEmpty() && QFileInfo(file).suffix().isEmpty()) file += ending;
      (this->*to)(file);
    });
  };
  add_export("export_picture", tr("A &picture …"), ".png", tr("Pictures (*.png)"), &Exchange::export_picture);
  add_export("export_preview", tr("A pre&view of the patch …"), ".png", tr("Pictures (*.png *.svg)"),
             &Exchange::export_preview);
  add_export("export_pdf", tr("A P&DF of the workspace …"), ".pdf", tr("PDF (*.pdf)"), &Exchange::export_pdf);
  add_export("export_program", tr("The patch p&rogram …"), ".wpp", tr("Patch programs (*.wpp)"),
             &Exchange::export_program);
  add_export("export_array", tr("The surface as an &array of the thesis …"), ".depth", tr("Arrays (*.depth *.shade)"),
             &Exchange::export_array);
  add_export("record", tr("What is felt &next, recorded …"), ".wrec", tr("Recordings and sound (*.wrec *.wav)"),
             &Exchange::record);
  QMenu& movies = *exports.addMenu(tr("A &movie or a shuffle"));
  connect(&movies, &QMenu::aboutToShow, this, [this, &movies, saved_as] {
    movies.clear();
    const auto offer = [&](const QString& text, const QString& name, const std::function<void(const QString&)>& act) {
      connect(movies.addAction(text), &QAction::triggered, this, [saved_as, text, name, act] {
        if (const QString file = saved_as(text, name, {}); !file.isEmpty()) act(file);
      });
    };
    const auto shown = presentation();
    if (shown)
      for (const wale::Movie& each : shown->movies) {
        const QString name = QString::fromStdString(each.name);
        offer(tr("%1 …").arg(name), name + ".movie", [this, name](const QString& file) { export_movie(file, name); });
        offer(tr("a new order of %1 …").arg(name), name + ".shuffle",
              [this, name](const QString& file) { shuffle_movie(file, name, QRandomGenerator::global()->generate()); });
        for (const wale::Movie& other : shown->movies)
          if (each.name != other.name && wale::shuffle_of({each.frames}, {other.frames})) {
            const QString order = QString::fromStdString(other.name);
            offer(tr("%1, as a shuffle of %2 …").arg(order, name), order + ".shuffle",
                  [this, name, order](const QString& file) { export_shuffle(file, name, order); });
          }
      }
    if (movies.isEmpty()) movies.addAction(tr("the file has no movie"))->setEnabled(false);
  });
  QMenu& printers = *menu.addMenu(tr("Prin&t on"));
  connect(&printers, &QMenu::aboutToShow, this, [this, &printers] {
    printers.clear();
    for (const QString& each : QPrinterInfo::availablePrinterNames())
      connect(printers.addAction(each), &QAction::triggered, this, [this, each] { print(each); });
    if (printers.isEmpty()) printers.addAction(tr("no printer is set up: export a PDF"))->setEnabled(false);
  });
}

std::vector<float> Exchange::parameters_of(const Placed& placed, const wale::Program& program) const {
  std::vector<float> parameters;
  for (const wale::Parameter& each : program.description().parameters)
    parameters.push_back(feeling_.value(placed, each));
  return parameters;
}

void Exchange::export_picture(const QString& file) {
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  if (!canvas_.grab().save(&buffer, "PNG"))
    return emit said(tr("%1 cannot be made: the picture is too large").arg(file));
  emit said(told(save_bytes(file, bytes), file));
}

wale::PlacedProgram Exchange::previewed(const Placed& placed, const wale::Program& program) const {
  return {program, parameters_of(placed, program), felt_size(placed.patch, program), placed.patch.name};
}

void Exchange::export_preview(const QString& file) {
  const auto shown = shown_();
  const wale::Program* program = shown ? feeling_.program(*shown) : nullptr;
  const Placed* placed = shown ? document_.contents().find(*shown) : nullptr;
  if (!program || !placed) return emit said(tr("Choose the patch whose preview is to be exported"));
  const auto draw = [&language = language_, what = previewed(*placed, *program),
                     file](const LongWork::Progress& progress) {
    const auto bytes = language.preview(what.program, what.parameters, what.size, file.toStdString());
    if (!bytes) return told(bytes.error(), file);
    return progress(1) ? told(save_bytes(file, bytes_in(*bytes)), file) : QString();
  };
  if (!work_.begin(tr("Exporting %1").arg(file), draw))
    emit said(tr("Other work is under way: wait for it, or cancel it"));
}

void Exchange::export_program(const QString& file) {
  const auto shown = shown_();
  const wale::Program* program = shown ? feeling_.program(*shown) : nullptr;
  if (!program) return emit said(tr("Choose the patch whose program is to be exported"));
  emit said(told(save_bytes(file, bytes_in(wale::write_patch_program(program->description()))), file));
}

void Exchange::export_array(const QString& file) {
  const auto shown = shown_();
  const wale::Program* program = shown ? feeling_.program(*shown) : nullptr;
  const Placed* placed = shown ? document_.contents().find(*shown) : nullptr;
  if (!program || !placed) return emit said(tr("Choose the patch whose surface is to be exported"));
  const glm::dvec2 size = canvas_.size_of(*placed);
  const auto bank =
      std::make_shared<const wale::Bank>(*program, parameters_of(*placed, *program),
                                         wale::PatchSize{static_cast<float>(size.x), static_cast<float>(size.y), 0});
  question_.ask(
      tr("%1 is %2 by %3 mm. How large is a cell of the array? A pixel of the thesis's screen is 0.37 mm.")
          .arg(QString::fromStdString(placed->patch.name))
          .arg(1000 * size.x)
          .arg(1000 * size.y),
      {{tr("&cell"), tr("mm"), 1000 * wale::thesis_cell, 0.001, 1000, 3}}, tr("Export"),
      [this, bank, size, file](const std::vector<double>& answers) {
        const double cell = answers[0] / 1000, columns = std::max(1.0, std::round(size.x / cell)),
                     rows = std::max(1.0, std::round(size.y / cell));
        if (columns > most_cells || rows > most_cells)
          return emit said(tr("An array has at most 65535 cells in each direction: take larger ones"));
        const wale::ThesisSampling sampling{
            .width = static_cast<std::uint16_t>(columns), .height = static_cast<std::uint16_t>(rows), .cell = cell};
        const bool begun =
            work_.begin(tr("Exporting %1").arg(file), [bank, sampling, file](const LongWork::Progress& progress) {
              const auto array =
                  file.endsWith(".shade") ? wale::shading_of(*bank, sampling) : wale::surface_of(*bank, sampling);
              if (!array) return QString::fromStdString(wale::in_words(array.error()));
              const auto bytes = wale::write_thesis_array(*array);
              if (!bytes) return QString::fromStdString(wale::in_words(bytes.error()));
              return progress(1) ? told(save_bytes(file, bytes_in(*bytes)), file) : QString();
            });
        if (!begun) emit said(tr("Other work is under way: wait for it, or cancel it"));
      });
}

std::optional<wale::Presentation> Exchange::presentation() {
  editor_.commit();
  auto shown = library_.presentation(document_.text(),
                                     document_.file().isEmpty() ? "untitled.wale" : document_.file().toStdString());
  if (shown) return *std::move(shown);
  emit refused(shown.error());
  return std::nullopt;
}

void Exchange::export_movie(const QString& file, const QString& name) {
  const auto shown = presentation();
  const auto movie = shown ? frames_of(*shown, name) : std::nullopt;
  if (!movie) return;
  const auto text = wale::write_thesis_movie(*movie);
  if (!text) return emit refused(text.error());
  emit said(told(save_bytes(file, QByteArray::fromStdString(*text)), file));
}

bool Exchange::export_shuffle(const QString& file, const QString& name, const QString& other) {
  const auto shown = presentation();
  const auto movie = shown ? frames_of(*shown, name) : std::nullopt;
  const auto shuffled = shown ? frames_of(*shown, other) : std::nullopt;
  if (!movie || !shuffled) return false;
  const auto refuse = [this](const wale::Error& error) {
    emit refused(error);
    return false;
  };
  auto shuffle = wale::shuffle_of(*movie, *shuffled);
  if (!shuffle) return refuse(shuffle.error());
  const QDateTime now = QDateTime::currentDateTime();
  shuffle->movie = name.toStdString();
  shuffle->date = now.toString("yyyy-MM-dd").toStdString();
  shuffle->time = now.toString("HH:mm").toStdString();
  const auto text = wale::write_thesis_shuffle(*shuffle);
  if (!text) return refuse(text.error());
  const auto saved = save_bytes(file, QByteArray::fromStdString(*text));
  emit said(told(saved, file));
  return saved.has_value();
}

void Exchange::shuffle_movie(const QString& file, const QString& name, std::uint32_t seed) {
  if (!is_ready()) return;
  const auto shown = presentation();
  auto movie = shown ? frames_of(*shown, name) : std::nullopt;
  if (!movie) return;
  std::mt19937 random(seed);
  std::vector<std::string>& frames = movie->workspaces;
  for (std::size_t i = frames.size(); i > 1; --i)
    std::swap(frames[i - 1], frames[random() % i]);  // the same on every system
  Contents next = document_.contents();
  const std::string declared = next.new_declared_name(name.toStdString() + "_shuffle");
  std::string text = "/// A shuffle of " + name.toStdString() + ", seed " + std::to_string(seed) + ".\nmovie " +
                     declared + " { frames ";
  for (std::size_t i = 0; i < frames.size(); ++i) text += (i ? ", " : "") + frames[i];
  while (next.tail.ends_with("\n")) next.tail.pop_back();
  next.tail += "\n\n" + text + " }\n";
  if (!take(next, tr("Shuffle %1").arg(name))) return;
  // An order that is in no file was not drawn.
  if (!export_shuffle(file, name, QString::fromStdString(declared))) document_.undo_stack().undo();
}

WorkspacePage Exchange::page() const {
  WorkspacePage page{
      .name = document_.contents().name, .diameter = feeling_.profile().workspace_diameter, .patches = {}};
  for (const PlacedRef& each : document_.contents().placed) {
    if (!each->is_laid_out()) continue;
    PagePatch patch{.placed = each, .size = canvas_.size_of(*each), .program = {}, .parameters = {}};
    if (const wale::Program* program = feeling_.program(each->id)) {
      patch.program = *program;
      patch.parameters = parameters_of(*each, *program);
    }
    page.patches.push_back(std::move(patch));
  }
  return page;
}

void Exchange::export_pdf(const QString& file) {
  const bool begun =
      work_.begin(tr("Exporting %1").arg(file), [page = page(), file](const LongWork::Progress& progress) {
        const auto bytes = pdf_of(page, progress);
        return bytes && progress(1) ? told(save_bytes(file, *bytes), file) : QString();
      });
  if (!begun) emit said(tr("Other work is under way: wait for it, or cancel it"));
}

void Exchange::print(const QString& name) {
  const bool begun =
      work_.begin(tr("Printing on %1").arg(name), [page = page(), name](const LongWork::Progress& progress) {
        QPrinter printer(QPrinterInfo::printerInfo(name));
        return print_pages(printer, page, progress) ? tr("Printed on %1").arg(name) : tr("%1 does not print").arg(name);
      });
  if (!begun) emit said(tr("Other work is under way: wait for it, or cancel it"));
}

void Exchange::record(const QString& file) {
  const QString part = file + ".part";
  QFile::remove(part);
  // Whether a file can be written there is said now, and not after somebody has felt something for it.
  QFile tried(part);
  if (!tried.open(QIODevice::WriteOnly))
    return emit said(tr("%1: cannot be written: %2").arg(file, tried.errorString()));
  tried.remove();
  recording_ = file;
  feeling_.record(part);
  emit said(tr("The next time that force is on is recorded, until it is off: Ctrl+Space begins"));
}

void Exchange::keep_recording(const QString& part, const QString& problem) {
  const QString file = std::exchange(recording_, {});
  if (file.isEmpty()) return;
  if (!problem.isEmpty())
    return emit said(tr("%1 is not whole: %2. %3").arg(file, problem, kept_recording(part, file)));
  if (!file.endsWith(".wav")) {
    if (std::rename(QFile::encodeName(part).constData(), QFile::encodeName(file).constData()) == 0)
      return emit said(tr("Recorded %1").arg(file));
    const int error = errno;
    return emit said(tr("%1 cannot be written: %2. %3").arg(file, qt_error_string(error), kept_recording(part, file)));
  }
  const bool begun = work_.begin(tr("Writing %1").arg(file), [part, file](const LongWork::Progress& progress) {
    const auto saved = [&]() -> wale::Result<> {
      const auto recording = wale::Recording::open(part.toStdString());
      if (!recording) return recording.error();
      std::ostringstream out;
      if (const auto sound = wale::write_wav(out, *recording); !sound) return sound.error();
      return progress(0.9) ? save_bytes(file, QByteArray::fromStdString(out.str())) : wale::Result<>();
    }();
    if (!saved) return told(saved, file) + ". " + kept_recording(part, file);
    QFile::remove(part);
    return told(saved, file);
  });
  if (!begun)
    emit said(tr("Other work was under way, so %1 is not written. %2").arg(file, kept_recording(part, file)));
}

}  // namespace sandpaper
