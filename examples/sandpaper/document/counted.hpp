#pragma once

#include <QString>

namespace sandpaper {

/// "1 patch", "5 patches".
inline QString counted(qsizetype count, const QString& one, const QString& many) {
  return QString("%1 %2").arg(count).arg(count == 1 ? one : many);
}

}  // namespace sandpaper
