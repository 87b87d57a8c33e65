#pragma once

#include <random>

#include "tests/schema/example_program.hpp"

namespace wale::example {

/// A well-formed program of random instructions: constants of every kind, two parameters, setup with a peak,
/// a tick that mixes all operations and two outputs. The same program for the same seed.
class RandomProgram {
 public:
  explicit RandomProgram(unsigned seed) : random_(seed) {}

  PatchProgram make() {
    PatchProgram p = least();
    p.tick.clear();
    p.constants = {0.0f, 5.0f, 1.0f, -2.5f, 0.37f, 1e-30f, 1e30f, 3e-39f, __builtin_inff(), __builtin_nanf("")};
    for (int i = 0; i < 6; ++i) p.constants.push_back(number());
    p.parameters = {{"one", "", 1, 0.5f, 0.0f, 1.0f, ""}, {"two", "", 1, 0.002f, 0.001f, 0.01f, ""}};
    p.tables = {{5, 4, std::vector<std::uint16_t>(20)}, {2, 9, std::vector<std::uint16_t>(18)}};
    for (auto& table : p.tables) {
      for (auto& code : table.heights) code = static_cast<std::uint16_t>(random_());
    }
    p.setup_registers = 12;
    p.temporaries = 24;
    const unsigned setup = p.first_setup(), temporary = p.first_temporary();

    std::vector<unsigned> shared = {4, 5, 6};
    for (unsigned r = first_constant; r < setup; ++r) shared.push_back(r);
    // A peak between two halves of setup, which sees the first.
    std::vector<unsigned> known = shared;
    write(p.setup, known, setup, 5);
    Peak peak;
    std::vector<unsigned> in_peak = known;
    in_peak.insert(in_peak.end(), {0, 1, 0, 1});
    write(peak.code, in_peak, temporary, 21);
    peak.value = static_cast<RegisterNumber>(temporary + 20);
    peak.half_width = 4;
    peak.half_height = 5;
    peak.points = 300;
    peak.percentile = 0.9f;
    p.peaks = {peak};
    p.setup.push_back(instruction(Operation::peak, setup + 5, 0));
    known.push_back(setup + 5);
    for (unsigned r = setup; r < setup + 5; ++r) known.push_back(r);
    write(p.setup, known, setup + 6, 6);
    for (unsigned r = setup + 6; r < setup + 12; ++r) known.push_back(r);

    std::vector<unsigned> in_tick = known;
    in_tick.insert(in_tick.end(), {0, 1, 2, 3, 0, 1, 2, 3});
    write(p.tick, in_tick, temporary, 21);
    rewrite(p.tick, in_tick, temporary, 60);
    p.tick.push_back(instruction(Operation::limit, temporary + 22, temporary + 20, 17));
    p.tick.push_back(instruction(Operation::limit, temporary + 23, temporary + 19, 18));
    p.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(temporary + 22), 17},
                 {OutputQuantity::force, 1, static_cast<RegisterNumber>(temporary + 23), 18}};
    return p;
  }

  float number() {
    const float size = std::exp2(std::uniform_real_distribution<float>(-12, 12)(random_));
    return random_() % 2 == 0 ? size : -size;
  }

  std::mt19937& random() { return random_; }

 private:
  unsigned any(const std::vector<unsigned>& known) { return known[random_() % known.size()]; }

  Instruction any_instruction(const std::vector<unsigned>& known, unsigned destination, bool room_for_three) {
    for (;;) {
      const unsigned number = random_() % 20;  // any but peak; sample where there is room
      const auto known_facts = operation_facts(number);
      if (!known_facts || (known_facts->results == 3 && !room_for_three)) continue;
      const auto operand = [&](std::size_t i) -> unsigned {
        return known_facts->fields[i] == 'r' ? any(known) : known_facts->fields[i] == 't' ? random_() % 2 : 0;
      };
      const unsigned a = operand(0), b = operand(1), c = operand(2);
      return instruction(static_cast<Operation>(number), destination, a, b, c);
    }
  }

  /// Defines `count` registers from `first` on, in order.
  void write(std::vector<Instruction>& code, std::vector<unsigned>& known, unsigned first, unsigned count) {
    for (unsigned r = first; r < first + count;) {
      const Instruction i = any_instruction(known, r, r + 3 <= first + count);
      code.push_back(i);
      for (int result = 0; result < facts(static_cast<Operation>(i.operation)).results; ++result) known.push_back(r++);
    }
  }

  /// Overwrites registers that are defined, so that destinations meet operands in every way.
  void rewrite(std::vector<Instruction>& code, const std::vector<unsigned>& known, unsigned first, int count) {
    for (int i = 0; i < count; ++i) code.push_back(any_instruction(known, first + random_() % 19, true));
  }

  std::mt19937 random_;
};

}  // namespace wale::example
