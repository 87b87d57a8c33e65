#include "runtime/machine/decoded_program.hpp"

namespace wale {

DecodedProgram::DecodedProgram(PatchProgram verified) : description(std::move(verified)) {
  splines.reserve(description.tables.size());
  for (const HeightTable& table : description.tables) splines.emplace_back(table);
  const auto block = [this](std::span<const Instruction> code) { return decode_block(description, splines, code); };
  tick = block(description.tick);
  picture = block(description.picture.code);
  for (const Peak& peak : description.peaks) peaks.push_back(block(peak.code));
  for (const Output& output : description.outputs) (output.axis == 0 ? force_x : force_y) = output.value;
}

}  // namespace wale
