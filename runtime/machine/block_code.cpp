#include "runtime/machine/block_code.hpp"

#include <algorithm>
#include <array>

#include "runtime/machine/held_state.hpp"
#include "runtime/machine/meaning.hpp"

// The row of an operand is either the destination's or does not overlap it, so no lane depends on another one.
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

/// Tells the compiler that no lanes are left behind the last vector.
constexpr std::size_t whole_groups(std::size_t count) { return count / lanes_at_once * lanes_at_once; }

/// One operation over a block, for one choice of uniform operands.
template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
[[gnu::always_inline]] inline void apply(float* destination, const float* as, const float* bs, const float* cs,
                                         std::size_t count) {
  const std::size_t end = whole_groups(count);
  const float shared_a = *as, shared_b = *bs, shared_c = *cs;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < end; ++lane) {
    destination[lane] =
        Meaning<operation>::of(lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b),
                               lane_of<uniform_c>(cs, lane, shared_c));
  }
}

template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
void narrow_kernel(float* destination, const float* as, const float* bs, const float* cs, const Lookup&, const float*,
                   std::size_t count) {
  apply<operation, uniform_a, uniform_b, uniform_c>(destination, as, bs, cs, count);
}

#if defined(__x86_64__)
bool has_wide_vectors() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

/// The same in vectors of eight floats.
template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
[[gnu::target("avx2")]] void wide_kernel(float* destination, const float* as, const float* bs, const float* cs,
                                         const Lookup&, const float*, std::size_t count) {
  apply<operation, uniform_a, uniform_b, uniform_c>(destination, as, bs, cs, count);
}
#else
constexpr bool has_wide_vectors() { return false; }
#endif

template <Operation operation, bool uniform_a, bool uniform_b, bool uniform_c>
Kernel kernel([[maybe_unused]] bool wide) {
#if defined(__x86_64__)
  if (wide) return wide_kernel<operation, uniform_a, uniform_b, uniform_c>;
#endif
  return narrow_kernel<operation, uniform_a, uniform_b, uniform_c>;
}

// Look-ups run in two loops, first over the places and then over the values there, so that the compiler makes gathers
// of the second loop.

template <bool uniform_a, bool uniform_b>
[[gnu::always_inline]] inline void look_up_spline(float* destination, const float* as, const float* bs,
                                                  const Spline& spline, std::size_t count) {
  const std::size_t end = whole_groups(count);
  const float shared_a = *as, shared_b = *bs;
  std::int32_t corner[lanes];
  float along_a[lanes], along_b[lanes], sign_a[lanes], sign_b[lanes];
  const float last_column = spline.last_column, last_row = spline.last_row;
  const std::uint32_t stride = spline.stride;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < end; ++lane) {
    const MirroredCoordinate column = mirrored(lane_of<uniform_a>(as, lane, shared_a), last_column);
    const MirroredCoordinate row = mirrored(lane_of<uniform_b>(bs, lane, shared_b), last_row);
    corner[lane] = static_cast<std::int32_t>(row.cell * stride + column.cell);
    along_a[lane] = column.fraction;
    along_b[lane] = row.fraction;
    sign_a[lane] = column.sign;
    sign_b[lane] = row.sign;
  }
  // The sixteen coefficients of each lane.
  float found[16][lanes];
  const float* coefficients = spline.coefficients.data();
  for (std::uint32_t j = 0; j < 4; ++j) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const float* first = coefficients + (std::size_t{j} * stride + i);
      float* row = found[4 * j + i];
      WALE_LANES_ARE_INDEPENDENT
      for (std::size_t lane = 0; lane < end; ++lane) row[lane] = first[corner[lane]];
    }
  }
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < end; ++lane) {
    const SplineSample sample = sample_among([&](int j, int i) { return found[4 * j + i][lane]; },
                                             CubicWeights(along_a[lane]), CubicWeights(along_b[lane]));
    destination[lane] = sample.value;
    destination[row_stride + lane] = sign_a[lane] * sample.along_a;
    destination[2 * row_stride + lane] = sign_b[lane] * sample.along_b;
  }
}

template <bool uniform_a, bool uniform_b>
[[gnu::always_inline]] inline void look_up_grid(float* destination, const float* as, const float* bs,
                                                const GridShape& shape, const float* cells, std::size_t count) {
  const std::size_t end = whole_groups(count);
  const float shared_a = *as, shared_b = *bs;
  const GridShape grid = shape;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < end; ++lane) {
    const GridSample sample =
        recall_of(grid, cells, lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b));
    destination[lane] = sample.value;
    destination[row_stride + lane] = sample.along_a;
    destination[2 * row_stride + lane] = sample.along_b;
  }
}

