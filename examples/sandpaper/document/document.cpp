#include "document/document.hpp"

#include <QFile>
#include <QFileInfo>
#include <QUndoCommand>
#include <algorithm>
#include <utility>

#include "document/counted.hpp"
#include "document/saving.hpp"

namespace sandpaper {

/// One step: all contents before and after it. They share the patches that did not change.
class Change : public QUndoCommand {
 public:
  Change(Document& document, const QString& what, Contents next, int merge)
      : QUndoCommand(what), document_(document), before_(document.contents_), after_(std::move(next)), merge_(merge) {}

  void undo() override { document_.take(before_); }
  void redo() override { document_.take(after_); }
  int id() const override { return merge_ == 0 ? -1 : merge_; }
  bool mergeWith(const QUndoCommand* later) override {
    after_ = static_cast<const Change*>(later)->after_;
    return true;
  }

 private:
  Document& document_;
  Contents before_, after_;
  int merge_;
};

namespace {

constexpr int most_steps = 1000;
constexpr qint64 largest_text = 4 << 20;

Contents empty_workspace() { return {.name = "table", .head = "wale 1\n\n"}; }

bool has_errors(const std::vector<wale::Problem>& problems) {
  return std::ranges::any_of(problems, [](const wale::Problem& each) {
    return wale::severity_of(each.error.code) == wale::Severity::error;
  });
}

wale::Error unreadable(const QFile& file) {
  return {.code = wale::Code::unreadable_file,
          .sentence = file.errorString().toStdString(),
          .place = {.name = file.fileName().toStdString()}};
}

wale::Error no_text(const QString& path) {
  return {.code = wale::Code::unreadable_file,
          .sentence = "this is no text in UTF-8, as a Wale file is",
          .mend = "drop a picture or a file of the thesis onto a workspace, or import it",
          .place = {.name = path.toStdString()}};
}

}  // namespace

Document::Document(const wale::LanguageService& language, QObject* parent)
    : QObject(parent), language_(language), contents_(empty_workspace()) {
  undo_.setUndoLimit(most_steps);
}

QString Document::title() const { return file_.isEmpty() ? tr("untitled") : QFileInfo(file_).fileName(); }

void Document::make_new() {
  emit unloading();
  file_.clear();
  workspaces_.clear();
  problems_.clear();
  chosen_.clear();
  undo_.clear();
  draft_.reset();
  take(empty_workspace());
  emit loaded();
  emit file_changed();
  emit problems_changed();
}

Contents Document::read(const std::string& text, const QString& workspace) {
  const wale::CheckedText checked =
      language_.check(text, {.name = file_.isEmpty() ? "untitled.wale" : file_.toStdString()});
  problems_ = checked.problems;
  workspaces_.clear();
  for (const wale::Layout& each : checked.layouts) workspaces_ << QString::fromStdString(each.name);
  const auto wanted = std::ranges::find(checked.layouts, workspace.toStdString(), &wale::Layout::name);
  if (checked.layouts.empty()) {
    Contents contents = empty_workspace();
    contents.head = text + (text.empty() || text.ends_with("\n") ? "\n" : "\n\n");
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) contents.head = "wale 1\n\n";
    contents.file = file_.toStdString();
    contents.name = file_.isEmpty() ? "table" : contents.new_name(QFileInfo(file_).completeBaseName().toStdString());
    return contents;
  }
  const wale::Layout& layout = wanted == checked.layouts.end() ? checked.layouts.front() : *wanted;
  Contents contents{.name = layout.name,
                    .documentation = layout.documentation,
                    .trailing = layout.trailing,
                    .head = text.substr(0, layout.begin),
                    .tail = text.substr(std::min(layout.end, text.size())),
                    .written = layout.written,
                    .file = file_.toStdString()};
  // A patch that has the same name as before is the same patch.
  for (const wale::LaidOutPatch& each : layout.patches) {
    Placed placed{.patch = each, .compiled_from = each.made_of};
    const auto before = std::ranges::find_if(contents_.placed, [&](const PlacedRef& old) {
      return !each.name.empty() && old->patch.name == each.name;
    });
    if (before != contents_.placed.end()) {
      placed.id = (*before)->id, placed.locked = (*before)->locked;
      if ((*before)->patch.made_of == each.made_of)
        placed.compiled_from = (*before)->compiled_from, placed.sliders = (*before)->sliders;
    } else {
      placed.id = next_id_++;
    }
    contents.placed.push_back(std::make_shared<const Placed>(std::move(placed)));
  }
  return contents;
}

