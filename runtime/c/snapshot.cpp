#include "wale/snapshot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"
#include "wale/picture.hpp"
#include "wale/run.hpp"

struct WaleSnapshot {
  wale::Snapshot snapshot;
};

using namespace wale::c;

WaleCode wale_patch_snapshot(const WalePatch* patch, WaleSnapshot** snapshot, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("snapshot", snapshot); !clear) return clear;
    if (auto given = is_given("patch", patch); !given) return given;
    auto made = patch->patch.snapshot();
    if (!made) return std::move(made).error();
    hand_out(std::make_unique<WaleSnapshot>(WaleSnapshot{*std::move(made)}), snapshot);
    return {};
  });
}

void wale_snapshot_free(WaleSnapshot* snapshot) { free_handle(snapshot); }

WaleCode wale_snapshot_placement(const WaleSnapshot* snapshot, WalePlacement** placement, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("placement", placement); !clear) return clear;
    if (auto given = is_given("snapshot", snapshot); !given) return given;
    hand_out(std::make_unique<WalePlacement>(WalePlacement{snapshot->snapshot.placement}), placement);
    return {};
  });
}

const float* wale_snapshot_states(const WaleSnapshot* snapshot, size_t* count) {
  if (count != nullptr) *count = 0;
  if (snapshot == nullptr) return nullptr;
  const auto states = snapshot->snapshot.memory.states();
  if (count != nullptr) *count = states.size();
  return states.data();
}

WaleText wale_snapshot_state_name(const WaleSnapshot* snapshot, size_t index) {
  if (snapshot == nullptr) return text_of({});
  const auto& states = snapshot->snapshot.memory.program().description().states;
  return index < states.size() ? text_of(states[index].name) : text_of({});
}

WaleCode wale_snapshot_grid(const WaleSnapshot* snapshot, size_t index, WaleGrid* grid, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("snapshot", snapshot); !given) return given;
    if (auto sized = is_sized("grid", grid); !sized) return sized;
    const wale::Memory& memory = snapshot->snapshot.memory;
    const auto& all = memory.program().description().grids;
    if (auto there = is_there(index, all.size()); !there) return there;
    write_sized(grid, {.name = text_of(all[index].name),
                       .si_unit = text_of(all[index].si_unit),
                       .columns = all[index].columns,
                       .rows = all[index].rows,
                       .cells = memory.grid(index).data()});
    return {};
  });
}

WaleCode wale_snapshot_surface(WaleSnapshot* snapshot, const WaleVector* places, size_t count, float* heights,
                               float* colours, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("snapshot", snapshot); !given) return given;
    if (count == 0) return {};
    if (auto given = is_given("places", places); !given) return given;
    if (auto given = is_given("heights", heights); !given) return given;
    for (std::size_t i = 0; i < count; ++i)
      if (!std::isfinite(places[i].x) || !std::isfinite(places[i].y))
        return about_argument("places", "expected finite numbers", "give m from the patch's centre");
    const wale::Snapshot& of = snapshot->snapshot;
    const bool wants_colour = colours != nullptr && of.bank.program().description().picture.colour.has_value();
    constexpr std::size_t block = 4096;
    std::vector<glm::vec2> positions(std::min(count, block));
    std::vector<glm::vec3> painted(wants_colour ? positions.size() : 0);
    for (std::size_t first = 0; first < count; first += block) {
      const std::size_t some = std::min(block, count - first);
      for (std::size_t i = 0; i < some; ++i) positions[i] = {places[first + i].x, places[first + i].y};
      wale::surface_all(of.bank, &of.memory, std::span(positions).first(some), std::span(heights + first, some),
                        std::span(painted).first(wants_colour ? some : 0));
      for (std::size_t i = 0; wants_colour && i < some; ++i)
        for (int channel = 0; channel < 3; ++channel) colours[3 * (first + i) + channel] = painted[i][channel];
    }
    return {};
  });
}

WaleCode wale_snapshot_show(WaleSnapshot* snapshot, WaleVector position, WaleVector velocity, double time,
                            WaleMark* marks, size_t capacity, size_t* count, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("count", count); !given) return given;
    *count = 0;
    if (auto given = is_given("snapshot", snapshot); !given) return given;
    for (const double each : {double{position.x}, double{position.y}, double{velocity.x}, double{velocity.y}, time})
      if (!std::isfinite(each))
        return about_argument("position", "expected a finite position, velocity and time", "give m, m/s and s");
    const wale::Placement& placement = snapshot->snapshot.placement;
    const wale::Now now{.time = time,
                        .position = glm::vec2(position.x, position.y) + placement.at,
                        .velocity = {velocity.x, velocity.y}};
    wale::Hand hand = wale::hand_on(now, placement);
    hand.position = {position.x, position.y};  // unrounded
    const auto shown = wale::show(snapshot->snapshot.bank, snapshot->snapshot.memory, hand);
    *count = shown.size();
    if (marks == nullptr || capacity < shown.size()) return {};
    for (const wale::ShownMark& each : shown) {
      marks->kind = static_cast<int32_t>(each.kind);
      marks->colour = each.colour;
      std::copy(each.values.begin(), each.values.end(), marks->values);
      ++marks;
    }
    return {};
  });
}