template <bool uniform_a, bool uniform_b>
[[gnu::always_inline]] inline void look_up_cell(float* destination, const float* as, const float* bs,
                                                const GridShape& shape, const float* cells, std::size_t count) {
  const std::size_t end = whole_groups(count);
  const float shared_a = *as, shared_b = *bs;
  const GridShape grid = shape;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < end; ++lane) {
    destination[lane] =
        cells[cell_at(grid, lane_of<uniform_a>(as, lane, shared_a), lane_of<uniform_b>(bs, lane, shared_b))];
  }
}

template <Operation operation, bool uniform_a, bool uniform_b>
[[gnu::always_inline]] inline void look_up(float* destination, const float* as, const float* bs, const Lookup& lookup,
                                           const float* cells, std::size_t count) {
  if constexpr (operation == Operation::sample) {
    look_up_spline<uniform_a, uniform_b>(destination, as, bs, *lookup.spline, count);
  } else if constexpr (operation == Operation::recall) {
    look_up_grid<uniform_a, uniform_b>(destination, as, bs, *lookup.grid, cells, count);
  } else {
    look_up_cell<uniform_a, uniform_b>(destination, as, bs, *lookup.grid, cells, count);
  }
}

template <Operation operation, bool uniform_a, bool uniform_b>
void narrow_look_up(float* destination, const float* as, const float* bs, const float*, const Lookup& lookup,
                    const float* cells, std::size_t count) {
  look_up<operation, uniform_a, uniform_b>(destination, as, bs, lookup, cells, count);
}

#if defined(__x86_64__)
template <Operation operation, bool uniform_a, bool uniform_b>
[[gnu::target("avx2")]] void wide_look_up(float* destination, const float* as, const float* bs, const float*,
                                          const Lookup& lookup, const float* cells, std::size_t count) {
  look_up<operation, uniform_a, uniform_b>(destination, as, bs, lookup, cells, count);
}
#endif

template <Operation operation, bool uniform_a, bool uniform_b>
Kernel look_up_kernel([[maybe_unused]] bool wide) {
#if defined(__x86_64__)
  if (wide) return wide_look_up<operation, uniform_a, uniform_b>;
#endif
  return narrow_look_up<operation, uniform_a, uniform_b>;
}

/// The kernels of one operation. The index says which operands are uniform: a counts 1, b 2, c 4.
using Variants = std::array<Kernel, 8>;

/// The kernels of an operation that reads a table or grid at a and b.
template <Operation operation>
Variants look_up_variants(bool wide) {
  const Kernel all[] = {look_up_kernel<operation, false, false>(wide), look_up_kernel<operation, true, false>(wide),
                        look_up_kernel<operation, false, true>(wide), look_up_kernel<operation, true, true>(wide)};
  return {all[0], all[1], all[2], all[3], all[0], all[1], all[2], all[3]};
}

/// An operand that an operation does not read counts as uniform in all variants, so that they share one kernel.
template <Operation operation>
Variants variants(bool wide) {
  constexpr bool a = facts(operation).fields[0] != 'r';
  constexpr bool b = facts(operation).fields[1] != 'r';
  constexpr bool c = facts(operation).fields[2] != 'r';
  if constexpr (operation == Operation::peak) {
    return {};  // only setup runs peaks, and it has one lane
  } else if constexpr (operation == Operation::sample || operation == Operation::recall ||
                       operation == Operation::cell) {
    return look_up_variants<operation>(wide);
  } else {
    return {kernel<operation, a, b, c>(wide),       kernel<operation, true, b, c>(wide),
            kernel<operation, a, true, c>(wide),    kernel<operation, true, true, c>(wide),
            kernel<operation, a, b, true>(wide),    kernel<operation, true, b, true>(wide),
            kernel<operation, a, true, true>(wide), kernel<operation, true, true, true>(wide)};
  }
}

/// The kernels of every operation, by its number.
using Kernels = std::array<Variants, operation_table.size()>;

Kernels all_kernels(bool wide) {
  Kernels all{};
  // clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  all[number] = variants<Operation::name>(wide);
#define SPECIAL(number, name, fields, results, cost) \
  all[number] = variants<Operation::name>(wide);
#include "wale/instruction.def"
  // clang-format on
  return all;
}

const Kernels& kernels_of(Vectors vectors) {
  static const Kernels baseline = all_kernels(false), widest = all_kernels(has_wide_vectors());
  return vectors == Vectors::widest ? widest : baseline;
}

