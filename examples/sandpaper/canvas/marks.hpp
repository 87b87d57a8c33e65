#pragma once

#include <QPainterPath>
#include <QPen>
#include <QRegion>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>
#include <wale/picture.hpp>

#include "feeling/feeling.hpp"

namespace sandpaper {

/// A shape that moves above the patches, in pixels.
struct MovingShape {
  QPainterPath path;
  QPen pen;
  QBrush brush;
  QRegion within;  ///< where it may be seen; empty: everywhere

  /// The pixels that it may touch.
  QRegion region() const;
  void draw(QPainter& painter) const;
  friend bool operator==(const MovingShape&, const MovingShape&) = default;
};

/// The marks that programs show. A patch under the hand shows them as its program is now, another as the hand has left
/// it, and one where no hand was as if it rested in the middle. In the window's thread.
class Marks {
 public:
  explicit Marks(const Feeling& feeling) : feeling_(feeling) {}

  /// Whether a patch may show marks.
  bool has(std::uint64_t id) const;
  /// Forgets the patches that are not among these.
  void keep(const std::vector<std::uint64_t>& ids);
  /// The marks of a patch of this size (m) at this time. `to_pixels` takes places from the workspace's centre, m.
  std::vector<MovingShape> shapes(const Placed& placed, glm::vec2 size, const wale::Now& now, bool is_touched,
                                  const std::function<QPointF(glm::dvec2)>& to_pixels, double pixels_per_metre);

 private:
  struct Running {
    wale::Bank bank;
    wale::Memory memory;
  };
  struct Left {
    const void* program = nullptr;
    std::vector<float> parameters;
    glm::vec2 size{0};
    std::optional<Running> running;
    wale::Hand hand;  // from the patch's centre
    bool was_touched = false;
    std::map<std::size_t, std::deque<glm::dvec2>> ways;  // of the marks that leave one, m from the patch's centre
  };
  Left& left(const Placed& placed, const wale::Program& program, glm::vec2 size, bool is_touched);

  const Feeling& feeling_;
  std::map<std::uint64_t, Left> left_;
};

}  // namespace sandpaper
