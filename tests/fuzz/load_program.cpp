// A libFuzzer target for the loader. Any bytes are refused with a reason, or make a program that runs within the force
// of its device and is written so that it loads again. The checksum is corrected first, so that the fuzzer reaches the later checks.

#include <cmath>
#include <cstdlib>
#include <span>
#include <vector>

#include "schema/patch_program_format.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"
#include "wale/program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::vector<std::byte> bytes(reinterpret_cast<const std::byte*>(data),
                               reinterpret_cast<const std::byte*>(data) + size);
  using namespace wale::patch_program_format;
  if (bytes.size() >= header_size) {
    const std::uint32_t crc = checksum(bytes);
    for (std::size_t i = 0; i < 4; ++i) bytes[checksum_offset + i] = static_cast<std::byte>(crc >> 8 * i & 0xff);
  }
  const auto loaded = wale::Program::load(bytes);
  if (!loaded) return loaded.error().sentence.empty() ? (std::abort(), 0) : 0;
  const auto& program = *loaded;
  const std::vector<std::byte> written = write_patch_program(program.description());
  const auto again = wale::Program::load(written);
  if (!again || write_patch_program(again->description()) != written) std::abort();
  long points = 0;
  for (const auto& peak : program.description().peaks) points += peak.points * static_cast<long>(peak.code.size());
  if (points > 1'000'000) return 0;  // accepted, but too slow to fuzz
  wale::Bank bank(program);
  const auto& device = program.description().device;
  const float most = static_cast<float>(device.most());
  const float most_y = device.shaker ? static_cast<float>(device.shaker->frequency_high) : most;
  for (const float place : {0.0f, 0.013f, -1e30f, std::nanf("")}) {
    const wale::Force force = tick(bank, {{place, -place}, {place, 1.0f}});
    if (!(std::abs(force.x) <= most && std::abs(force.y) <= most_y)) std::abort();
  }
  wale::Memory memory(program);
  memory.enter(bank, {});
  for (const float place : {0.0f, 0.013f, -1e30f, std::nanf("")}) {
    const wale::Force force = tick(bank, memory, {{place, -place}, {place, 1.0f}});
    if (!(std::abs(force.x) <= most && std::abs(force.y) <= most_y)) std::abort();
  }
  for (const float value : memory.states()) {
    if (!std::isfinite(value)) std::abort();
  }
  for (const float value : memory.cells()) {
    if (!std::isfinite(value)) std::abort();
  }
  float height = 0;
  const glm::vec2 place(0.01f, -0.02f);
  surface_all(bank, &memory, {&place, 1}, {&height, 1});
  show(bank, memory, {});
  return 0;
}
