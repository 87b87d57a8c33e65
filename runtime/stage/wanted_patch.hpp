#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/front_most.hpp"
#include "wale/patch.hpp"
#include "wale/program.hpp"
#include "wale/shape.hpp"

namespace wale {

/// A patch as its caller wants it; a value of the control side.
struct WantedPatch {
  Program program;
  std::vector<float> parameters;  ///< SI, as the program lists them
  PatchSize size;
  glm::vec2 position{0};  ///< m from the workspace's centre
  float layer = 0;
  std::uint64_t order = 0;  ///< of its arrival in its layer
  bool enabled = true;
  Shape shape;  ///< of its own size; a placed patch has it stretched

  WantedPatch(const Program& placed, glm::vec2 where, PatchSize how_large, float how_far_in_front, Shape which_part = {})
      : program(placed),
        parameters(placed.default_parameters()),
        size(how_large),
        position(where),
        layer(how_far_in_front),
        shape(std::move(which_part)) {}

  /// The size of a patch that is given none.
  static PatchSize own_size(const Program& program, const Shape& shape) {
    PatchSize size = program.default_size();
    if (!shape.is_rectangle()) size.width = shape.size().x, size.height = shape.size().y;
    return size;
  }

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
    if (size == own_size(program, shape)) size = own_size(replacing, shape);
    parameters = std::move(values);
    program = replacing;
  }

  BankKey key() const { return {program, parameters, size}; }

  /// For whoever asks how the patch is.
  Placement told() const {
    return {.program = program,
            .values = parameters,
            .at = position,
            .size = size,
            .layer = layer,
            .enabled = enabled,
            .shape = shape};
  }
};

}  // namespace wale
