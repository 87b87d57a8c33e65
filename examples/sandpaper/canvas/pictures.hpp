#pragma once

#include <QCache>
#include <QImage>
#include <QObject>
#include <map>
#include <string>
#include <vector>

#include "feeling/work_thread.hpp"
#include "canvas/surface_image.hpp"

namespace sandpaper {

/// The surfaces of programs as images, drawn in the background and kept, the last used ones longest. In the window's
/// thread.
class Pictures : public QObject {
  Q_OBJECT

 public:
  explicit Pictures(QObject* parent = nullptr);

  /// The surface of a program with these parameters (SI, in its order) in about so many pixels; null if it is not drawn
  /// yet: then `drawn` follows. Until then an older image of the same program is given, if there is one.
  QImage find(const wale::Program& program, const std::vector<float>& parameters, glm::vec2 size,
              const wale::Shape& shape, QSize pixels, Look look, QColor plain, int urgency = 0);
  bool is_busy() const { return thread_.waiting() > 0; }

 signals:
  void drawn();

 private:
  QCache<QString, QImage> images_;
  std::map<QString, QString> last_;  // the latest image of a program: its key
  std::map<QString, bool> asked_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
