#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/front_most.hpp"
#include "wale/program.hpp"

namespace wale {

/// A patch as its caller wants it; a value of the control side.
struct Placement {
  Program program;
  std::vector<float> parameters;  ///< SI, as the program lists them
  PatchSize size;
  glm::vec2 position{0};  ///< m from the workspace's centre
  float layer = 0;
  std::uint64_t order = 0;  ///< of its arrival in its layer
  bool enabled = true;

  Placement(const Program& placed, glm::vec2 where, PatchSize how_large, float how_far_in_front)
      : program(placed),
        parameters(placed.default_parameters()),
        size(how_large),
        position(where),
        layer(how_far_in_front) {}

  /// Takes another program. A size that was the old program's own becomes the new one's own. Parameters of the same
  /// name and unit keep their values if they were not at their defaults.
  void replace(const Program& replacing) {
    std::vector<float> values = replacing.default_parameters();
    const std::vector<Parameter>& known = replacing.description().parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
      const auto before = program.parameter(known[i].name);
      if (!before || program.description().parameters[*before].si_unit != known[i].si_unit) continue;
      if (parameters[*before] == program.description().parameters[*before].value) continue;  // it was never set
      values[i] = std::clamp(parameters[*before], known[i].low, known[i].high);
    }
    if (size == program.default_size()) size = replacing.default_size();
    parameters = std::move(values);
    program = replacing;
  }

  BankKey key() const { return {program, parameters, size}; }
};

}  // namespace wale
