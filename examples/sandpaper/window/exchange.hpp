#pragma once

#include <QMenu>
#include <QObject>
#include <QStringList>
#include <optional>
#include <wale/library.hpp>
#include <wale/thesis_files.hpp>

#include "canvas/canvas.hpp"
#include "canvas/page.hpp"
#include "editor/text_editor.hpp"
#include "panels/preview_panel.hpp"
#include "window/long_work.hpp"
#include "window/question.hpp"

namespace sandpaper {

/// Takes what other programs and other workspaces made into the document, and gives it away in other formats. What
/// fails is said (`said`), and leaves neither half a file nor a changed document. In the window's thread.
class Exchange : public QObject {
  Q_OBJECT

 public:
  /// All must outlive it; `question` and `work` are lines of the window.
  Exchange(const wale::Library& library, const wale::LanguageService& language, Document& document, Feeling& feeling,
           Canvas& canvas, TextEditor& editor, Question& question, LongWork& work);

  /// The commands with file dialogs, in the File menu.
  void add_to(QMenu& menu, QWidget& window);
  /// What is felt of a patch.
  wale::PlacedProgram previewed(const Placed& placed, const wale::Program& program) const;
  /// The patch whose preview, program and surface are exported: chosen or touched.
  void set_shown(const std::function<std::optional<std::uint64_t>()>& shown) { shown_ = shown; }

  /// Arrays, movies and shuffles of the thesis's Sandpaper, or waves. The figures that arrays do not say are asked for.
  void import_files(QStringList files, bool waves = false);
  /// Puts the first workspace of a Wale file, and all that it declares, into the open one: one step of undo. Names that
  /// are taken get new ones.
  /// Asks which workspace of a file is to be merged, if it has several.
  void merge(const QString& file);

  void export_picture(const QString& file);
  /// The page of `wale preview` of the shown patch, in the format that the ending says.
  void export_preview(const QString& file);
  void export_program(const QString& file);
  /// The relief of the shown patch; its colours for a name that ends in ".shade". Asks how wide a cell is.
  void export_array(const QString& file);
  void export_movie(const QString& file, const QString& movie);
  /// Writes as which shuffle of a movie another one was shown. False if it is not written, which is said.
  bool export_shuffle(const QString& file, const QString& movie, const QString& shuffled);
  /// Declares a new order of a movie's frames, drawn by `seed`, and writes it.
  void shuffle_movie(const QString& file, const QString& movie, std::uint32_t seed);
  void export_pdf(const QString& file);
  void print(const QString& printer);
  /// Records the next time that force is on, as a recording (.wrec) or as sound (.wav).
  void record(const QString& file);

 signals:
  void said(const QString& words);
  void refused(const wale::Error& error);

 private:
  void merge(const QString& path, std::string text, const wale::Presentation& shown, const std::string& wanted);
  bool is_ready();
  /// Takes a text over as one step of undo if it has no errors.
  bool take(const Contents& next, const QString& what);
  void import_array(const QString& path, const wale::ThesisArray& array, bool wave, const QStringList& others);
  bool put(const wale::ThesisInWale& made, bool as_patch);
  std::optional<wale::Presentation> presentation();
  WorkspacePage page() const;
  std::vector<float> parameters_of(const Placed& placed, const wale::Program& program) const;
  void keep_recording(const QString& part, const QString& problem);

  const wale::Library& library_;
  const wale::LanguageService& language_;
  Document& document_;
  Feeling& feeling_;
  Canvas& canvas_;
  TextEditor& editor_;
  Question& question_;
  LongWork& work_;
  std::function<std::optional<std::uint64_t>()> shown_;
  QString recording_;  // what is recorded becomes this file
};

}  // namespace sandpaper