wale::Result<> Document::open(const QString& path, const QString& workspace) {
  QFile file(path);
  if (!QFileInfo(path).isFile() || !file.open(QIODevice::ReadOnly)) {
    if (QFileInfo::exists(path) && !QFileInfo(path).isFile())
      return wale::Error{.code = wale::Code::unreadable_file,
                         .sentence = "this is no regular file",
                         .place = {.name = path.toStdString()}};
    if (file.error() == QFile::NoError) file.open(QIODevice::ReadOnly);
    return unreadable(file);
  }
  if (file.size() > largest_text)
    return wale::Error{.code = wale::Code::unreadable_file,
                       .sentence = "a Wale file has at most 4 MB",
                       .place = {.name = path.toStdString()}};
  const std::string text = file.readAll().toStdString();
  if (file.error() != QFile::NoError) return unreadable(file);
  if (const auto bytes = QByteArray::fromStdString(text); !bytes.isValidUtf8() || bytes.contains('\0')) return no_text(path);
  emit unloading();
  on_disk_ = text;
  file_ = QFileInfo(path).absoluteFilePath();
  load(text, workspace);
  emit loaded();
  emit file_changed();
  emit problems_changed();
  emit chosen_changed();
  return {};
}

void Document::load(const std::string& text, const QString& workspace) {
  contents_ = {};
  chosen_.clear();
  undo_.clear();
  draft_.reset();
  Contents contents = read(text, workspace);
  if (has_errors(problems_)) draft_ = text;
  saved_draft_ = draft_;
  take(std::move(contents));
}

void Document::restore(const QString& file, const std::string& text) {
  emit unloading();
  file_ = file;
  QFile kept(file);
  on_disk_ = kept.open(QIODevice::ReadOnly) ? kept.readAll().toStdString() : std::string();
  load(text, {});
  saved_draft_.reset();
  undo_.resetClean();
  emit loaded();
  emit file_changed();
  emit problems_changed();
}

bool Document::is_changed_elsewhere() const {
  QFile file(file_);
  if (file_.isEmpty() || !file.open(QIODevice::ReadOnly)) return false;
  return file.size() > largest_text || file.readAll().toStdString() != on_disk_;
}

wale::Result<> Document::take_over() {
  QFile file(file_);
  if (!file.open(QIODevice::ReadOnly) || file.size() > largest_text) return unreadable(file);
  const QByteArray bytes = file.readAll();
  if (!bytes.isValidUtf8() || bytes.contains('\0')) return no_text(file_);
  on_disk_ = bytes.toStdString();
  set_text(on_disk_, tr("Take over what another program wrote"));
  if (draft_) saved_draft_ = draft_;
  else undo_.setClean();
  emit file_changed();
  return {};
}

wale::Result<> Document::save(const QString& path) {
  const std::string written = text();
  if (const auto saved = save_bytes(path, QByteArray::fromStdString(written)); !saved) return saved;
  on_disk_ = written;
  file_ = QFileInfo(path).absoluteFilePath();
  undo_.setClean();
  saved_draft_ = draft_;
  if (contents_.file != file_.toStdString()) {
    Contents moved = contents_;
    moved.file = file_.toStdString();
    take(std::move(moved));
  }
  emit file_changed();
  return {};
}

std::string Document::text() const {
  return draft_ ? *draft_ : text_of(contents_);
}

std::string Document::text_of(const Contents& contents) const {
  std::string text = contents.head + wale::layout_text(contents.layout()) + contents.tail;
  if (!contents.written && !text.ends_with("\n")) text += "\n";
  return text;
}

void Document::set_text(const std::string& text, const QString& what) {
  const bool was_stale = is_stale();
  Contents next = read(text, QString::fromStdString(contents_.name));
  if (has_errors(problems_)) {
    draft_ = text;
  } else {
    draft_.reset();
    change(what, std::move(next));
  }
  emit problems_changed();
  if (was_stale || is_stale()) emit file_changed();
}

void Document::set_advice(Advice advice) {
  advice_ = std::move(advice);
  emit problems_changed();
}

bool Document::show_workspace(const QString& name) {
  if (is_stale() || !workspaces_.contains(name)) return false;
  const Contents before = contents_;
  Contents next = read(text(), name);
  if (next.name != name.toStdString()) return false;
  // Patches of different workspaces are different, also where they have the same names.
  for (PlacedRef& each : next.placed)
    if (before.find(each->id)) {
      Placed other = *each;
      other.id = next_id_++;
      each = std::make_shared<const Placed>(std::move(other));
    }
  take(std::move(next));  // nothing of the file has changed; an undo goes back to where its edit was
  return true;
}

QStringList Document::workspaces() const { return workspaces_; }

