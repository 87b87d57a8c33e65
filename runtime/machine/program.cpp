#include "wale/program.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/lane.hpp"
#include "runtime/machine/verify.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

float& at(float* registers, Input input) { return registers[static_cast<std::size_t>(input)]; }

/// The requested size, corrected: a side that is not positive, or whose half would be subnormal, becomes the
/// fallback's; a longer side than `most` (the workspace) becomes `most`, because proofs rely on it. A rim that leaves
/// no middle becomes a quarter of the smaller side.
PatchSize sensible(PatchSize size, PatchSize fallback, float most) {
  const auto usable = [](float side) { return std::isfinite(side) && side >= 2 * arithmetic::least_normal; };
  size.width = std::min(usable(size.width) ? size.width : fallback.width, most);
  size.height = std::min(usable(size.height) ? size.height : fallback.height, most);
  if (!std::isfinite(size.rim) || size.rim < 0) size.rim = fallback.rim;
  const float smaller = std::min(size.width, size.height);
  if (size.rim >= 0.5f * smaller) size.rim = 0.25f * smaller;
  size.rim = arithmetic::flushed(size.rim);
  return size;
}

/// Error: the program's bytes would not load again, since a text is longer than a file holds, or a figure is not one of
/// a file's. Heights are left out: verification has seen all that a reader checks of them, and they may be large.
Result<> is_loaded_again(const PatchProgram& program) {
  PatchProgram without_heights = program;
  without_heights.tables.clear();
  Result<PatchProgram> read = read_patch_program(write_patch_program(without_heights));
  if (!read) return std::move(read).error();
  return {};
}

}  // namespace

Result<Program> Program::load(std::span<const std::byte> bytes) {
  const auto refuse = [](Error error) {
    if (error.mend.empty()) error.mend = "build it again from its Wale file";
    return error;
  };
  Result<PatchProgram> read = read_patch_program(bytes);
  if (!read) return refuse(std::move(read).error());
  Result<Program> loaded = load(*std::move(read));
  if (!loaded) return refuse(std::move(loaded).error());
  return loaded;
}

Result<Program> Program::load(PatchProgram program) {
  make_visible(program);  // first, since two names may become one, and a text too long for a file
  if (Result<> verified = verify(program); !verified) return std::move(verified).error();
  if (Result<> again = is_loaded_again(program); !again) return std::move(again).error();
  return Program(std::make_shared<const DecodedProgram>(std::move(program)));
}

const PatchProgram& Program::description() const { return decoded_->description; }

PatchSize Program::default_size() const {
  return {description().patch_width, description().patch_height, description().patch_rim};
}

std::vector<float> Program::default_parameters() const {
  std::vector<float> values;
  for (const Parameter& parameter : description().parameters) values.push_back(parameter.value);
  return values;
}

std::optional<std::size_t> Program::parameter(std::string_view name) const {
  const auto& all = description().parameters;
  const auto found = std::find_if(all.begin(), all.end(), [name](const Parameter& p) { return p.name == name; });
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

Bank::Bank(const Program& program, std::span<const float> parameters, PatchSize size)
    : program_(program),
      size_(sensible(size, program.default_size(), static_cast<float>(program.description().device.widest_patch()))),
      registers_(program.description().register_count()) {
  const PatchProgram& description = program_.description();
  float* registers = registers_.data();
  at(registers, Input::patch_half_width) = 0.5f * size_.width;
  at(registers, Input::patch_half_height) = 0.5f * size_.height;
  at(registers, Input::patch_rim) = size_.rim;
  at(registers, Input::seconds_per_tick) = static_cast<float>(1 / description.device.rate);
  std::transform(description.constants.begin(), description.constants.end(), registers + first_constant,
                 arithmetic::flushed);
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const Parameter& parameter = description.parameters[i];
    const float asked = i < parameters.size() ? parameters[i] : parameter.value;
    registers[description.first_parameter() + i] =
        held_within(arithmetic::flushed(asked), arithmetic::flushed(parameter.low), arithmetic::flushed(parameter.high),
                    arithmetic::flushed(parameter.value));
  }
  const FloatingPointMode mode;
  run_lane(program_.decoded(), description.setup, registers, nullptr);
}

Bank::Bank(const Program& program) : Bank(program, program.default_parameters(), program.default_size()) {}

Prediction predict(const Bank& bank, std::size_t index, float amplitude) {
  const DecodedProgram& program = bank.program().decoded();
  const PerceptRecord& percept = program.description.percepts[index];
  std::vector<float> registers(bank.registers().begin(), bank.registers().end());
  at(registers.data(), Input::probe) = arithmetic::flushed(amplitude);
  {
    const FloatingPointMode mode;
    run_lane(program, percept.prediction, registers.data(), nullptr);
  }
  return {registers[percept.magnitude], registers[percept.level]};
}

float amplitude(const Bank& bank, std::size_t index) {
  return bank.registers()[bank.program().description().percepts[index].amplitude];
}

}  // namespace wale
