// A libFuzzer target for the promise that a loaded program stays within its bounds. It changes instructions of valid
// programs and bytes of files, loads the results, and runs the accepted ones with ordinary and extreme hands. No force
// exceeds the declared ceiling or the proved bound, no register leaves its proved range, and no cost exceeds its
// declaration. The sanitizers check all reads.

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "runtime/machine/inputs.hpp"
#include "schema/patch_program_format.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/prove/stepping.hpp"
#include "wale/memory.hpp"
#include "wale/picture.hpp"

namespace {

using namespace wale;

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::abort();
}

/// The fuzzer's bytes, read one after the other; zeros after their end.
class Choices {
 public:
  Choices(const unsigned char* data, std::size_t size) : bytes_(data, size) {}
  bool left() const { return position_ < bytes_.size(); }
  std::uint32_t next(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | (left() ? bytes_[position_++] : 0u);
    return value;
  }

 private:
  std::span<const unsigned char> bytes_;
  std::size_t position_ = 0;
};

/// The sections of a program whose code may be changed.
std::vector<std::vector<Instruction>*> code_of(PatchProgram& program) {
  std::vector<std::vector<Instruction>*> all = {&program.setup, &program.enter,        &program.tick,
                                                &program.tick,  &program.picture.code, &program.picture.frame};
  for (Peak& peak : program.peaks) all.push_back(&peak.code);
  return all;
}

/// A constant of any bits, an instruction with a field changed, or a state's bound.
void change(PatchProgram& program, Choices& choices) {
  const std::uint32_t what = choices.next(1);
  if (what % 4 == 0) {
    program.constants[choices.next(1) % program.constants.size()] = std::bit_cast<float>(choices.next(4));
    return;
  }
  if (what % 16 == 1) {
    State& state = program.states[choices.next(1) % program.states.size()];
    (what % 32 == 1 ? state.low : state.high) = std::bit_cast<float>(choices.next(4));
    return;
  }
  const auto all = code_of(program);
  std::vector<Instruction>& code = *all[choices.next(1) % all.size()];
  if (code.empty()) return;
  Instruction& instruction = code[choices.next(1) % code.size()];
  const auto number = [&] { return static_cast<RegisterNumber>(choices.next(1) % program.register_count()); };
  switch (what / 16 % 5) {
    case 0: instruction.operation = static_cast<std::uint8_t>(choices.next(1) % 26); break;
    case 1: instruction.destination = number(); break;
    case 2: instruction.a = number(); break;
    case 3: instruction.b = number(); break;
    default: instruction.c = number();
  }
}

Result<Program> made(Choices& choices) {
  const std::uint32_t kind = choices.next(1);
  PatchProgram program = example::RandomProgram(choices.next(2)).make();
  if (kind % 8 >= 6) {  // the same on a pad
    program.device = example::pad_device(kind % 16 >= 14 ? PositionSource::none : PositionSource::touch);
    program.outputs[0].quantity = OutputQuantity::amplitude;
    program.outputs[1].quantity = OutputQuantity::frequency;
    program.outputs[1].axis = 0;
  }
  program.peaks[0].points = 20;  // quick
  if (kind % 4 != 0) {
    // Ordinary constants: proofs say little about others.
    for (std::size_t i = 4; i < program.constants.size(); ++i) {
      program.constants[i] = static_cast<float>(static_cast<int>(i * 37 % 64) - 32) / 8;
    }
  }
  if (kind % 2 == 0) {
    while (choices.left()) change(program, choices);
    return Program::load(std::move(program));
  }
  std::vector<std::byte> bytes = write_patch_program(program);
  using namespace patch_program_format;
  while (choices.left()) {
    const std::size_t at = header_size + choices.next(2) % (bytes.size() - header_size);
    bytes[at] = static_cast<std::byte>(choices.next(1));
  }
  const std::uint32_t crc = checksum(bytes);
  for (std::size_t i = 0; i < 4; ++i) bytes[checksum_offset + i] = static_cast<std::byte>(crc >> 8 * i & 0xff);
  return Program::load(bytes);
}

/// Peaks of many points and long code are legal, and too slow to fuzz.
bool is_quick(const PatchProgram& program) {
  double work = 0;
  for (const Peak& peak : program.peaks) work += peak.points * static_cast<double>(peak.code.size() + 1);
  return work < 1e5;
}

