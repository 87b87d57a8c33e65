#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "runtime/machine/grid.hpp"
#include "runtime/machine/held_state.hpp"
#include "runtime/machine/spline.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// The number of lanes of a block, which run side by side.
inline constexpr std::size_t lanes = 128;
/// Lanes run in whole groups of so many, the widest vectors of any processor.
inline constexpr std::size_t lanes_at_once = 16;
/// Floats from one row of lanes to the next: the lanes and one more cache line, so that rows do not collide in the
/// cache.
inline constexpr std::size_t row_stride = lanes + 16;

/// The tables and grids that instructions read besides registers.
struct Lookup {
  const Spline* spline = nullptr;
  const GridShape* grid = nullptr;
};

/// Applies an operation to the first `count` lanes of a block, a multiple of `lanes_at_once`. Each operand is a row of
/// lanes, or one float in the variants that take it as uniform. `cells` has the cells of all grids.
using Kernel = void (*)(float* destination, const float* a, const float* b, const float* c, const Lookup& lookup,
                        const float* cells, std::size_t count);

/// An operand of a block: a row of lanes, or a register of the bank that is the same for all lanes.
struct BlockOperand {
  std::uint16_t index = 0;
  bool uniform = true;
};

struct BlockInstruction {
  Kernel kernel = nullptr;
  std::uint16_t destination = 0;  ///< row
  BlockOperand a, b, c;
  Lookup lookup;
};

using BlockCode = std::vector<BlockInstruction>;

/// The rows of lanes are, in this order, the inputs that change from tick to tick, the states and the temporaries. All
/// other registers are uniform.
inline constexpr std::uint16_t input_rows = changing_inputs;

/// The operand for a register, in a program whose states begin at register `first_state`.
BlockOperand block_operand(RegisterNumber first_state, RegisterNumber number);
inline BlockOperand block_operand(const PatchProgram& program, RegisterNumber number) {
  return block_operand(program.first_state(), number);
}

/// The processor's instructions that kernels use. Each lane computes the same operations with either choice, so the
/// bits are the same.
enum class Vectors {
  baseline,  ///< those of every processor that the build is for
  widest,    ///< the widest vectors of this processor
};

/// Code of a section other than setup for blocks. It points into `splines` and `grids`.
BlockCode decode_block(const PatchProgram& program, std::span<const std::reference_wrapper<const Spline>> splines,
                       std::span<const GridShape> grids, std::span<const Instruction> code,
                       Vectors vectors = Vectors::widest);

/// The rows of one block.
class Block {
 public:
  /// Room for the program's rows, all zero. Allocates.
  explicit Block(const PatchProgram& program);

  /// `lanes` floats: the row of an operand that is not uniform.
  float* row(BlockOperand operand) { return rows_.data() + operand.index * row_stride; }
  /// Runs code over the first `count` lanes, with uniform operands from `registers` and grids from `cells`, which may be
  /// null for code that reads no grid. Others may be run too. The caller holds a `FloatingPointMode`.
  void run(const BlockCode& code, const float* registers, const float* cells, std::size_t count = lanes);
  /// The next value of a state, by `held_state`: `next` clamped to the rule's range; `otherwise` for not-a-number.
  /// The last two are rows of `lanes` floats. The caller holds a `FloatingPointMode`.
  void hold(BlockOperand next, const float* registers, const StateRule& rule, const float* otherwise, float* held,
            Vectors vectors = Vectors::widest);
  /// Writes the operands' values in the first lanes as pairs, `pairs.size()` of them: forces from their components.
  void pairs(BlockOperand x, BlockOperand y, const float* registers, std::span<glm::vec2> pairs) const;
  /// The value of an operand in a lane.
  float value(BlockOperand operand, std::size_t lane, const float* registers) const {
    return operand.uniform ? registers[operand.index] : rows_[operand.index * row_stride + lane];
  }

 private:
  std::vector<float> rows_;
};

}  // namespace wale
