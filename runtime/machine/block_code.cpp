#include "runtime/machine/block_code.hpp"

#include <array>

#include "runtime/machine/meaning.hpp"

// Operands share a row with the destination exactly or not at all, so lanes never depend on one another.
#if defined(__clang__)
#define WALE_LANES_ARE_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define WALE_LANES_ARE_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace wale {
namespace {

template <bool uniform>
float lane_of(const float* operand, std::size_t lane, float shared) {
  if constexpr (uniform) {
    return shared;
  } else {
    return operand[lane];
  }
}

/// One operation over a block, for one choice of uniform operands.
template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
[[gnu::always_inline]] inline void apply(float* destination, const float* as, const float* bs, const float* cs) {
  const float shared_a = *as, shared_b = *bs, shared_c = *cs;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    destination[lane] =
        Meaning<operation>::of(lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b),
                               lane_of<uniform_c>(cs, lane, shared_c));
  }
}

template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
void narrow_kernel(float* destination, const float* as, const float* bs, const float* cs, const Lookup&, const float*) {
  apply<operation, uniform_a, uniform_b, uniform_c>(destination, as, bs, cs);
}

#if defined(__x86_64__)
/// The same in vectors of eight floats. Each lane goes through the same operations, so its bits are the same.
template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
[[gnu::target("avx2")]] void wide_kernel(float* destination, const float* as, const float* bs, const float* cs,
                                         const Lookup&, const float*) {
  apply<operation, uniform_a, uniform_b, uniform_c>(destination, as, bs, cs);
}

const bool has_wide_vectors = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0;
}();
#endif

/// The kernel that suits this processor best.
template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
Kernel kernel() {
#if defined(__x86_64__)
  if (has_wide_vectors) return wide_kernel<operation, uniform_a, uniform_b, uniform_c>;
#endif
  return narrow_kernel<operation, uniform_a, uniform_b, uniform_c>;
}

template <bool uniform_a, bool uniform_b>
void sample_kernel(float* destination, const float* as, const float* bs, const float*, const Lookup& lookup,
                   const float*) {
  const float shared_a = *as, shared_b = *bs;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const SplineSample sample =
        sample_of(*lookup.spline, lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b));
    destination[lane] = sample.value;
    destination[row_stride + lane] = sample.along_a;
    destination[2 * row_stride + lane] = sample.along_b;
  }
}

template <bool uniform_a, bool uniform_b>
void recall_kernel(float* destination, const float* as, const float* bs, const float*, const Lookup& lookup,
                   const float* cells) {
  const float shared_a = *as, shared_b = *bs;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const GridSample sample =
        recall_of(*lookup.grid, cells, lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b));
    destination[lane] = sample.value;
    destination[row_stride + lane] = sample.along_a;
    destination[2 * row_stride + lane] = sample.along_b;
  }
}

template <bool uniform_a, bool uniform_b>
void cell_kernel(float* destination, const float* as, const float* bs, const float*, const Lookup& lookup,
                 const float* cells) {
  const float shared_a = *as, shared_b = *bs;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    destination[lane] =
        cells[cell_at(*lookup.grid, lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b))];
  }
}

/// Kernels of one operation, by which operands are uniform: a counts 1, b 2, c 4.
using Variants = std::array<Kernel, 8>;

/// Of an operation that reads a and b only.
Variants with_two_operands(const std::array<Kernel, 4>& all) {
  return {all[0], all[1], all[2], all[3], all[0], all[1], all[2], all[3]};
}

/// An operand that an operation does not read is uniform in all its variants, which are then made once.
template <Operation operation>
Variants variants() {
  constexpr bool a = facts(operation).fields[0] != 'r';
  constexpr bool b = facts(operation).fields[1] != 'r';
  constexpr bool c = facts(operation).fields[2] != 'r';
  if constexpr (operation == Operation::peak) {
    return {};  // only setup runs peaks, and it has one lane
  } else if constexpr (operation == Operation::sample) {
    return with_two_operands({sample_kernel<false, false>, sample_kernel<true, false>, sample_kernel<false, true>,
                              sample_kernel<true, true>});
  } else if constexpr (operation == Operation::recall) {
    return with_two_operands({recall_kernel<false, false>, recall_kernel<true, false>, recall_kernel<false, true>,
                              recall_kernel<true, true>});
  } else if constexpr (operation == Operation::cell) {
    return with_two_operands(
        {cell_kernel<false, false>, cell_kernel<true, false>, cell_kernel<false, true>, cell_kernel<true, true>});
  } else {
    return {kernel<operation, a, b, c>(),       kernel<operation, true, b, c>(),
            kernel<operation, a, true, c>(),    kernel<operation, true, true, c>(),
            kernel<operation, a, b, true>(),    kernel<operation, true, b, true>(),
            kernel<operation, a, true, true>(), kernel<operation, true, true, true>()};
  }
}

/// The kernels of every operation, by its number.
const std::array<Variants, operation_table.size()> all_variants = [] {
  std::array<Variants, operation_table.size()> all{};
  // clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  all[number] = variants<Operation::name>();
#define SPECIAL(number, name, fields, results, cost) \
  all[number] = variants<Operation::name>();
#include "schema/instruction.def"
  // clang-format on
  return all;
}();

}  // namespace

BlockOperand block_operand(RegisterNumber first_state, RegisterNumber number) {
  constexpr auto first_four = static_cast<RegisterNumber>(Input::velocity_y);
  constexpr auto others = static_cast<RegisterNumber>(Input::acceleration_x);
  constexpr auto last = static_cast<RegisterNumber>(Input::button);
  static_assert(first_four + 1 + last - others + 1 == input_rows);
  if (number <= first_four) return {number, false};
  if (number >= others && number <= last) return {static_cast<std::uint16_t>(number - others + first_four + 1), false};
  if (number < first_state) return {number, true};
  return {static_cast<std::uint16_t>(input_rows + number - first_state), false};
}

BlockCode decode_block(const PatchProgram& program, std::span<const Spline> splines, std::span<const GridShape> grids,
                       std::span<const Instruction> code) {
  BlockCode decoded;
  decoded.reserve(code.size());
  const RegisterNumber first_state = program.first_state();
  for (const Instruction& instruction : code) {
    const OperationFacts& known = operation_table[instruction.operation];
    BlockInstruction& block = decoded.emplace_back();
    if (known.operands > 0) block.a = block_operand(first_state, instruction.a);
    if (known.operands > 1) block.b = block_operand(first_state, instruction.b);
    if (known.operands > 2) block.c = block_operand(first_state, instruction.c);
    if (known.fields[2] == 't') block.lookup.spline = &splines[instruction.c];
    if (known.fields[2] == 'g') block.lookup.grid = &grids[instruction.c];
    const unsigned variant = (block.a.uniform ? 1u : 0u) | (block.b.uniform ? 2u : 0u) | (block.c.uniform ? 4u : 0u);
    block.kernel = all_variants[instruction.operation][variant];
    block.destination = block_operand(first_state, instruction.destination).index;
  }
  return decoded;
}

Block::Block(const PatchProgram& program)
    : rows_((input_rows + program.states.size() + program.temporaries) * row_stride) {}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void Block::run(const BlockCode& code, const float* registers, const float* cells) {
  float* rows = rows_.data();
  const auto place = [rows, registers](BlockOperand operand) {
    return operand.uniform ? registers + operand.index : rows + operand.index * row_stride;
  };
  for (const BlockInstruction& i : code) {
    i.kernel(rows + i.destination * row_stride, place(i.a), place(i.b), place(i.c), i.lookup, cells);
  }
}

}  // namespace wale
