#include <limits>

#include "runtime/c/shape.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"

using namespace wale::c;

namespace {

/// Gives the placement that `tell()` tells of a patch.
template <class Tell>
WaleCode give_placement(const WalePatch* patch, WalePlacement** placement, WaleError** error, const Tell& tell) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("placement", placement); !clear) return clear;
    if (auto given = is_given("patch", patch); !given) return given;
    wale::Result<wale::Placement> told = tell(patch->patch);
    if (!told) return std::move(told).error();
    hand_out(std::make_unique<WalePlacement>(WalePlacement{*std::move(told)}), placement);
    return {};
  });
}

/// Gives the value that `of(name)` is, of a handle that is the argument `argument`.
template <class Of>
WaleCode give_value(const char* argument, const void* handle, WaleText parameter, float* value, WaleError** error,
                    const Of& of) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("value", value); !given) return given;
    *value = std::numeric_limits<float>::quiet_NaN();
    if (auto given = is_given(argument, handle); !given) return given;
    const auto name = read_text("parameter", parameter);
    if (!name) return name.error();
    const wale::Result<float> known = of(*name);
    if (!known) return known.error();
    *value = *known;
    return {};
  });
}

}  // namespace

WaleCode wale_patch_placement(const WalePatch* patch, WalePlacement** placement, WaleError** error) {
  return give_placement(patch, placement, error, [](const wale::Patch& each) { return each.placement(); });
}

WaleCode wale_patch_published(const WalePatch* patch, WalePlacement** placement, WaleError** error) {
  return give_placement(patch, placement, error, [](const wale::Patch& each) { return each.published(); });
}

WaleCode wale_patch_value(const WalePatch* patch, WaleText parameter, float* value, WaleError** error) {
  return give_value("patch", patch, parameter, value, error,
                    [&](const std::string& name) { return patch->patch.value(name); });
}

void wale_placement_free(WalePlacement* placement) { free_handle(placement); }

WaleCode wale_placement_details(const WalePlacement* placement, WalePlacementDetails* details, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("placement", placement); !given) return given;
    if (auto sized = is_sized("details", details); !sized) return sized;
    const wale::Placement& known = placement->placement;
    write_sized(details, {.x = known.at.x,
                          .y = known.at.y,
                          .width = known.size.width,
                          .height = known.size.height,
                          .rim = known.size.rim,
                          .layer = known.layer,
                          .enabled = known.enabled,
                          .has_shape = !known.shape.is_rectangle(),
                          .values = known.values.size()});
    return {};
  });
}

const float* wale_placement_values(const WalePlacement* placement, size_t* count) {
  if (count != nullptr) *count = placement == nullptr ? 0 : placement->placement.values.size();
  return placement == nullptr ? nullptr : placement->placement.values.data();
}

WaleCode wale_placement_value(const WalePlacement* placement, WaleText parameter, float* value, WaleError** error) {
  return give_value("placement", placement, parameter, value, error,
                    [&](const std::string& name) { return placement->placement.value(name); });
}

WaleCode wale_placement_program(const WalePlacement* placement, WaleProgram** program, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("program", program); !clear) return clear;
    if (auto given = is_given("placement", placement); !given) return given;
    hand_out(std::make_unique<WaleProgram>(WaleProgram{placement->placement.program}), program);
    return {};
  });
}

WaleCode wale_placement_shape(const WalePlacement* placement, WaleShape** shape, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("shape", shape); !clear) return clear;
    if (auto given = is_given("placement", placement); !given) return given;
    const wale::Shape& known = placement->placement.shape;
    if (!known.is_rectangle()) hand_out(std::make_unique<WaleShape>(WaleShape{known}), shape);
    return {};
  });
}
