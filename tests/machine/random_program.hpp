#pragma once

#include <random>

#include "tests/schema/example_program.hpp"

namespace wale::example {

/// A valid program of random instructions: constants of every kind, two parameters, setup with a peak, states and grids
/// that every permitted section uses, a tick that mixes all operations, two outputs and marks. The same seed gives the
/// same program.
class RandomProgram {
 public:
  explicit RandomProgram(unsigned seed) : random_(seed) {}

  PatchProgram make() {
    PatchProgram p = least();
    p.tick.clear();
    p.constants = {0.0f, 5.0f, 1.0f, -2.5f, 0.37f, 1e-30f, 1e30f, 3e-39f, __builtin_inff(), __builtin_nanf("")};
    for (int i = 0; i < 6; ++i) p.constants.push_back(number());
    p.parameters = {{"one", "", 1, 0.5f, 0.0f, 1.0f, 0.1f, 0.9f, ""},
                    {"two", "", 1, 0.002f, 0.001f, 0.01f, 0.002f, 0.002f, ""}};
    p.tables = {{5, 4, std::vector<std::uint16_t>(20)}, {2, 9, std::vector<std::uint16_t>(18)}};
    for (auto& table : p.tables) {
      for (auto& code : table.heights) code = static_cast<std::uint16_t>(random_());
    }
    p.setup_registers = 12;
    p.temporaries = 24;

    p.states = {{"one", -1.0f, 1.0f}, {"two", 0.25f, 3.0f}, {"three", -1e30f, 1e30f}, {"four", -2.0f, -1.0f}};
    p.grids = {{"field", 7, 5, 0.5f, -10.0f, 10.0f}, {"line", 1, 9, 0.0f, -1.0f, 1.0f}};

    const unsigned setup = p.first_setup(), temporary = p.first_temporary();

    std::vector<unsigned> shared = {4, 5, 6, 18};
    for (unsigned r = first_constant; r < setup; ++r) shared.push_back(r);
    // A peak between two halves of setup. It may read the registers of the first.
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

    std::vector<unsigned> in_picture = known;
    for (unsigned state = 0; state < p.states.size(); ++state) in_picture.push_back(p.first_state() + state);
    in_picture.insert(in_picture.end(), {0, 1, 0, 1});

    std::vector<unsigned> in_enter = known;
    in_enter.insert(in_enter.end(), {0, 1, 2, 3, 0, 1, 2, 3, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17});
    std::vector<unsigned> in_tick = in_enter;
    for (int often = 0; often < 3; ++often) {
      for (unsigned state = 0; state < p.states.size(); ++state) in_tick.push_back(p.first_state() + state);
    }
    write(p.enter, in_enter, temporary, 21);
    rewrite(p.enter, in_enter, temporary, 10);
    grids_ = true;
    std::vector<unsigned> in_frame = in_tick;
    write(p.picture.code, in_picture, temporary, 21);
    p.picture.relief = register_of(in_picture);
    p.picture.colour = std::array{register_of(in_picture), register_of(in_picture), register_of(in_picture)};
    write(p.picture.frame, in_frame, temporary, 21);
    for (const MarkKind kind : {MarkKind::point, MarkKind::box, MarkKind::line, MarkKind::trajectory}) {
      Mark mark{.kind = kind, .colour = static_cast<std::uint32_t>(random_() % 0x1000000)};
      for (std::size_t i = 0; i < mark_operands(kind); ++i) mark.operands[i] = register_of(in_frame);
      p.picture.marks.push_back(mark);
    }

    write(p.tick, in_tick, temporary, 21);
    rewrite(p.tick, in_tick, temporary, 60);
    p.tick.push_back(instruction(Operation::limit, temporary + 22, temporary + 20, first_constant + 1));
    p.tick.push_back(instruction(Operation::limit, temporary + 23, temporary + 19, first_constant + 2));
    p.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(temporary + 22), first_constant + 1},
                 {OutputQuantity::force, 1, static_cast<RegisterNumber>(temporary + 23), first_constant + 2}};
    for (State& state : p.states) {
      state.initial = register_of(in_enter);
      state.next = register_of(in_tick);
    }
    for (const std::uint16_t grid : {0, 1, 0}) {
      p.writes.push_back({grid, register_of(in_tick), register_of(in_tick), register_of(in_tick)});
    }
    return p;
  }

  float number() {
    const float size = std::exp2(std::uniform_real_distribution<float>(-12, 12)(random_));
    return random_() % 2 == 0 ? size : -size;
  }

  std::mt19937& random() { return random_; }

 private:
  unsigned any(const std::vector<unsigned>& known) { return known[random_() % known.size()]; }

  RegisterNumber register_of(const std::vector<unsigned>& known) { return static_cast<RegisterNumber>(any(known)); }

  Instruction any_instruction(const std::vector<unsigned>& known, unsigned destination, bool room_for_three) {
    for (;;) {
      const unsigned number = random_() % 25;  // any but peak; three results where there is room
      const auto known_facts = operation_facts(number);
      if (!known_facts || known_facts->fields[0] == 'p' || (known_facts->results == 3 && !room_for_three)) continue;
      if (known_facts->fields[2] == 'g' && !grids_) continue;
      const auto operand = [&](std::size_t i) -> unsigned {
        return known_facts->fields[i] == 'r' ? any(known) : known_facts->fields[i] != '-' ? random_() % 2 : 0;
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

  /// Appends instructions that overwrite defined registers, so that destinations coincide with operands in every way.
  void rewrite(std::vector<Instruction>& code, const std::vector<unsigned>& known, unsigned first, int count) {
    for (int i = 0; i < count; ++i) code.push_back(any_instruction(known, first + random_() % 19, true));
  }

  std::mt19937 random_;
  bool grids_ = false;  ///< whether the section that is being written may read grids
};

}  // namespace wale::example
