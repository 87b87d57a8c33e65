#pragma once

#include "runtime/shape/shape_figures.hpp"
#include "schema/byte_reader.hpp"
#include "schema/byte_writer.hpp"

namespace wale {

/// A shape's figures in a recording or a workspace file (RECORDING.md). The shape is no rectangle.
ByteWriter bytes_of(const ShapeFigures& figures);
/// What `bytes_of` made. Throws `Error` for other bytes, and for a mask of more than `most_cells` cells.
ShapeFigures read_shape(patch_program_format::ByteReader& in, std::size_t most_cells);

}  // namespace wale
