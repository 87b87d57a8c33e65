#include "runtime/shape/shape_figures.hpp"

#include "runtime/shape/shape_form.hpp"

namespace wale {
namespace {

struct Figures {
  ShapeFigures operator()(const EllipseForm& ellipse) const {
    return EllipseFigures{static_cast<float>(ellipse.half().x), static_cast<float>(ellipse.half().y)};
  }
  ShapeFigures operator()(const PolygonForm& polygon) const {
    PolygonFigures figures;
    for (const glm::dvec2 corner : polygon.corners()) figures.corners.emplace_back(corner);
    return figures;
  }
  ShapeFigures operator()(const MaskForm& mask) const {
    const MaskCells& cells = mask.cells();
    MaskFigures figures{{}, cells.wide - 2, cells.high - 2, static_cast<float>(mask.cell_size().x)};
    for (std::size_t row = figures.rows; row > 0; --row)  // rows of cells begin at the bottom, within a ring
      for (std::size_t column = 1; column <= figures.columns; ++column)
        figures.bits.push_back(cells.cell(column, row).is_set);
    return figures;
  }
};

struct Maker {
  Result<Shape> operator()(const RectangleFigures&) const { return Shape(); }
  Result<Shape> operator()(const EllipseFigures& of) const { return Shape::ellipse(of.half_width, of.half_height); }
  Result<Shape> operator()(const PolygonFigures& of) const { return Shape::polygon(of.corners); }
  Result<Shape> operator()(const MaskFigures& of) const { return Shape::mask(of.bits, of.columns, of.rows, of.side); }
};

}  // namespace

ShapeFigures figures_of(const Shape& shape) {
  const Shape whole = shape.unstretched();
  const ShapeForm* form = form_of(whole);
  return form != nullptr ? std::visit(Figures(), form->form) : ShapeFigures();
}

Result<Shape> shape_of(const ShapeFigures& figures) { return std::visit(Maker(), figures); }

}  // namespace wale
