// write_firmware FOLDER: for each subject, NAME.hpp (its header), NAME.cpp (a program that runs it) and NAME.expected
// (what that program must print: the machine's digests). tests/firmware/run compiles and runs them.

#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "compiler/cpp/print_header.hpp"
#include "tests/firmware/motion.hpp"
#include "tests/listing/subjects.hpp"
#include "wale/memory.hpp"

namespace {

using wale::listing::Subject;

/// One subject in four keeps everything live, so that setup and its peaks run in the firmware.
bool is_live(std::size_t index) { return index % 4 == 0; }

std::string program_text(const Subject& subject, bool live) {
  const wale::PatchProgram& program = subject.program.description();
  const char* bank = live ? "bank, " : "";
  const char* cells = program.grids.empty() ? "" : "cells, ";
  std::ostringstream text;
  text << "// " << subject.what << "\n#include \"" << program.material << ".hpp\"\n#include \"motion.hpp\"\n\n"
       << "extern \"C\" void write_number(std::uint32_t number);\n\nint main() {\n"
       << "  using namespace wale_patch_" << program.material << ";\n";
  if (live) text << "  const Setup bank = setup(Parameters{}, Patch{});\n";
  if (!program.grids.empty()) text << "  Cells cells;\n";
  text << "  firmware::Motion motion;\n  firmware::Digest digest;\n"
       << "  const auto hand = [&] {\n    const firmware::Inputs inputs = motion.next();\n    Hand measured;\n"
       << "    static_assert(sizeof measured == sizeof inputs, \"fourteen floats\");\n"
       << "    std::memcpy(&measured, &inputs, sizeof measured);\n    return within_envelope(measured);\n  };\n"
       << "  State state = enter(" << bank << "hand());\n"
       << "  for (int i = 1; i <= firmware::ticks; ++i) {\n"
       << "    const Force force = tick(" << bank << "state, " << cells << "hand());\n"
       << "    digest.add(force.x), digest.add(force.y);\n"
       << "    float states[" << 2 * program.states.size() + 1 << "];\n"
       << "    std::memcpy(states, &state, " << 8 * program.states.size() << ");\n"
       << "    for (int k = 0; k < " << program.states.size() << "; ++k) digest.add(states[2 * k]);\n"
       << "    if (i % firmware::ticks_per_digest == 0) write_number(digest.value());\n  }\n";
  if (!program.grids.empty())
    text << "  float each = 0;\n"
         << "  for (std::size_t i = 0; i < sizeof cells; i += sizeof each) {\n"
         << "    std::memcpy(&each, reinterpret_cast<const char*>(&cells) + i, sizeof each);\n"
         << "    digest.add(each);\n  }\n";
  text << "  write_number(digest.value());\n  return 0;\n}\n";
  return text.str();
}

wale::Hand hand_of(const firmware::Inputs& inputs) {
  const float* v = inputs.value;
  wale::Hand hand;
  hand.position = {v[0], v[1]};
  hand.velocity = {v[2], v[3]};
  hand.acceleration = {v[4], v[5]};
  hand.raw_velocity = {v[6], v[7]};
  hand.raw_acceleration = {v[8], v[9]};
  hand.workspace = {v[10], v[11]};
  hand.time = v[12];
  hand.button = v[13] != 0;
  return hand;
}

std::string expected_of(const Subject& subject) {
  wale::Bank bank(subject.program);
  wale::Memory memory(subject.program);
  firmware::Motion motion;
  firmware::Digest digest;
  std::ostringstream text;
  const auto line = [&] { text << std::hex << std::setfill('0') << std::setw(8) << digest.value() << '\n'; };
  memory.enter(bank, hand_of(motion.next()));
  for (int i = 1; i <= firmware::ticks; ++i) {
    const wale::Force force = tick(bank, memory, hand_of(motion.next()));
    digest.add(force.x), digest.add(force.y);
    for (const float state : memory.states()) digest.add(state);
    if (i % firmware::ticks_per_digest == 0) line();
  }
  for (const float cell : memory.cells()) digest.add(cell);
  line();
  return text.str();
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: write_firmware FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = words[1];
  std::size_t index = 0;
  for (const Subject& subject : wale::listing::subjects()) {
    const bool live = is_live(index++);
    wale::LiveParts parts;
    if (live) {
      parts.parameters.assign(subject.program.description().parameters.size(), true);
      parts.size = true;
    }
    const std::string name = subject.program.description().material;
    std::ofstream(folder / (name + ".hpp")) << print_header(subject.program, parts);
    std::ofstream(folder / (name + ".cpp")) << program_text(subject, live);
    std::ofstream(folder / (name + ".expected")) << expected_of(subject);
    std::cout << name << ' ' << subject.what << (live ? ", live" : "") << '\n';
  }
}
