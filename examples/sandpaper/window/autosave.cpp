#include "window/autosave.hpp"

#include <signal.h>

#include <QCoreApplication>
#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QStandardPaths>
#include <cerrno>

#include "document/saving.hpp"

namespace sandpaper {
namespace {

constexpr int after_change = 1000;  // ms

QString folder() { return QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + "/wale/sandpaper"; }

/// Of the next window of this process.
QString next_path() {
  static int windows = 0;
  return folder() + QString("/%1-%2.json").arg(QCoreApplication::applicationPid()).arg(++windows);
}

bool is_alive(qint64 process) { return process > 0 && (kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM); }

}  // namespace

Autosave::Autosave(Document& document, QObject* parent)
    : QObject(parent), document_(document), path_(next_path()) {
  timer_.setSingleShot(true);
  timer_.setInterval(after_change);
  connect(&timer_, &QTimer::timeout, this, &Autosave::save_now);
  connect(&document_, &Document::contents_changed, this, &Autosave::changed);
  connect(&document_, &Document::problems_changed, this, &Autosave::changed);
  connect(&document_, &Document::file_changed, this, [this] {
    if (!to_keep()) {
      timer_.stop();
      QFile::remove(path_);
    }
  });
}

Autosave::~Autosave() { QFile::remove(path_); }

void Autosave::changed() {
  if (!timer_.isActive()) timer_.start();
}

std::optional<std::string> Autosave::to_keep() const {
  if (auto typed = typed_()) return typed;
  return document_.is_modified() ? std::optional(document_.text()) : std::nullopt;
}

void Autosave::save_now() {
  const auto text = to_keep();
  if (!text) {
    QFile::remove(path_);
    return;
  }
  QDir().mkpath(folder());
  QFile(folder()).setPermissions(QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
  const QJsonObject kept{{"file", document_.file()}, {"text", QString::fromStdString(*text)}};
  const auto saved = save_bytes(path_, QJsonDocument(kept).toJson(QJsonDocument::Compact));
  if (!saved && !is_failing_)
    emit failed(tr("%1. If the window is closed by force, what is not saved is lost: save it (Ctrl+S)")
                    .arg(QString::fromStdString(wale::in_words(saved.error()))));
  is_failing_ = !saved;
}

std::optional<Autosave::Left> Autosave::left_behind() {
  for (const QFileInfo& each : QDir(folder()).entryInfoList({"*.json"}, QDir::Files, QDir::Time)) {
    if (is_alive(each.completeBaseName().section('-', 0, 0).toLongLong())) continue;
    QFile file(each.filePath());
    if (!file.open(QIODevice::ReadOnly)) continue;
    const QJsonObject kept = QJsonDocument::fromJson(file.readAll()).object();
    if (!kept["text"].isString()) {
      file.remove();
      continue;
    }
    return Left{each.filePath(), kept["file"].toString(), kept["text"].toString(), each.lastModified()};
  }
  return std::nullopt;
}

void Autosave::forget(const Left& left) { QFile::remove(left.kept_in); }

}  // namespace sandpaper
