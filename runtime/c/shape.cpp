#include "runtime/c/shape.hpp"

#include <limits>
#include <span>
#include <vector>

#include "runtime/c/program.hpp"
#include "runtime/c/run.hpp"
#include "runtime/c/sized.hpp"
#include "schema/sentence.hpp"

using namespace wale::c;

namespace {

/// Gives the shape that `make()` makes.
template <class Make>
WaleCode make_shape(WaleShape** to, WaleError** error, const Make& make) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("shape", to); !clear) return clear;
    wale::Result<wale::Shape> made = make();
    if (!made) return std::move(made).error();
    hand_out(std::make_unique<WaleShape>(WaleShape{*std::move(made)}), to);
    return {};
  });
}

}  // namespace

WaleCode wale_shape_ellipse(float half_width, float half_height, WaleShape** shape, WaleError** error) {
  return make_shape(shape, error, [&] { return wale::Shape::ellipse(half_width, half_height); });
}

WaleCode wale_shape_polygon(const WaleVector* corners, size_t count, WaleShape** shape, WaleError** error) {
  return make_shape(shape, error, [&]() -> wale::Result<wale::Shape> {
    if (auto given = is_given("corners", corners); !given) return std::move(given).error();
    if (count > wale::Shape::most_corners)  // refused unread
      return about_argument("corners", wale::sentence("expected 3 to ", wale::Shape::most_corners, " corners, found ", count),
                            "leave out corners that lie on a line, or use wale_shape_mask");
    std::vector<glm::vec2> all;
    for (const WaleVector& each : std::span(corners, count)) all.emplace_back(each.x, each.y);
    return wale::Shape::polygon(all);
  });
}

WaleCode wale_shape_mask(const uint8_t* cells, size_t columns, size_t rows, float side, WaleShape** shape,
                         WaleError** error) {
  return make_shape(shape, error, [&]() -> wale::Result<wale::Shape> {
    if (auto given = is_given("cells", cells); !given) return std::move(given).error();
    constexpr std::size_t most = wale::Shape::most_along_a_side;
    const std::size_t count = columns <= most && rows <= most ? columns * rows : 0;  // too many are refused unread
    return wale::Shape::mask(std::span(cells, count), columns, rows, side);
  });
}

void wale_shape_free(WaleShape* shape) { free_handle(shape); }

WaleVector wale_shape_size(const WaleShape* shape) {
  return shape == nullptr ? WaleVector{} : vector_of(shape->shape.size());
}

float wale_shape_edge(const WaleShape* shape, WaleVector point) {
  if (shape == nullptr) return std::numeric_limits<float>::quiet_NaN();
  return shape->shape.edge({point.x, point.y}).metres;
}
