#include "runtime/c/program.hpp"

#include <cmath>
#include <cstring>
#include <span>

#include "runtime/c/profile.hpp"
#include "runtime/c/sized.hpp"

using namespace wale::c;

WaleCode wale_program_load(const void* bytes, size_t length, WaleProgram** program, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("program", program); !clear) return clear;
    if (auto given = is_given("bytes", bytes); !given) return given;
    auto loaded = wale::Program::load(std::span(static_cast<const std::byte*>(bytes), length));
    if (!loaded) return about_bytes(std::move(loaded).error());
    hand_out(std::make_unique<WaleProgram>(WaleProgram{*std::move(loaded)}), program);
    return {};
  });
}

void wale_program_free(WaleProgram* program) { free_handle(program); }

WaleCode wale_program_bytes(const WaleProgram* program, void* to, size_t capacity, size_t* length, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto given = is_given("length", length); !given) return given;
    *length = 0;
    const auto bytes = wale::write_patch_program(program->program.description());
    if (to != nullptr && capacity >= bytes.size()) std::memcpy(to, bytes.data(), bytes.size());
    *length = bytes.size();
    return {};
  });
}

WaleCode wale_program_details(const WaleProgram* program, WaleProgramDetails* details, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto sized = is_sized("details", details); !sized) return sized;
    const wale::PatchProgram& known = program->program.description();
    write_sized(details, {.material = text_of(known.material),
                          .device = text_of(known.device.name),
                          .taken = text_of(program->taken),
                          .width = known.patch_width,
                          .height = known.patch_height,
                          .rim = known.patch_rim,
                          .rate = known.device.rate,
                          .vibrates = known.vibrates(),
                          .has_colour = known.picture.colour.has_value(),
                          .parameters = known.parameters.size(),
                          .percepts = known.percepts.size(),
                          .states = known.states.size(),
                          .grids = known.grids.size(),
                          .warnings = program->warnings.size(),
                          .fates = known.fates.size()});
    return {};
  });
}

WaleCode wale_program_parameter(const WaleProgram* program, size_t index, WaleParameter* parameter, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto sized = is_sized("parameter", parameter); !sized) return sized;
    const auto& all = program->program.description().parameters;
    if (auto there = is_there(index, all.size()); !there) return there;
    const wale::Parameter& known = all[index];
    write_sized(parameter, {.name = text_of(known.name),
                            .description = text_of(known.description),
                            .unit = text_of(known.unit),
                            .si_unit = text_of(known.si_unit),
                            .unit_in_si = known.unit_in_si,
                            .value = known.value,
                            .low = known.low,
                            .high = known.high,
                            .soft_low = known.soft_low,
                            .soft_high = known.soft_high});
    return {};
  });
}

WaleCode wale_program_percept(const WaleProgram* program, size_t index, WalePercept* percept, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto sized = is_sized("percept", percept); !sized) return sized;
    const auto& all = program->program.description().percepts;
    if (auto there = is_there(index, all.size()); !there) return there;
    const wale::PerceptRecord& known = all[index];
    const wale::Bank bank(program->program);
    const float amplitude = wale::amplitude(bank, index);
    write_sized(percept, {.name = text_of(known.name),
                          .carrier = text_of(known.carrier),
                          .unit = text_of(known.unit),
                          .map = text_of(known.map),
                          .source = text_of(known.source),
                          .parameter = known.parameter ? *known.parameter : -1,
                          .amplitude = amplitude,
                          .level = wale::predict(bank, index, amplitude).level,
                          .valid_low = known.valid_low,
                          .valid_high = known.valid_high});
    return {};
  });
}

WaleCode wale_program_fate(const WaleProgram* program, size_t index, WaleFate* fate, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto sized = is_sized("fate", fate); !sized) return sized;
    const auto& all = program->program.description().fates;
    if (auto there = is_there(index, all.size()); !there) return there;
    const wale::FateRecord& known = all[index];
    write_sized(fate, {.name = text_of(known.name),
                       .is_percept = known.percept,
                       .fate = static_cast<std::int32_t>(known.fate),
                       .asked = known.asked,
                       .given = known.given,
                       .reason = text_of(known.reason)});
    return {};
  });
}

WaleCode wale_program_profile(const WaleProgram* program, WaleProfile* profile, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("program", program); !given) return given;
    if (auto sized = is_sized("profile", profile); !sized) return sized;
    write_sized(profile, figures_of(program->program.description().device));
    return {};
  });
}

const WaleError* wale_program_warning(const WaleProgram* program, size_t index) {
  if (program == nullptr || index >= program->warnings.size()) return nullptr;
  return program->warnings[index].get();
}
