#pragma once

#include <QByteArray>
#include <QSaveFile>
#include <wale/result.hpp>

namespace sandpaper {

/// Writes a file: a new one beside it first, which then takes its place, so that a full disk leaves what was there.
/// Error: `unwritable_file`. From any thread.
inline wale::Result<> save_bytes(const QString& path, const QByteArray& bytes) {
  QSaveFile file(path);
  // Without `flush`, `commit` writes what is still in the buffer, and does not tell that the disk has not taken it.
  if (file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size() && file.flush() && file.commit()) return {};
  return wale::Error{.code = wale::Code::unwritable_file,
                     .sentence = "cannot be written: " + file.errorString().toStdString(),
                     .place = {.name = path.toStdString()}};
}

}  // namespace sandpaper
