#include "window/autosave.hpp"

#include <signal.h>

#include <QCoreApplication>
#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QSaveFile>
#include <QStandardPaths>
#include <cerrno>

namespace sandpaper {
namespace {

constexpr int after_change = 1000;  // ms

QString folder() { return QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + "/wale/sandpaper"; }

bool is_alive(qint64 process) { return process > 0 && (kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM); }

}  // namespace

Autosave::Autosave(Document& document, QObject* parent)
    : QObject(parent), document_(document), path_(folder() + QString("/%1.json").arg(QCoreApplication::applicationPid())) {
  timer_.setSingleShot(true);
  timer_.setInterval(after_change);
  connect(&timer_, &QTimer::timeout, this, &Autosave::save_now);
  const auto changed = [this] {
    if (!timer_.isActive()) timer_.start();
  };
  connect(&document_, &Document::contents_changed, this, changed);
  connect(&document_, &Document::problems_changed, this, changed);
  connect(&document_, &Document::file_changed, this, [this] {
    if (!document_.is_modified()) {
      timer_.stop();
      QFile::remove(path_);
    }
  });
}

Autosave::~Autosave() { QFile::remove(path_); }

void Autosave::save_now() {
  if (!document_.is_modified()) {
    QFile::remove(path_);
    return;
  }
  QDir().mkpath(folder());
  QFile(folder()).setPermissions(QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
  QSaveFile file(path_);
  const QJsonObject kept{{"file", document_.file()}, {"text", QString::fromStdString(document_.text())}};
  if (file.open(QIODevice::WriteOnly)) {
    file.write(QJsonDocument(kept).toJson(QJsonDocument::Compact));
    file.commit();
  }
}

std::optional<Autosave::Left> Autosave::left_behind() {
  for (const QFileInfo& each : QDir(folder()).entryInfoList({"*.json"}, QDir::Files, QDir::Time)) {
    if (is_alive(each.completeBaseName().toLongLong())) continue;
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
