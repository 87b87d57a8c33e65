// What comes from other files into the document.
#include <QFile>
#include <QFileInfo>
#include <algorithm>
#include <cmath>

#include "document/recipe.hpp"
#include "window/exchange.hpp"
#include "document/saving.hpp"

namespace sandpaper {
namespace {

constexpr qint64 largest_file = 1 << 28, largest_text = 4 << 20;  // bytes

wale::Result<QByteArray> bytes_of(const QString& path, qint64 largest) {
  QFile file(path);
  const auto unreadable = [&](const QString& why) {
    return wale::Error{
        .code = wale::Code::unreadable_file, .sentence = why.toStdString(), .place = {.name = path.toStdString()}};
  };
  if (QFileInfo::exists(path) && !QFileInfo(path).isFile()) return unreadable("this is no regular file");
  if (!file.open(QIODevice::ReadOnly)) return unreadable(file.errorString());
  if (file.size() > largest) return unreadable(QString("it has more than %1 MB").arg(largest >> 20));
  QByteArray bytes = file.readAll();
  if (file.error() != QFile::NoError) return unreadable(file.errorString());
  return bytes;
}

/// A text without what presents its workspaces: movies, keys and groups, with their documentation.
std::string without_presentation(std::string text, const wale::Presentation& shown) {
  std::vector<wale::TextPart> parts;
  for (const auto& each : shown.movies) parts.push_back(each.statement);
  for (const auto& each : shown.keys) parts.push_back(each.statement);
  for (const auto& each : shown.groups) parts.push_back(each.statement);
  std::ranges::sort(parts, std::ranges::greater(), &wale::TextPart::begin);
  for (wale::TextPart part : parts) {
    while (part.begin > 0) {
      const std::size_t line = part.begin < 2 ? 0 : text.rfind('\n', part.begin - 2) + 1;  // npos + 1 is 0
      if (text[part.begin - 1] != '\n' || !text.substr(line, part.begin - line).starts_with("///")) break;
      part.begin = line;
    }
    text.erase(part.begin, std::min(part.end, text.size()) - part.begin);
  }
  return text;
}

}  // namespace

bool Exchange::is_ready() {
  editor_.commit();
  if (!document_.is_stale()) return true;
  emit said(tr("The text has errors: mend them first, then this can be done"));
  return false;
}

bool Exchange::take(const Contents& next, const QString& what) {
  const std::string text = document_.text_of(next);
  const std::string name = document_.file().isEmpty() ? "untitled.wale" : document_.file().toStdString();
  for (const wale::Problem& each : language_.check(text, {.name = name}).problems)
    if (wale::severity_of(each.error.code) == wale::Severity::error) {
      emit said(tr("%1 cannot be done: %2").arg(what, QString::fromStdString(wale::in_words(each.error))));
      return false;
    }
  document_.set_text(text, what);
  return true;
}

void Exchange::import_files(QStringList files, bool waves) {
  if (!is_ready()) return;
  while (!files.isEmpty()) {
    const QString path = files.takeFirst();
    const auto bytes = bytes_of(path, largest_file);
    if (!bytes) {
      emit refused(bytes.error());
      continue;
    }
    const std::string_view text(bytes->constData(), static_cast<std::size_t>(bytes->size()));
    const std::string file = QFileInfo(path).fileName().toStdString();
    const auto kind = waves ? wale::ThesisFileKind::array : wale::kind_of_thesis_file(file, text);
    if (kind == wale::ThesisFileKind::workspace) {
      emit refused(wale::unread_thesis_workspace(path.toStdString()));
    } else if (kind == wale::ThesisFileKind::movie || kind == wale::ThesisFileKind::shuffle) {
      wale::ThesisShowOptions options{.file = file, .workspaces = {}, .taken = document_.contents().declared()};
      for (const QString& each : document_.workspaces()) options.workspaces.insert(each.toStdString());
      options.workspaces.insert(document_.contents().name);
      options.name = wale::wale_name(file, options.taken);
      wale::Result<wale::ThesisInWale> made = wale::Error{};
      if (kind == wale::ThesisFileKind::movie) {
        const auto movie = wale::read_thesis_movie(text, path.toStdString());
        made = movie ? wale::movie_in_wale(*movie, options) : wale::Result<wale::ThesisInWale>(movie.error());
      } else {
        const auto shuffle = wale::read_thesis_shuffle(text, path.toStdString());
        made = shuffle ? wale::shuffle_in_wale(*shuffle, options) : wale::Result<wale::ThesisInWale>(shuffle.error());
      }
      if (!made) emit refused(made.error());
      else if (put(*made, false)) emit said(tr("Imported the movie %1").arg(QString::fromStdString(made->name)));
    } else if (kind == wale::ThesisFileKind::shading && QFile::exists(path.chopped(6) + ".depth")) {
      if (!files.contains(path.chopped(6) + ".depth")) files.append(path.chopped(6) + ".depth");
    } else if (const auto array = wale::read_thesis_array(std::as_bytes(std::span(text)), path.toStdString()); !array) {
      emit refused(array.error());
    } else {
      return import_array(path, *array, waves || kind == wale::ThesisFileKind::wave, files);
    }
  }
}

void Exchange::import_array(const QString& path, const wale::ThesisArray& array, bool wave, const QStringList& others) {
  const QString name = QFileInfo(path).fileName();
  if (document_.file().isEmpty())
    return emit said(tr("Save the workspace first (Ctrl+S): the picture of %1 comes beside its file").arg(name));
  const QString words =
      wave ? tr("%1 is a wave of %2 cells. How long is one wave, and how hard does it push?").arg(name).arg(array.width)
           : tr("%1 has %2 by %3 cells. How wide is it, and how hard does it push?")
                 .arg(name)
                 .arg(array.width)
                 .arg(array.height);
  const std::vector<Question::Field> fields = {
      {tr("&width"), tr("mm"), wave ? 2.5 : 1000 * wale::thesis_cell * array.width, 0.01, 10000, 2},
      {tr("&at most"), tr("N"), 1, 0.01, 100, 2}};
  question_.ask(words, fields, tr("Import"), [this, path, array, wave, others](const std::vector<double>& answers) {
    const std::string file = QFileInfo(path).fileName().toStdString();
    const QString folder = QFileInfo(document_.file()).path() + "/";
    const double width = answers[0] / 1000;
    std::optional<wale::ThesisArray> shading;
    if (!wave && path.endsWith(".depth"))
      if (const auto bytes = bytes_of(path.chopped(6) + ".shade", largest_file))
        if (auto read = wale::read_thesis_array(
                std::as_bytes(std::span(bytes->constData(), static_cast<std::size_t>(bytes->size()))), file))
          if (read->width == array.width && read->height == array.height) shading = *std::move(read);
    std::set<std::string> taken = document_.contents().declared();
    for (;;) {
      const wale::ThesisSurfaceOptions options{.name = wale::wale_name(file, taken),
                                               .file = file,
                                               .amplitude = answers[1],
                                               .cell = width / array.width,
                                               .period = width};
      auto made = wave ? wale::wave_in_wale(array, options)
                       : wale::surface_in_wale(array, options, shading ? &*shading : nullptr);
      if (!made) {
        made.error().place.name = path.toStdString();
        emit refused(made.error());
        break;
      }
      const bool lies_there = std::ranges::any_of(made->files, [&](const wale::FileBeside& each) {
        const QString beside = folder + QString::fromStdString(each.name);
        if (!QFile::exists(beside)) return false;
        const auto there = bytes_of(beside, largest_file);
        return !there || there->toStdString() != each.bytes;
      });
      if (lies_there) {
        taken.insert(options.name);
        continue;
      }
      if (put(*made, true)) emit said(tr("Imported %1 as %2").arg(path, QString::fromStdString(made->name)));
      break;
    }
    if (!others.isEmpty()) import_files(others, wave);
  });
}

bool Exchange::put(const wale::ThesisInWale& made, bool as_patch) {
  if (!is_ready()) return false;
  const QString folder = QFileInfo(document_.file()).path() + "/";
  QStringList written;
  const auto take_back = [&] {
    for (const QString& each : written) QFile::remove(each);
    return false;
  };
  for (const wale::FileBeside& each : made.files) {
    const QString path = folder + QString::fromStdString(each.name);
    if (QFile::exists(path)) continue;  // with the same bytes
    if (const auto saved = save_bytes(path, QByteArray::fromStdString(each.bytes)); !saved) {
      emit refused(saved.error());
      return take_back();
    }
    written << path;
  }
  Contents next = document_.contents();
  if (as_patch) {
    next.head += made.text + "\n";
    const glm::dvec2 middle = canvas_.to_metres(QPointF(canvas_.width() / 2.0, canvas_.height() / 2.0));
    wale::LaidOutPatch patch{.name = next.new_name(made.name),
                             .made_of = made.name,
                             .at = {std::round(middle.x * 1000) / 1000, std::round(middle.y * 1000) / 1000},
                             .size = {}};
    next.placed.push_back(
        std::make_shared<const Placed>(Placed{.patch = std::move(patch), .compiled_from = made.name}));
  } else {
    while (next.tail.ends_with("\n")) next.tail.pop_back();
    next.tail += "\n\n" + made.text;
  }
  return take(next, tr("Import %1").arg(QString::fromStdString(made.name))) || take_back();
}

void Exchange::merge(const QString& path) {
  if (!is_ready()) return;
  const auto bytes = bytes_of(path, largest_text);
  if (!bytes) return emit refused(bytes.error());
  const std::string text = bytes->toStdString();
  const auto shown = library_.presentation(text, path.toStdString());
  if (!shown) return emit refused(shown.error());
  if (shown->workspaces.empty()) return emit said(tr("%1 has no workspace to merge").arg(path));
  if (shown->workspaces.size() == 1) return merge(path, text, *shown, shown->workspaces.front());
  QStringList names;
  for (const std::string& each : shown->workspaces) names << QString::fromStdString(each);
  question_.ask(tr("%1 has %2 workspaces").arg(QFileInfo(path).fileName()).arg(names.size()),
                {{.label = tr("&workspace"), .choices = names}}, tr("Merge it"),
                [this, path, text, shown = *shown](const std::vector<double>& answers) {
                  merge(path, text, shown, shown.workspaces[static_cast<std::size_t>(answers[0])]);
                });
}

void Exchange::merge(const QString& path, std::string text, const wale::Presentation& shown, const std::string& wanted) {
  if (!is_ready()) return;  // it may have waited for an answer
  const bool leaves_out =
      shown.workspaces.size() > 1 || !shown.movies.empty() || !shown.keys.empty() || !shown.groups.empty();
  text = with_paths(without_presentation(std::move(text), shown), QFileInfo(path).absolutePath().toStdString());
  const WithRecipe merged = with_recipe(language_, document_.contents(), text, glm::dvec2(0), wanted);
  const QString name = QString::fromStdString(wanted);
  if (!take(merged.contents, tr("Merge %1").arg(name))) return;
  std::set<std::uint64_t> ids;
  for (const PlacedRef& each : document_.contents().placed)
    if (std::ranges::count(merged.patches, each->patch.name) > 0) ids.insert(each->id);
  document_.choose(ids);
  emit said(leaves_out ? tr("Merged %1. Its other workspaces, movies, keys and groups stay in their file").arg(name)
                       : tr("Merged %1").arg(name));
}

}  // namespace sandpaper