std::vector<Hand> hands_of(std::uint32_t seed) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float values[] = {0.0f,    0.013f, -0.05f, 0.2f, -1.0f, 1e-40f,
                              -1e-45f, 1e30f,  -3e38f, inf,  -inf,  std::numeric_limits<float>::quiet_NaN()};
  std::minstd_rand random(seed + 1);
  const auto any = [&] { return values[random() % std::size(values)]; };
  std::vector<Hand> hands(12);
  for (Hand& hand : hands) {
    for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.acceleration, &hand.raw_velocity,
                            &hand.raw_acceleration, &hand.workspace}) {
      *pair = {any(), any()};
    }
    hand.time = any();
    hand.button = random() % 2 == 0;
  }
  return hands;
}

class Bounds {
 public:
  Bounds(const Program& program, const Proof& proof) : program_(program), proof_(proof) {}

  void check(const Bank& bank, const Force& force) const {
    const PatchProgram& description = program_.description();
    for (const Output& output : description.outputs) {
      const float ceiling = bank.registers()[output.ceiling];
      const double pushed = std::abs(stepping::seen(force[output.component()]));
      if (!(pushed <= ceiling || pushed == 0)) fail("above the ceiling");
      const DeviceProfile& device = description.device;
      const double most = output.quantity == OutputQuantity::frequency ? device.shaker->frequency_high : device.most();
      if (!(ceiling <= static_cast<float>(most))) fail("a ceiling above the device");
      if (!proof_.force[output.component()].contains(force[output.component()])) fail("outside the proved range");
    }
    const double length = std::hypot(stepping::seen(force.x), stepping::seen(force.y));
    if (!(length <= proof_.bound_newton * (1 + 1e-15)))
      fail("a force of " + std::to_string(force.x) + ", " + std::to_string(force.y) +
           " N is above the proved bound of " + std::to_string(proof_.bound_newton) + " N");
  }

 private:
  const Program& program_;
  const Proof& proof_;
};

/// Runs all sections, instruction by instruction, from the contents of the bank and the memory.
void step_through(const Bank& bank, const Memory& memory, const Hand& hand, const Proof& proof, const Force* force) {
  const DecodedProgram& program = bank.program().decoded();
  stepping::State state{
      program, {bank.registers().begin(), bank.registers().end()}, {memory.cells().begin(), memory.cells().end()}};
  HandReader(program.tick_inputs, program.envelope)(hand, state.registers.data());
  std::copy(memory.states().begin(), memory.states().end(),
            state.registers.begin() + program.description.first_state());
  if (const auto complaint = stepping::run_all(state, proof)) fail(*complaint);
  if (force == nullptr) return;
  for (const Output& output : program.description.outputs) {
    const float stepped = state.registers[output.value];
    if (std::bit_cast<std::uint32_t>(stepped) != std::bit_cast<std::uint32_t>((*force)[output.component()]))
      fail("stepped through, the force is another");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size > 512) return 0;
  Choices choices(data, size);
  const auto loaded = made(choices);
  if (!loaded) return loaded.error().sentence.empty() ? (std::abort(), 0) : 0;
  const auto& program = *loaded;
  if (!is_quick(program.description())) return 0;
  const Proof proof = prove(program);
  const Bounds bounds(program, proof);
  const auto hands = hands_of(static_cast<std::uint32_t>(size));
  for (const float share : {0.0f, 1.0f}) {
    std::vector<float> parameters;
    for (const Parameter& p : program.description().parameters) parameters.push_back(share > 0 ? p.high : p.value);
    Bank bank(program, parameters, {share, share, 0.1f * share});
    std::vector<Force> forces(hands.size());
    tick_all(bank, hands, forces);
    Memory memory(program);
    memory.enter(bank, hands.front());
    for (std::size_t i = 0; i < hands.size(); ++i) {
      bounds.check(bank, forces[i]);
      Bank fresh = bank;
      const Memory before = memory;
      const Force force = tick(bank, memory, hands[i]);
      bounds.check(bank, force);
      if (i % 4 == 0) step_through(fresh, before, hands[i], proof, &force);
    }
    float height = 0;
    glm::vec3 colour;
    const glm::vec2 place(0.01f, -0.02f);
    surface_all(bank, &memory, {&place, 1}, {&height, 1}, {&colour, 1});
    show(bank, memory, hands.front());
  }
  // Searching and splitting take a thousand times as long as the rest: few programs.
  if (size == 9 || size == 200) {
    const ForceBound bound = force_bound(program, whole_domain(program.description()), 4000);
    if (!(bound.found.newton <= bound.newton && bound.newton <= proof.bound_newton)) fail("splitting lost a force");
  }
  return 0;
}
