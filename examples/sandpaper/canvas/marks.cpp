#include "canvas/marks.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace sandpaper {
namespace {

constexpr float farthest = 10;       // m: what is farther is not drawn
constexpr float longest_way = 30;    // s
constexpr double pictures_a_second = 60;
constexpr double least_dot = 1.5;    // pixels, its radius
constexpr int coils = 16;

bool is_drawable(const wale::ShownMark& mark) {
  return std::ranges::all_of(mark.values, [](float each) { return std::isfinite(each) && std::abs(each) < farthest; });
}

QPainterPath spring(QPointF from, QPointF to, double wide) {
  const QPointF way = to - from;
  const double length = std::hypot(way.x(), way.y());
  const QPointF square = length > 0 ? QPointF(-way.y(), way.x()) / length * wide : QPointF();
  QPainterPath path(from);
  for (int i = 1; i < coils; ++i) path.lineTo(from + way * i / coils + (i % 2 ? square : -square));
  path.lineTo(to);
  return path;
}

QPainterPath box(QPointF middle, double width, double height, double angle) {
  QTransform turn;
  turn.translate(middle.x(), middle.y());
  turn.rotateRadians(-angle);
  QPainterPath path;
  path.addRect(-width / 2, -height / 2, width, height);
  return turn.map(path);
}

}  // namespace

QRegion MovingShape::region() const {
  const double wide = pen.widthF() + 2;
  const QRect touched = path.boundingRect().adjusted(-wide, -wide, wide, wide).toAlignedRect();
  return within.isEmpty() ? QRegion(touched) : within & touched;
}

void MovingShape::draw(QPainter& painter) const {
  if (!within.isEmpty()) {
    painter.save();
    painter.setClipRegion(within, Qt::IntersectClip);
  }
  painter.setPen(pen);
  painter.setBrush(brush);
  painter.drawPath(path);
  if (!within.isEmpty()) painter.restore();
}

bool Marks::has(std::uint64_t id) const {
  const wale::Program* program = feeling_.program(id);
  return program && !program->description().picture.marks.empty();
}

void Marks::keep(const std::vector<std::uint64_t>& ids) {
  const std::set<std::uint64_t> kept(ids.begin(), ids.end());
  std::erase_if(left_, [&](const auto& each) { return !kept.contains(each.first); });
}

Marks::Left& Marks::left(const Placed& placed, const wale::Program& program, glm::vec2 size, bool is_touched) {
  Left& left = left_[placed.id];
  std::vector<float> parameters;
  for (const wale::Parameter& each : program.description().parameters)
    parameters.push_back(feeling_.value(placed, each));
  const bool is_new =
      left.program != &program.decoded() || left.parameters != parameters || left.size != size || !left.running;
  if (!is_touched && !is_new) return left;
  left.program = &program.decoded(), left.parameters = parameters, left.size = size;
  left.was_touched |= is_touched;
  if (left.was_touched)
    if (auto snapshot = feeling_.snapshot(placed.id);
        snapshot && &snapshot->bank.program().decoded() == left.program) {
      left.running.emplace(Running{std::move(snapshot->bank), std::move(snapshot->memory)});
      return left;
    }
  if (!is_new) return left;  // a loop that is late has no copy now
  wale::Bank bank(program, parameters, felt_size(placed.patch, program));
  wale::Memory memory(program);
  memory.enter(bank, left.hand);
  left.running.emplace(Running{std::move(bank), std::move(memory)});
  return left;
}

std::vector<MovingShape> Marks::shapes(const Placed& placed, glm::vec2 size, const wale::Now& now, bool is_touched,
                                       const std::function<QPointF(glm::dvec2)>& to_pixels, double pixels_per_metre) {
  const wale::Program* program = feeling_.program(placed.id);
  if (!program) return {};
  Left& left = this->left(placed, *program, size, is_touched);
  if (is_touched) {
    left.hand.position = now.position - glm::vec2(placed.patch.at);
    left.hand.velocity = now.velocity;
  } else {
    left.hand.velocity = {0, 0};
    left.ways.clear();
  }
  left.hand.workspace = left.hand.position + glm::vec2(placed.patch.at);
  left.hand.time = now.time;
  const auto place = [&](float x, float y) { return to_pixels(placed.patch.at + glm::dvec2(x, y)); };
  std::vector<MovingShape> shapes;
  const std::vector<wale::ShownMark> marks = wale::show(left.running->bank, left.running->memory, left.hand);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const wale::ShownMark& mark = marks[i];
    if (!is_drawable(mark)) continue;
    const auto& v = mark.values;
    const QColor colour = QColor::fromRgb(mark.colour);
    MovingShape shape{.pen = QPen(colour, 2)};
    const auto radius = [&](double metres) { return std::max(least_dot, std::abs(metres) * pixels_per_metre); };
    switch (mark.kind) {
      case wale::MarkKind::point:
        shape.brush = colour;
        shape.path.addEllipse(place(v[0], v[1]), radius(v[2] / 2), radius(v[2] / 2));
        break;
      case wale::MarkKind::circle: shape.path.addEllipse(place(v[0], v[1]), radius(v[2]), radius(v[2])); break;
      case wale::MarkKind::box:
        shape.path = box(place(v[0], v[1]), v[2] * pixels_per_metre, v[3] * pixels_per_metre, v[4]);
        break;
      case wale::MarkKind::line:
        shape.path.moveTo(place(v[0], v[1]));
        shape.path.lineTo(place(v[2], v[3]));
        break;
      case wale::MarkKind::spring:
        shape.path = spring(place(v[0], v[1]), place(v[2], v[3]), v[4] / 2 * pixels_per_metre);
        break;
      case wale::MarkKind::trajectory: {
        if (!is_touched) continue;
        std::deque<glm::dvec2>& way = left.ways[i];
        way.push_back({v[0], v[1]});
        const auto most = static_cast<std::size_t>(std::clamp(v[2], 0.f, longest_way) * pictures_a_second);
        while (way.size() > most) way.pop_front();
        for (std::size_t at = 0; at < way.size(); ++at) {
          const QPointF to = to_pixels(placed.patch.at + way[at]);
          at == 0 ? shape.path.moveTo(to) : shape.path.lineTo(to);
        }
      }
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace sandpaper
