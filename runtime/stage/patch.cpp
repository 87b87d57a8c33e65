#include "wale/patch.hpp"

#include "runtime/stage/stage_state.hpp"

namespace wale {
namespace {

Error no_stage() {
  return wrong_moment("patch", "the patch's stage is gone, or the handle never named a patch",
                      "keep the stage for as long as its patches are used");
}

}  // namespace

Result<> Patch::set(std::string_view parameter, double value) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::set(std::string(parameter), value));
}

Result<> Patch::move(glm::vec2 to) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::move(to));
}

Result<> Patch::resize(PatchSize size) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::resize(size));
}

Result<> Patch::replace(const Program& program) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::replace(program, **stage));
}

Result<> Patch::enable(bool enabled) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::enable(enabled));
}

Result<> Patch::bring(const BringOptions& to) {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->change({number_, generation_}, changes::bring(to.layer, (*stage)->table));
}

Result<> Patch::remove() {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  const std::lock_guard lock((*stage)->mutex);
  const PatchName name{number_, generation_};
  if (auto there = (*stage)->has(name); !there) return there;
  std::vector<PatchTable::Wish> wishes;
  wishes.emplace_back(name, std::nullopt);
  (*stage)->want(std::move(wishes));
  return {};
}

bool Patch::exists() const {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return false;
  const std::lock_guard lock((*stage)->mutex);
  return (*stage)->has({number_, generation_}).has_value();
}

Result<Bank> Patch::bank() const {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->bank({number_, generation_});
}

Result<Snapshot> Patch::snapshot() const {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->snapshot({number_, generation_});
}

}  // namespace wale
