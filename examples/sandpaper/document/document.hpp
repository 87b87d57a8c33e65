#pragma once

#include <QObject>
#include <QUndoStack>
#include <functional>
#include <set>
#include <wale/language_service.hpp>

#include "document/placed.hpp"

namespace sandpaper {

/// The file that is open: its contents, what has been undone, and which patches are chosen. In the window's thread.
class Document : public QObject {
  Q_OBJECT

 public:
  explicit Document(const wale::LanguageService& language, QObject* parent = nullptr);

  ~Document() override { undo_.blockSignals(true); }  // it says that it becomes clean when it ends

  const Contents& contents() const { return contents_; }
  QUndoStack& undo_stack() { return undo_; }

  /// The path of the file; empty before the first save.
  const QString& file() const { return file_; }
  /// "kitchen.wale", or "untitled".
  QString title() const;

  /// Begins an empty workspace.
  void make_new();
  /// Opens a Wale file, and of several workspaces the one of that name, by default the first; a file without one gets
  /// an empty workspace. The errors in its text are problems, not errors of this call. Errors: `unreadable_file`, and
  /// those of a file that is no text.
  wale::Result<> open(const QString& file, const QString& workspace = {});
  /// Writes the file: a new one beside it first, which then takes its place. Error: `unwritable_file`.
  wale::Result<> save(const QString& file);
  /// Takes over the text of a file that was not saved, from the autosave.
  void restore(const QString& file, const std::string& text);

  /// The whole file as it would be saved: what has not changed as it was written, to the byte, what is new in the
  /// standard style.
  std::string text() const;
  /// The same of other contents.
  std::string text_of(const Contents& contents) const;
  /// Replaces the whole file by a text that someone has typed, as one step of undo. A text with errors becomes a draft:
  /// it is what is saved, while the contents stay those of the last text without errors.
  void set_text(const std::string& text, const QString& what);
  /// Whether closing now would lose something.
  /// Whether the file's bytes are others than this document has read or written last: another program has changed it.
  /// A file that is gone was not changed.
  bool is_changed_elsewhere() const;
  /// Takes over what another program has written, as one step of undo.
  wale::Result<> take_over();
  bool is_modified() const { return draft_ ? draft_ != saved_draft_ : !undo_.isClean(); }
  /// Whether there is a draft. Then nothing else may change the contents.
  bool is_stale() const { return draft_.has_value(); }
  /// The workspaces that the file declares, and the one that is laid out.
  QStringList workspaces() const;

  /// What the last check of a typed or opened text found.
  const std::vector<wale::Problem>& problems() const { return problems_; }

  /// What a hand cannot tell on the workspace, found for a text of the document.
  struct Advice {
    std::string text;
    std::vector<wale::Problem> problems;
  };
  const Advice& advice() const { return advice_; }
  void set_advice(Advice advice);

  /// Lays out another workspace of the file, which is no step of undo. False if there is none of that name.
  bool show_workspace(const QString& name);

  // Edits, which do nothing while there is a draft but emit `refused`; each is one step of undo, named `what` ("Move
  // oak"). Steps of the same `merge`, other than 0, that follow one another become one.
  void change(const QString& what, Contents next, int merge = 0);
  void change_placed(const QString& what, const std::set<std::uint64_t>& ids,
                     const std::function<void(Placed&)>& edit, int merge = 0);
  /// Gives a patch's material an argument, as a slider does: `denim(roughness: 0.3)`. A material that is no name or
  /// call, as `0.5 oak + 0.5 denim`, gets a name in the file first. `si` is the value, `written` the same with its
  /// unit.
  void set_argument(std::uint64_t id, const std::string& name, float si, const std::string& written, int merge);
  /// Puts patches of materials in front of all others and returns their ids.
  std::vector<std::uint64_t> add(const QString& what, std::vector<wale::LaidOutPatch> patches);
  void remove(const std::set<std::uint64_t>& ids);
  /// Moves patches to the front or the back of all others (`by` far), or by one place.
  void raise(const std::set<std::uint64_t>& ids, int by);

  const std::set<std::uint64_t>& chosen() const { return chosen_; }
  void choose(std::set<std::uint64_t> ids);

 signals:
  void contents_changed();
  void chosen_changed();
  void file_changed();
  void unloading();  ///< another file, or none, is about to take the place of this one
  void loaded();     ///< it has
  void problems_changed();
  void refused(const QString& why);

 private:
  friend class Change;
  void take(Contents contents);
  void load(const std::string& text, const QString& workspace);
  Contents read(const std::string& text, const QString& workspace);

  const wale::LanguageService& language_;
  QUndoStack undo_;
  Contents contents_;
  std::optional<std::string> draft_, saved_draft_;
  std::string on_disk_;  // what was read or written last
  QString file_;
  QStringList workspaces_;
  std::vector<wale::Problem> problems_;
  Advice advice_;
  std::set<std::uint64_t> chosen_;
  std::uint64_t next_id_ = 1;
};

}  // namespace sandpaper
