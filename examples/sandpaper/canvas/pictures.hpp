#pragma once

#include <QCache>
#include <QImage>
#include <QObject>
#include <map>
#include <string>
#include <vector>
#include <wale/patch.hpp>

#include "canvas/surface_image.hpp"
#include "feeling/hand_over.hpp"
#include "feeling/work_thread.hpp"

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

  /// Draws the surface of a running program as it remembers it now, in at most some ten thousand pixels; `drawn` follows,
  /// and then `remembered` has it. `id` is the patch's.
  void draw_remembered(std::uint64_t id, wale::Snapshot running, std::vector<float> parameters, const wale::Shape& shape,
                       QSize pixels, Look look, QColor plain);
  /// The latest such image, if it is of this program with these parameters, size and look; otherwise null.
  QImage remembered(std::uint64_t id, const wale::Program& program, const std::vector<float>& parameters, glm::vec2 size,
                    Look look) const;
  void forget_remembered();

  bool is_busy() const { return thread_.waiting() > 0; }

 signals:
  void drawn();

 private:
  QCache<QString, QImage> images_;
  std::map<QString, QString> last_;  // the latest image of a program: its key
  std::map<QString, bool> asked_;
  struct Remembered {
    wale::Program program;
    std::vector<float> parameters;
    glm::vec2 size{0};
    Look look = Look::relief;
    QImage image;
  };
  std::map<std::uint64_t, Remembered> remembered_;
  std::uint64_t forgotten_ = 0;  // times
  HandOver window_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
