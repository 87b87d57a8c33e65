#include "wale/shape.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "runtime/shape/shape_form.hpp"
#include "schema/expectation.hpp"

namespace wale {
namespace {

/// m, the furthest that a shape reaches from the patch's centre: the widest workspace.
constexpr float furthest = 10;

constexpr const char* lengths = "give m, as in 0.05";

bool is_length(float value) { return value > 0 && value <= furthest; }

Error malformed(std::string sentence, std::string mend) {
  return with_expectation({.code = Code::malformed_value,
                           .sentence = std::move(sentence),
                           .mend = std::move(mend),
                           .place = {.name = "shape"}});
}

double turn(glm::dvec2 one, glm::dvec2 other) { return one.x * other.y - one.y * other.x; }

/// Whether two segments have a point in common.
bool meet(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
  const auto side = [](glm::dvec2 from, glm::dvec2 to, glm::dvec2 point) {
    const double turned = turn(to - from, point - from);
    return (turned > 0) - (turned < 0);
  };
  const auto between = [](glm::dvec2 from, glm::dvec2 to, glm::dvec2 point) {
    return std::min(from.x, to.x) <= point.x && point.x <= std::max(from.x, to.x) &&
           std::min(from.y, to.y) <= point.y && point.y <= std::max(from.y, to.y);
  };
  const int abc = side(a, b, c), abd = side(a, b, d), cda = side(c, d, a), cdb = side(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

/// Why corners make no polygon; empty if they do.
std::string why_no_polygon(const std::vector<glm::dvec2>& corners) {
  const std::size_t count = corners.size();
  const auto corner = [&](std::size_t i) { return corners[i % count]; };
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 along = corner(i + 1) - corner(i), next = corner(i + 2) - corner(i + 1);
    if (along == glm::dvec2(0.0))
      return "expected corners that differ, found corner " + std::to_string(i + 1) + " twice";
    if (turn(along, next) == 0 && along.x * next.x + along.y * next.y <= 0)
      return "expected a polygon, found that its edge turns back at corner " + std::to_string((i + 1) % count + 1);
    for (std::size_t k = i + 2; k < count; ++k) {
      if (i == 0 && k + 1 == count) continue;  // neighbours
      if (meet(corner(i), corner(i + 1), corner(k), corner(k + 1)))
        return "expected edges that meet only at corners, found that those from corners " + std::to_string(i + 1) +
               " and " + std::to_string(k + 1) + " meet";
    }
  }
  return {};
}

EdgeDistance edge_of(const ShapeForm& shape, glm::dvec2 point) noexcept {
  if (const auto* ellipse = std::get_if<EllipseForm>(&shape.form)) return ellipse->edge(point);
  if (const auto* polygon = std::get_if<PolygonForm>(&shape.form)) return polygon->edge(point);
  return std::get_if<MaskForm>(&shape.form)->edge(point);
}

}  // namespace

Result<Shape> Shape::ellipse(float half_width, float half_height) {
  if (!is_length(half_width) || !is_length(half_height))
    return malformed("the half axes of an ellipse must be above 0 and at most 10 m", lengths);
  return Shape(std::make_shared<const ShapeForm>(
      ShapeForm{EllipseForm(half_width, half_height), glm::vec2(2 * half_width, 2 * half_height), nullptr}));
}

Result<Shape> Shape::polygon(std::span<const glm::vec2> corners) {
  if (corners.size() < 3 || corners.size() > most_corners)
    return malformed(
        "expected 3 to " + std::to_string(most_corners) + " corners, found " + std::to_string(corners.size()),
        "leave out corners, or draw a mask");
  std::vector<glm::dvec2> exact;
  glm::vec2 half(0.0f);
  for (const glm::vec2 corner : corners) {
    const float x = std::abs(corner.x), y = std::abs(corner.y);
    if (!(x <= furthest && y <= furthest))
      return malformed("the corners of a polygon must be within 10 m from the patch's centre", lengths);
    half = {std::max(half.x, x), std::max(half.y, y)};
    exact.emplace_back(corner);
  }
  if (std::string why = why_no_polygon(exact); !why.empty())
    return malformed(std::move(why), "give the corners in their order around it, each once");
  return Shape(std::make_shared<const ShapeForm>(ShapeForm{PolygonForm(std::move(exact)), 2.0f * half, nullptr}));
}

Result<Shape> Shape::mask(std::span<const std::uint8_t> bits, std::size_t columns, std::size_t rows, float side) {
  if (columns == 0 || rows == 0 || columns > most_along_a_side || rows > most_along_a_side)
    return malformed("expected a mask of 1 to " + std::to_string(most_along_a_side) + " cells along a side, found " +
                         std::to_string(columns) + " by " + std::to_string(rows),
                     "scale the picture");
  if (bits.size() != columns * rows)
    return malformed(
        "expected " + std::to_string(columns * rows) + " bits of a mask, found " + std::to_string(bits.size()),
        "give one for each column and row");
  const glm::vec2 size(static_cast<float>(columns) * side, static_cast<float>(rows) * side);
  if (!(side > 0 && size.x <= 2 * furthest && size.y <= 2 * furthest))
    return malformed("the side of a mask's cells must be positive, and the mask at most 20 m wide and high", lengths);
  if (std::ranges::none_of(bits, [](std::uint8_t bit) { return bit != 0; }))
    return malformed("expected a mask with a bit that is set, found none", "set those where the patch is");
  MaskForm form(std::make_shared<const MaskCells>(bits, columns, rows), glm::dvec2(side));
  return Shape(std::make_shared<const ShapeForm>(ShapeForm{std::move(form), size, nullptr}));
}

glm::vec2 Shape::size() const noexcept { return form_ ? form_->size : glm::vec2(0.0f); }

Shape Shape::stretched(glm::vec2 size) const {
  if (!form_ || size == form_->size || !(size.x > 0 && size.y > 0)) return *this;
  const std::shared_ptr<const ShapeForm>& from = form_->origin ? form_->origin : form_;
  const glm::dvec2 factors = glm::dvec2(size) / glm::dvec2(from->size);
  const auto stretch = [&](const auto& form) {
    return std::make_shared<const ShapeForm>(ShapeForm{form.stretched(factors), size, from});
  };
  return Shape(std::visit(stretch, from->form));
}

EdgeDistance Shape::edge(glm::vec2 point) const noexcept {
  return form_ ? edge_of(*form_, glm::dvec2(point)) : EdgeDistance{};
}

bool Shape::form_contains(glm::vec2 at, glm::vec2 size) const noexcept {
  const ShapeForm& from = form_->origin ? *form_->origin : *form_;
  const glm::dvec2 point = glm::dvec2(at) * (glm::dvec2(from.size) / glm::dvec2(size));
  if (const auto* ellipse = std::get_if<EllipseForm>(&from.form)) return ellipse->contains(point);
  if (const auto* polygon = std::get_if<PolygonForm>(&from.form)) return polygon->contains(point);
  return std::get_if<MaskForm>(&from.form)->contains(point);
}

Shape Shape::unstretched() const noexcept { return form_ && form_->origin ? Shape(form_->origin) : *this; }

bool Shape::covers(glm::vec2 centre, float radius) const noexcept {
  if (!form_) return true;
  constexpr float rounding = 1e-6f;
  return edge(centre).metres > radius + rounding * (form_->size.x + form_->size.y);
}

}  // namespace wale
