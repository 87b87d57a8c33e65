#pragma once

#include <random>
#include <vector>

#include "tests/machine/random_program.hpp"

namespace wale::prove_test {

/// Random programs. Their constants include infinities, not-a-number and subnormals for odd seeds, and are within -3 ..
/// 3 for even ones, for which proofs give finite bounds.
inline PatchProgram random_program(unsigned seed) {
  example::RandomProgram generator(seed);
  PatchProgram program = generator.make();
  if (seed % 2 == 0) {
    std::uniform_real_distribution<float> ordinary(-3, 3);
    for (std::size_t i = 3; i < program.constants.size(); ++i) program.constants[i] = ordinary(generator.random());
  }
  if (seed % 3 == 0) {
    program.states[2].low = -2;
    program.states[2].high = 5;
  }
  return program;
}

/// A program of the given tick, with the constant 0 in register 32, the device's ceiling in 33, then `constants`. The
/// force along x is the first temporary after the tick.
inline PatchProgram pushing(std::vector<float> constants, std::vector<Parameter> parameters,
                            std::vector<Instruction> (*tick)(unsigned temporary), unsigned temporaries = 8) {
  PatchProgram p = example::least();
  p.constants = {0.0f, 10.0f};
  p.constants.insert(p.constants.end(), constants.begin(), constants.end());
  p.parameters = std::move(parameters);
  p.temporaries = static_cast<std::uint16_t>(temporaries);
  const unsigned first = p.first_temporary();
  p.tick = tick(first);
  p.tick.push_back(example::instruction(Operation::limit, first + temporaries - 1, first, 33));
  p.tick.push_back(example::instruction(Operation::limit, first + temporaries - 2, 32, 33));
  p.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(first + temporaries - 1), 33},
               {OutputQuantity::force, 1, static_cast<RegisterNumber>(first + temporaries - 2), 33}};
  return p;
}

}  // namespace wale::prove_test