/// Computes a state's row at the end of a tick; `next` is one value for all lanes, or a row.
template <bool uniform>
[[gnu::always_inline]] inline void hold_row(const float* next, const StateRule& rule, const float* otherwise,
                                            float* held) {
  const float shared = *next;
  WALE_LANES_ARE_INDEPENDENT
  for (std::size_t lane = 0; lane < lanes; ++lane)
    held[lane] = held_state(lane_of<uniform>(next, lane, shared), rule, otherwise[lane]);
}

void narrow_hold(const float* next, bool uniform, const StateRule& rule, const float* otherwise, float* held) {
  uniform ? hold_row<true>(next, rule, otherwise, held) : hold_row<false>(next, rule, otherwise, held);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void wide_hold(const float* next, bool uniform, const StateRule& rule, const float* otherwise,
                                       float* held) {
  uniform ? hold_row<true>(next, rule, otherwise, held) : hold_row<false>(next, rule, otherwise, held);
}
#endif

}  // namespace

BlockOperand block_operand(RegisterNumber first_state, RegisterNumber number) {
  // For each input, the number of earlier inputs that change from tick to tick.
  static constexpr auto row_of_input = [] {
    std::array<std::uint16_t, first_constant> rows{};
    for (std::size_t i = 1; i < rows.size(); ++i)
      rows[i] = static_cast<std::uint16_t>(rows[i - 1] + input_table[i - 1].changes);
    return rows;
  }();
  if (number < first_constant && input_table[number].changes) return {row_of_input[number], false};
  if (number < first_state) return {number, true};
  return {static_cast<std::uint16_t>(input_rows + number - first_state), false};
}

// Once for each program, so it is compiled to be small.
[[gnu::cold]]
BlockCode decode_block(const PatchProgram& program, std::span<const std::reference_wrapper<const Spline>> splines,
                       std::span<const GridShape> grids, std::span<const Instruction> code, Vectors vectors) {
  BlockCode decoded(code.size());
  if (code.empty()) return decoded;
  const Kernels& kernels = kernels_of(vectors);
  // Instructions name the same registers many times, so each register's place is computed once.
  std::vector<BlockOperand> places(program.register_count());
  for (std::size_t number = 0; number < places.size(); ++number)
    places[number] = block_operand(program.first_state(), static_cast<RegisterNumber>(number));
  BlockInstruction* next = decoded.data();
  for (const Instruction& instruction : code) {
    const OperationFacts& known = operation_table[instruction.operation];
    BlockInstruction& block = *next++;
    unsigned variant = 0b111;
    const auto place = [&](BlockOperand& operand, RegisterNumber number, unsigned bit) {
      operand = places[number];
      if (!operand.uniform) variant &= ~bit;
    };
    if (known.operands > 0) place(block.a, instruction.a, 1);
    if (known.operands > 1) place(block.b, instruction.b, 2);
    if (known.operands > 2)
      place(block.c, instruction.c, 4);
    else if (known.fields[2] == 't')
      block.lookup.spline = &splines[instruction.c].get();
    else if (known.fields[2] == 'g')
      block.lookup.grid = &grids[instruction.c];
    block.kernel = kernels[instruction.operation][variant];
    block.destination = places[instruction.destination].index;
  }
  return decoded;
}

Block::Block(const PatchProgram& program)
    : rows_((input_rows + program.states.size() + program.temporaries) * row_stride) {}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void Block::run(const BlockCode& code, const float* registers, const float* cells, std::size_t count) {
  float* rows = rows_.data();
  const std::size_t run = std::min(lanes, (count + lanes_at_once - 1) / lanes_at_once * lanes_at_once);
  const auto place = [rows, registers](BlockOperand operand) {
    return operand.uniform ? registers + operand.index : rows + operand.index * row_stride;
  };
  for (const BlockInstruction& i : code) {
    i.kernel(rows + i.destination * row_stride, place(i.a), place(i.b), place(i.c), i.lookup, cells, run);
  }
}

void Block::pairs(BlockOperand x, BlockOperand y, const float* registers, std::span<glm::vec2> pairs) const {
  if (x.uniform || y.uniform) {
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {value(x, i, registers), value(y, i, registers)};
    return;
  }
  const float* xs = rows_.data() + x.index * row_stride;
  const float* ys = rows_.data() + y.index * row_stride;
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {xs[i], ys[i]};
}

void Block::hold(BlockOperand next, const float* registers, const StateRule& rule, const float* otherwise, float* held,
                 [[maybe_unused]] Vectors vectors) {
  const float* from = next.uniform ? registers + next.index : row(next);
#if defined(__x86_64__)
  if (vectors == Vectors::widest && has_wide_vectors()) return wide_hold(from, next.uniform, rule, otherwise, held);
#endif
  narrow_hold(from, next.uniform, rule, otherwise, held);
}

}  // namespace wale
