#include "canvas/pictures.hpp"

#include <QStringList>
#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

namespace sandpaper {
namespace {

constexpr int kept_kilobytes = 256 * 1024;
constexpr int most_tile_pixels = 768, least_tile_pixels = 8;  // pixels
constexpr int most_remembered_pixels = 256;  // of a side
constexpr int remembered_urgency = 3;        // before those that stay

/// The next size of a kept image: powers of two, so that zooming draws few.
int kept_side(int pixels) {
  return std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(pixels, 1)))), least_tile_pixels,
                    most_tile_pixels);
}

}  // namespace

Pictures::Pictures(QObject* parent) : QObject(parent), images_(kept_kilobytes) {}

QImage Pictures::find(const wale::Program& program, const std::vector<float>& parameters, glm::vec2 size,
                      const wale::Shape& shape, QSize pixels, Look look, QColor plain, int urgency) {
  const QSize kept(kept_side(pixels.width()), kept_side(pixels.height()));
  const QString of_program = QString("%1|%2|%3|%4")
                                 .arg(reinterpret_cast<quintptr>(&program.decoded()))
                                 .arg(static_cast<int>(look))
                                 .arg(plain.rgb())
                                 .arg(reinterpret_cast<quintptr>(shape.identity()));
  QStringList parts = {of_program, QString::number(kept.width()), QString::number(kept.height()),
                       QString::number(std::bit_cast<quint32>(size.x)),
                       QString::number(std::bit_cast<quint32>(size.y))};
  for (const float each : parameters) parts << QString::number(std::bit_cast<quint32>(each));
  const QString key = parts.join('|');
  if (const QImage* found = images_.object(key)) return *found;
  if (!asked_.contains(key)) {
    asked_[key] = true;
    thread_.post(urgency, of_program.toStdString() + parts[3].toStdString() + parts[4].toStdString(),
                 [this, key, of_program, program, parameters, size, shape, kept, look, plain] {
      const wale::Bank bank(program, parameters, {size.x, size.y, 0});
      const QImage image = surface_image(bank, nullptr, size, shape.stretched(size), kept, look, plain);
      window_.post([this, key, of_program, image] {
        images_.insert(key, new QImage(image), static_cast<int>(image.sizeInBytes() / 1024) + 1);
        last_[of_program] = key;
        asked_.erase(key);
        emit drawn();
      });
    });
  }
  const auto last = last_.find(of_program);
  const QImage* older = last == last_.end() ? nullptr : images_.object(last->second);
  return older ? *older : QImage();
}

void Pictures::draw_remembered(std::uint64_t id, wale::Snapshot running, std::vector<float> parameters,
                               const wale::Shape& shape, QSize pixels, Look look, QColor plain) {
  const QSize kept = QSize(kept_side(pixels.width()), kept_side(pixels.height()))
                         .boundedTo({most_remembered_pixels, most_remembered_pixels});
  const auto shared = std::make_shared<const wale::Snapshot>(std::move(running));
  thread_.post(remembered_urgency, "remembered " + std::to_string(id),
               [this, id, shared, parameters = std::move(parameters), shape, kept, look, plain, forgotten = forgotten_] {
    const glm::vec2 size(shared->bank.size().width, shared->bank.size().height);
    const QImage image = surface_image(shared->bank, &shared->memory, size, shape.stretched(size), kept, look, plain);
    window_.post([this, id, shared, parameters, size, look, image, forgotten] {
      if (forgotten != forgotten_) return;
      remembered_.insert_or_assign(id, Remembered{shared->bank.program(), parameters, size, look, image});
      emit drawn();
    });
  });
}

QImage Pictures::remembered(std::uint64_t id, const wale::Program& program, const std::vector<float>& parameters,
                            glm::vec2 size, Look look) const {
  const auto found = remembered_.find(id);
  if (found == remembered_.end()) return {};
  const Remembered& known = found->second;
  const bool is_same = &known.program.decoded() == &program.decoded() && known.parameters == parameters &&
                       known.size == size && known.look == look;
  return is_same ? known.image : QImage();
}

void Pictures::forget_remembered() {
  if (remembered_.empty() && thread_.waiting() == 0) return;
  ++forgotten_;
  remembered_.clear();
  emit drawn();
}

}  // namespace sandpaper
