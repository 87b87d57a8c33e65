#pragma once

#include <memory>
#include <span>

#include "runtime/stage/placed_patches.hpp"

/// Patches for a player without a stage.
namespace wale {

/// A patch at a place, with a memory and a bank of its own unless they are given.
inline PlacedPatch patch_of(const Program& program, std::uint32_t number = 0, glm::vec2 at = glm::vec2(0.0f),
                            std::optional<PatchSize> size = std::nullopt, std::shared_ptr<Memory> memory = nullptr) {
  auto bank = std::make_shared<const PreparedBank>(
      Bank(program, program.default_parameters(), size.value_or(program.default_size())));
  const PatchSize real = bank->bank.size();
  return {.bank = std::move(bank),
          .memory = memory ? std::move(memory) : std::make_shared<Memory>(program),
          .outline = {at, real.width, real.height},
          .number = number};
}

/// One patch alone.
inline PlacedPatches placed(const Program& program, std::uint32_t revision = 0) {
  Arrangement all;
  all.put(patch_of(program));
  return all.hand_over(revision);
}

}  // namespace wale