void Document::change(const QString& what, Contents next, int merge) {
  if (is_stale()) {
    emit refused(tr("The text has errors: mend them first, then this can be done"));
    return;
  }
  undo_.push(new Change(*this, what, std::move(next), merge));
}

void Document::change_placed(const QString& what, const std::set<std::uint64_t>& ids,
                             const std::function<void(Placed&)>& edit, int merge) {
  if (ids.empty()) return;
  Contents next = contents_;
  for (PlacedRef& each : next.placed)
    if (ids.contains(each->id) && each->is_changeable()) {
      Placed changed = *each;
      edit(changed);
      each = std::make_shared<const Placed>(std::move(changed));
    }
  change(what, std::move(next), merge);
}

void Document::set_argument(std::uint64_t id, const std::string& name, float si, const std::string& written,
                            int merge) {
  const Placed* placed = contents_.find(id);
  if (!placed || !placed->is_changeable()) return;
  const QString what = tr("Set %1").arg(QString::fromStdString(name));
  if (const auto made_of = with_argument(placed->patch.made_of, name, written)) {
    change_placed(what, {id}, [&](Placed& each) {
      each.sliders[name] = si;
      each.patch.made_of = *made_of;
    }, merge);
    return;
  }
  Contents next = contents_;
  const std::string text = next.surroundings();
  std::string own = placed->patch.name + "_material";
  for (int i = 2; text.find("material " + own) != std::string::npos; ++i)
    own = placed->patch.name + "_material_" + std::to_string(i);
  next.head += "material " + own + " = " + placed->patch.made_of + "\n\n";
  for (PlacedRef& each : next.placed)
    if (each->id == id) {
      Placed changed = *each;
      changed.compiled_from = own;
      changed.sliders[name] = si;
      changed.patch.made_of = own + "(" + name + ": " + written + ")";
      each = std::make_shared<const Placed>(std::move(changed));
    }
  change(what, std::move(next), 0);
}

std::vector<std::uint64_t> Document::add(const QString& what, std::vector<wale::LaidOutPatch> patches) {
  Contents next = contents_;
  std::vector<std::uint64_t> ids;
  for (wale::LaidOutPatch& each : patches) {
    each.name = next.new_name(each.name.empty() ? each.made_of : each.name);
    ids.push_back(next_id_);
    Placed placed{.id = next_id_++, .patch = std::move(each)};
    placed.compiled_from = placed.patch.made_of;
    next.placed.push_back(std::make_shared<const Placed>(std::move(placed)));
  }
  change(what, std::move(next));
  return ids;
}

void Document::remove(const std::set<std::uint64_t>& ids) {
  Contents next = contents_;
  std::erase_if(next.placed, [&](const PlacedRef& each) {
    return ids.contains(each->id) && each->is_changeable() && !each->locked;
  });
  if (next.placed.size() == contents_.placed.size()) return;
  change(tr("Delete %1").arg(counted(static_cast<qsizetype>(contents_.placed.size() - next.placed.size()), "patch", "patches")),
         std::move(next));
}

void Document::raise(const std::set<std::uint64_t>& ids, int by) {
  if (ids.empty()) return;
  Contents next = contents_;
  auto& all = next.placed;
  const auto is_raised = [&](const PlacedRef& each) { return ids.contains(each->id) && each->is_changeable(); };
  const int far = static_cast<int>(all.size());
  if (by >= far) std::ranges::stable_partition(all, [&](const PlacedRef& each) { return !is_raised(each); });
  else if (by <= -far) std::ranges::stable_partition(all, is_raised);
  else if (by > 0)
    for (std::size_t i = all.size(); i-- > 1;) {
      if (is_raised(all[i - 1]) && !is_raised(all[i])) std::swap(all[i - 1], all[i]);
    }
  else
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (is_raised(all[i + 1]) && !is_raised(all[i])) std::swap(all[i + 1], all[i]);
  if (next.placed == contents_.placed) return;
  change(by > 0 ? tr("Raise") : tr("Lower"), std::move(next));
}

void Document::choose(std::set<std::uint64_t> ids) {
  if (ids == chosen_) return;
  chosen_ = std::move(ids);
  emit chosen_changed();
}

void Document::take(Contents contents) {
  contents_ = std::move(contents);
  std::set<std::uint64_t> still;
  for (const PlacedRef& each : contents_.placed)
    if (chosen_.contains(each->id)) still.insert(each->id);
  const bool fewer = still.size() != chosen_.size();
  chosen_ = std::move(still);
  emit contents_changed();
  if (fewer) emit chosen_changed();
}

}  // namespace sandpaper
