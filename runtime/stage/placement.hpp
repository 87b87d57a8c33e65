#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale {

/// A patch as the caller placed it; owned by the control side.
struct Placement {
  Program program;
  glm::vec2 position;
  PatchSize size;
  float layer;
  std::vector<float> parameters;
  std::shared_ptr<Memory> memory;
  bool moves = false;  ///< it has been moved, so it is searched separately from the patches that stay

  Placement(const Program& placed, glm::vec2 where, PatchSize how_large, float how_far_in_front)
      : program(placed),
        position(where),
        size(how_large),
        layer(how_far_in_front),
        parameters(placed.default_parameters()),
        memory(std::make_shared<Memory>(placed)) {}

  /// The same patch with another program. Parameters of the same name and unit keep their values if they were set.
  Placement(const Placement& old, const Program& replacing)
      : program(replacing),
        position(old.position),
        size(old.size == old.program.default_size() ? replacing.default_size() : old.size),
        layer(old.layer),
        parameters(replacing.default_parameters()),
        memory(std::make_shared<Memory>(replacing, old.memory)),
        moves(old.moves) {
    const std::vector<Parameter>& known = replacing.description().parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
      const auto before = old.program.parameter(known[i].name);
      if (!before || old.program.description().parameters[*before].si_unit != known[i].si_unit) continue;
      if (old.parameters[*before] == old.program.description().parameters[*before].value) continue;  // it was never set
      parameters[i] = std::clamp(old.parameters[*before], known[i].low, known[i].high);
    }
  }

  Bank bank() const { return Bank(program, parameters, size); }
};

}  // namespace wale
