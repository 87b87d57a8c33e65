#include "wale/batch.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/parallel.hpp"
#include "runtime/machine/states.hpp"

namespace wale {
namespace {

/// The constant part of all instances: program, registers and cells of grids.
struct Shared {
  Program program;
  std::vector<float> registers;
  std::vector<float> cells;

  Shared(const Bank& bank, const Memory* grids)
      : program(bank.program()), registers(bank.registers().begin(), bank.registers().end()) {
    const bool belongs = grids != nullptr && &grids->program().decoded() == &program.decoded();
    const std::span<const float> from =
        belongs ? grids->cells() : std::span<const float>(program.decoded().initial_cells);
    cells.assign(from.begin(), from.end());
  }
};

/// The memory of one block of instances: rows of lanes for the states and for their values at the last entry.
class BlockStates {
 public:
  explicit BlockStates(std::span<const StateRule> rules) : rows_(2 * rules.size() * lanes) {
    float* row = rows_.data();
    for (int copy = 0; copy < 2; ++copy)
      for (const StateRule& rule : rules) row = std::fill_n(row, lanes, initial_state(arithmetic::not_a_number, rule));
  }

  float* now(std::size_t index) { return rows_.data() + index * lanes; }
  const float* now(std::size_t index) const { return rows_.data() + index * lanes; }
  float* at_entry(std::size_t index) { return rows_.data() + rows_.size() / 2 + index * lanes; }

 private:
  std::vector<float> rows_;
};

/// Runs the instances of one block, at most `lanes`, in registers of its own.
class Runner {
 public:
  explicit Runner(const Shared& shared)
      : shared_(shared), program_(shared.program.decoded()), block_(program_.description) {}

  void enter(std::span<const Hand> hands, BlockStates& states) {
    const PatchProgram& description = program_.description;
    if (description.states.empty()) return;
    place(hands);
    {
      const FloatingPointMode mode;
      enter_block(program_, block_, shared_.registers.data(), hands.size());
    }
    for (std::size_t i = 0; i < description.states.size(); ++i) {
      std::copy_n(state_row(i), lanes, states.now(i));
      std::copy_n(state_row(i), lanes, states.at_entry(i));
    }
  }

  void tick(std::span<const Hand> hands, std::span<Force> forces, BlockStates& states) {
    const float* registers = shared_.registers.data();
    place(hands);
    for (std::size_t i = 0; i < program_.state_rules.size(); ++i) std::copy_n(states.now(i), lanes, state_row(i));
    {
      const FloatingPointMode mode;
      block_.run(program_.tick.code(), registers, shared_.cells.data(), hands.size());
      remember(states);
    }
    block_.pairs(block_operand(program_.first_state, program_.force_x),
                 block_operand(program_.first_state, program_.force_y), registers, forces);
  }

 private:
  void place(std::span<const Hand> hands) {
    for (const Input input : program_.tick_inputs) {
      float* row = block_.row(block_operand(program_.description, static_cast<RegisterNumber>(input)));
      place_input(input, hands, program_.envelope, row);
    }
  }

  float* state_row(std::size_t index) {
    return block_.row(block_operand(program_.first_state, static_cast<RegisterNumber>(program_.first_state + index)));
  }

#if defined(__GNUC__)
  __attribute__((noinline))  // see FloatingPointMode
#endif
  void
  remember(BlockStates& states) {
    for (std::size_t i = 0; i < program_.state_rules.size(); ++i) {
      const StateRule rule = program_.state_rules[i];
      const BlockOperand next = block_operand(program_.first_state, rule.next);
      block_.hold(next, shared_.registers.data(), rule, states.at_entry(i), states.now(i));
    }
  }

  const Shared& shared_;
  const DecodedProgram& program_;
  Block block_;
};

}  // namespace

struct Batch::Parts {
  Shared shared;
  std::size_t instances;
  std::vector<BlockStates> blocks;
  Runner runner;

  Parts(const Bank& bank, std::size_t count, const Memory* grids)
      : shared(bank, grids),
        instances(count),
        blocks((count + lanes - 1) / lanes, BlockStates(shared.program.decoded().state_rules)),
        runner(shared) {}

  template <class Work>
  void for_each_block(Work work) {
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      const std::size_t first = block * lanes;
      work(blocks[block], first, std::min(lanes, instances - first));
    }
  }
};

Batch::Batch(const Bank& bank, std::size_t instances, const Memory* grids)
    : parts_(std::make_unique<Parts>(bank, instances, grids)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

std::size_t Batch::size() const { return parts_ ? parts_->instances : 0; }

void Batch::enter(std::span<const Hand> hands) {
  if (!parts_) return;
  parts_->for_each_block([&](BlockStates& states, std::size_t first, std::size_t count) {
    parts_->runner.enter(hands.subspan(first, count), states);
  });
}

void Batch::tick(std::span<const Hand> hands, std::span<Force> forces) {
  if (!parts_) return;
  parts_->for_each_block([&](BlockStates& states, std::size_t first, std::size_t count) {
    if (first >= hands.size()) return;
    count = std::min(count, hands.size() - first);
    parts_->runner.tick(hands.subspan(first, count), forces.subspan(first, count), states);
  });
}

float Batch::state(std::size_t index, std::size_t instance) const {
  if (!parts_) return 0;
  return parts_->blocks[instance / lanes].now(index)[instance % lanes];
}

void run_batch(const Bank& bank, std::size_t instances, long ticks, const MoveHands& move, const Memory* grids) {
  const Shared shared(bank, grids);
  in_parallel((instances + lanes - 1) / lanes, [&](std::size_t begin, std::size_t end) {
    Runner runner(shared);
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t first = block * lanes, count = std::min(lanes, instances - first);
      BlockStates states(shared.program.decoded().state_rules);
      std::array<Hand, lanes> hand_of;
      std::array<Force, lanes> force_on;
      force_on.fill(Force(0));
      const std::span<Hand> hands(hand_of.data(), count);
      const std::span<Force> forces(force_on.data(), count);
      for (long tick = 0; tick < ticks; ++tick) {
        move(first, tick, forces, hands);
        if (tick == 0) runner.enter(hands, states);
        runner.tick(hands, forces, states);
      }
      move(first, ticks, forces, hands);
    }
  });
}

}  // namespace wale
