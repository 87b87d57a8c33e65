#include "window/autosave.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

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

/// A process keeps this file locked as long as it lives. (A killed one can be seen for a while longer by its number,
/// and another process can get that.)
QString lock_of(qint64 process) { return folder() + QString("/%1.lock").arg(process); }

/// Held by this process until it ends.
class Lock {
 public:
  Lock() : path_(lock_of(QCoreApplication::applicationPid()).toLocal8Bit()) {
    QDir().mkpath(folder());
    file_ = open(path_.constData(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file_ >= 0) flock(file_, LOCK_EX | LOCK_NB);
  }
  ~Lock() {
    if (file_ < 0) return;
    unlink(path_.constData());
    close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  QByteArray path_;
  int file_ = -1;
};

bool is_alive(qint64 process) {
  if (process <= 0) return false;
  const int file = open(lock_of(process).toLocal8Bit().constData(), O_RDWR | O_CLOEXEC);
  if (file < 0) return kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM;  // of an older version
  const bool is_free = flock(file, LOCK_EX | LOCK_NB) == 0;
  close(file);
  return !is_free;
}

}  // namespace

Autosave::Autosave(Document& document, QObject* parent)
    : QObject(parent), document_(document), path_(next_path()) {
  static const Lock alive;
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
    const qint64 process = each.completeBaseName().section('-', 0, 0).toLongLong();
    if (is_alive(process)) continue;
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

void Autosave::forget(const Left& left) {
  QFile::remove(left.kept_in);
  QFile::remove(lock_of(QFileInfo(left.kept_in).completeBaseName().section('-', 0, 0).toLongLong()));
}

}  // namespace sandpaper
