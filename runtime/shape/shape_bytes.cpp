#include "runtime/shape/shape_bytes.hpp"

#include <algorithm>

#include "schema/sentence.hpp"

namespace wale {
namespace {

constexpr std::uint32_t ellipse_shape = 1, polygon_shape = 2, mask_shape = 3;

struct Writer {
  ByteWriter& bytes;

  void operator()(const RectangleFigures&) const {}
  void operator()(const EllipseFigures& of) const { bytes << ellipse_shape << of.half_width << of.half_height; }
  void operator()(const PolygonFigures& of) const {
    bytes << polygon_shape << static_cast<std::uint32_t>(of.corners.size());
    for (const glm::vec2 corner : of.corners) bytes << corner.x << corner.y;
  }
  void operator()(const MaskFigures& of) const {
    bytes << mask_shape << static_cast<std::uint32_t>(of.columns) << static_cast<std::uint32_t>(of.rows) << of.side;
    for (std::size_t first = 0; first < of.bits.size(); first += 8) {
      std::uint8_t byte = 0;
      for (std::size_t i = 0; i < std::min<std::size_t>(8, of.bits.size() - first); ++i)
        byte = static_cast<std::uint8_t>(byte | (of.bits[first + i] != 0) << i);
      bytes << byte;
    }
  }
};

MaskFigures read_mask(patch_program_format::ByteReader& in, std::size_t most_cells) {
  MaskFigures mask;
  mask.columns = in.u32();
  mask.rows = in.u32();
  mask.side = in.f32();
  const bool fits = mask.columns <= Shape::most_along_a_side && mask.rows <= Shape::most_along_a_side;
  if (!fits || mask.columns * mask.rows > most_cells)
    damaged("a mask has ", mask.columns, " by ", mask.rows, " cells, which are too many");
  const std::size_t cells = mask.columns * mask.rows;
  if (in.remaining() != (cells + 7) / 8)
    damaged("a mask has ", in.remaining(), " bytes of cells, expected ", (cells + 7) / 8);
  mask.bits.reserve(cells);
  std::uint8_t byte = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    if (i % 8 == 0) byte = in.u8();
    mask.bits.push_back(byte >> i % 8 & 1);
  }
  return mask;
}

}  // namespace

ByteWriter bytes_of(const ShapeFigures& figures) {
  ByteWriter bytes;
  std::visit(Writer{bytes}, figures);
  return bytes;
}

ShapeFigures read_shape(patch_program_format::ByteReader& in, std::size_t most_cells) {
  switch (const std::uint32_t kind = in.u32()) {
    case ellipse_shape: {
      EllipseFigures ellipse;
      ellipse.half_width = in.f32();
      ellipse.half_height = in.f32();
      return ellipse;
    }
    case polygon_shape: {
      PolygonFigures polygon;
      polygon.corners.resize(in.count(2 * sizeof(float), "corners"));
      for (glm::vec2& corner : polygon.corners)
        for (int i = 0; i < 2; ++i) corner[i] = in.f32();
      return polygon;
    }
    case mask_shape: return read_mask(in, most_cells);
    default: damaged("the kind ", kind, " of a shape is unknown");
  }
}

}  // namespace wale
