#include "wale/patch.hpp"

#include "runtime/machine/meet_edge.hpp"
#include "runtime/stage/stage_state.hpp"
#include "wale/run.hpp"

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

Hand hand_on(const Now& now, const Placement& placement) {
  Hand hand{.position = glm::vec2(glm::dvec2(now.position) - glm::dvec2(placement.at)),
            .velocity = now.velocity,
            .raw_velocity = now.velocity,
            .workspace = now.position,
            .time = now.time};
  if (placement.shape.is_rectangle()) return hand;
  const Shape stretched = placement.shape.stretched({placement.size.width, placement.size.height});
  const EdgeDistance edge = stretched.edge(hand.position);
  meet_edge(hand, edge.metres, edge.slope);
  return hand;
}

Result<float> Placement::value(std::string_view parameter) const {
  const auto index = index_of(program, parameter);
  if (!index) return index.error();
  return values.at(*index);
}

Result<Placement> Patch::placement() const {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->placement({number_, generation_});
}

Result<Placement> Patch::published() const {
  const auto stage = here(stage_.lock(), no_stage);
  if (!stage) return stage.error();
  return (*stage)->published({number_, generation_});
}

Result<float> Patch::value(std::string_view parameter) const {
  const auto known = placement();
  if (!known) return known.error();
  return known->value(parameter);
}

Result<std::vector<float>> Patch::values() const {
  auto known = placement();
  if (!known) return std::move(known).error();
  return std::move(known->values);
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
