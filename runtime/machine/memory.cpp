#include "wale/memory.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/held_state.hpp"
#include "runtime/machine/inputs.hpp"
#include "runtime/machine/states.hpp"

namespace wale {

Memory::Memory(const Program& program) : program_(program), cells_(program.decoded().initial_cells) {
  for (const StateRule& rule : program.decoded().state_rules) {
    states_.push_back(initial_state(arithmetic::not_a_number, rule));
  }
  initial_states_ = states_;
}

Memory::Memory(const Program& program, std::shared_ptr<Memory> predecessor) : Memory(program) {
  predecessor_ = std::move(predecessor);
  succeeded_.store(false);
  const PatchProgram &here = program.description(), &there = predecessor_->program().description();
  for (std::size_t i = 0; i < here.states.size(); ++i) {
    const auto same = std::ranges::find(there.states, here.states[i].name, &State::name);
    if (same == there.states.end() || same->si_unit != here.states[i].si_unit) continue;
    kept_states_.emplace_back(static_cast<std::uint16_t>(same - there.states.begin()), static_cast<std::uint16_t>(i));
  }
  const auto same_shape = [](const Grid& a, const Grid& b) {
    return a.name == b.name && a.columns == b.columns && a.rows == b.rows && a.low == b.low && a.high == b.high &&
           a.si_unit == b.si_unit;
  };
  keeps_grids_ = !here.grids.empty() && std::ranges::equal(here.grids, there.grids, same_shape);
}

void Memory::succeed(bool with_states) noexcept {
  if (succeeded_.load(std::memory_order_relaxed)) return;
  predecessor_->succeed(with_states);
  for (const auto& [there, here] : kept_states_) {
    const StateRule& rule = program_.decoded().state_rules[here];
    if (with_states) states_[here] = held_within(predecessor_->states_[there], rule.low, rule.high, states_[here]);
  }
  if (keeps_grids_) cells_.swap(predecessor_->cells_);
  succeeded_.store(true, std::memory_order_release);
}

bool Memory::follows(const Memory* other) const noexcept {
  for (const Memory* each = this; !each->succeeded_.load(std::memory_order_relaxed); each = each->predecessor_.get())
    if (each->predecessor_.get() == other) return true;
  return false;
}

std::size_t Memory::predecessors() const noexcept {
  std::size_t count = 0;
  for (const Memory* each = this; !each->succeeded_.load(std::memory_order_acquire); each = each->predecessor_.get())
    ++count;
  return count;
}

bool Memory::forget_predecessor() {
  if (!succeeded_.load(std::memory_order_acquire)) return false;
  predecessor_.reset();
  return true;
}

std::size_t Memory::copy_from(const Memory& other, std::size_t first, std::size_t most) noexcept {
  if (&program_.decoded() != &other.program_.decoded() || first > cells_.size()) return 0;
  if (first == 0) {
    std::ranges::copy(other.states_, states_.begin());
    std::ranges::copy(other.initial_states_, initial_states_.begin());
    restored_ = other.restored_;
  }
  const std::size_t count = std::min(most, cells_.size() - first);
  std::copy_n(other.cells_.begin() + static_cast<std::ptrdiff_t>(first), count,
              cells_.begin() + static_cast<std::ptrdiff_t>(first));
  return count;
}

void Memory::enter(Bank& bank, const Hand& hand) noexcept {
  const DecodedProgram& program = program_.decoded();
  if (&program != &bank.program().decoded() || states_.empty()) return;
  float* registers = bank.registers().data();
  program.hand_reader(hand, registers);
  {
    const FloatingPointMode mode;
    enter_lane(program, registers);
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i] = initial_states_[i] = registers[program.first_state + i];
    if (std::isnan(registers[program.state_rules[i].initial])) ++restored_;
  }
}

std::span<const float> Memory::grid(std::size_t index) const {
  const GridShape& shape = program_.decoded().grids[index];
  return std::span(cells_).subspan(shape.first, std::size_t{shape.columns} * shape.rows);
}

#if defined(__GNUC__)
__attribute__((noinline))  // see FloatingPointMode
#endif
void Memory::remember(const float* registers) noexcept {
  const DecodedProgram& program = program_.decoded();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const StateRule& rule = program.state_rules[i];
    const float next = registers[rule.next];
    // The processor predicts this branch, so the next tick does not wait for a clamped value.
    if (next >= rule.low && next <= rule.high) [[likely]] {
      states_[i] = next;
    } else {
      states_[i] = held_state(next, rule, initial_states_[i]);
      if (next != next) ++restored_;
    }
  }
  for (const WriteRule& rule : program.write_rules) {
    const float u = registers[rule.u], v = registers[rule.v], value = registers[rule.value];
    if (u != u || v != v || value != value) continue;
    cells_[cell_at(rule.shape, u, v)] = held_within(value, rule.low, rule.high, value);
  }
}

}  // namespace wale
