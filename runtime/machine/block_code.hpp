#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "runtime/machine/grid.hpp"
#include "runtime/machine/held_state.hpp"
#include "runtime/machine/spline.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// Lanes that one block runs side by side.
inline constexpr std::size_t lanes = 128;
/// Floats from one row of lanes to the next: a cache line more than the lanes, so that rows do not collide in cache.
inline constexpr std::size_t row_stride = lanes + 16;

/// What an instruction looks into besides its registers.
struct Lookup {
  const Spline* spline = nullptr;
  const GridShape* grid = nullptr;
};

/// Applies an operation to a block. An operand is a row of lanes or, for the variants made so, one uniform float.
/// `cells` are those of all grids.
using Kernel = void (*)(float* destination, const float* a, const float* b, const float* c, const Lookup& lookup,
                        const float* cells);

/// Where a block finds an operand: a row of lanes, or a register of the bank that is the same for all.
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

/// Rows of lanes stand for the inputs that change from tick to tick, the states and the temporaries, in this order; all
/// else is uniform.
inline constexpr std::uint16_t input_rows = changing_inputs;

/// Where a register is found by a block of a program whose states begin at register `first_state`.
BlockOperand block_operand(RegisterNumber first_state, RegisterNumber number);
inline BlockOperand block_operand(const PatchProgram& program, RegisterNumber number) {
  return block_operand(program.first_state(), number);
}

/// Which of the processor's instructions kernels use. Each lane goes through the same operations in either, so its bits
/// are the same.
enum class Vectors {
  baseline,  ///< what every processor has that the build is for
  widest,    ///< the best that this processor has
};

/// Code of a section other than setup for blocks. It points into `splines` and `grids`.
BlockCode decode_block(const PatchProgram& program, std::span<const std::reference_wrapper<const Spline>> splines,
                       std::span<const GridShape> grids, std::span<const Instruction> code,
                       Vectors vectors = Vectors::widest);

/// The rows of one block at work.
class Block {
 public:
  /// Room for the program's rows, all zero. Allocates.
  explicit Block(const PatchProgram& program);

  /// `lanes` floats: the row of an operand that is not uniform.
  float* row(BlockOperand operand) { return rows_.data() + operand.index * row_stride; }
  /// Runs code over all lanes, with uniform operands out of `registers` and grids out of `cells`, which code that looks
  /// at no grid does without. The caller holds a `FloatingPointMode`.
  void run(const BlockCode& code, const float* registers, const float* cells);
  /// What becomes of a state, as `held_state` says: `next` within the rule's range, or `otherwise` for not-a-number.
  /// The last two are rows of `lanes` floats. The caller holds a `FloatingPointMode`.
  void hold(BlockOperand next, const float* registers, const StateRule& rule, const float* otherwise, float* held,
            Vectors vectors = Vectors::widest);
  /// Pairs of operands, as many as `pairs` has room for: forces from their components.
  void pairs(BlockOperand x, BlockOperand y, const float* registers, std::span<glm::vec2> pairs) const;
  /// The value of an operand in a lane.
  float value(BlockOperand operand, std::size_t lane, const float* registers) const {
    return operand.uniform ? registers[operand.index] : rows_[operand.index * row_stride + lane];
  }

 private:
  std::vector<float> rows_;
};

}  // namespace wale
