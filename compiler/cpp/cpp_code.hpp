#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/cpp/smallest.hpp"
#include "compiler/prove/prove.hpp"
#include "wale/program.hpp"

namespace wale {

/// What is known of each register before a section runs.
struct RegisterFacts {
  std::vector<std::optional<float>> values;  ///< those that are the same in every run
  std::vector<Smallest> smallest;
  std::vector<Interval> intervals;
};

/// A section of a program with what is proved of it. The references outlive it.
struct ProvedSection {
  const Program& program;
  const Proof& proof;
  CodeSection section;
  std::size_t index = 0;

  const std::vector<Instruction>& code() const { return program.description().code(section, index); }
  const Proof::Ranges& ranges() const;
};

/// The code of a section as C++: a constant for each result, each register written once. Results that are the same in
/// every run are computed here, by the machine, and results that no root needs are left out. A result that may be
/// subnormal is computed by a function that flushes it.
class CppCode {
 public:
  /// In the order of the program's instructions. `prefix` and the number of an instruction name its result.
  CppCode(const ProvedSection& proved, const RegisterFacts& facts, std::string prefix,
          std::vector<RegisterNumber> roots);

  /// What is known after the code.
  const RegisterFacts& facts_at_end() const { return now_; }

  /// Registers that the code or a root reads before the code writes them, except those with a known value.
  const std::vector<RegisterNumber>& read_from_outside() const { return outside_; }

  struct Surroundings {
    /// The C++ for a register of another section; never called for one with a known value.
    std::function<std::string(RegisterNumber)> outside;
    std::function<std::string(std::uint16_t)> table, grid_shape, grid_cells;
    /// The lines that compute a peak, and the name of its result.
    std::function<void(const Instruction&, const RegisterFacts& facts,
                       const std::function<std::string(RegisterNumber)>& now, const std::string& name,
                       std::string& lines)>
        peak = {};
  };
  /// The lines of C++, each with `indent` before it and its line of Wale after it.
  std::string lines(const Surroundings& surroundings, std::size_t indent);
  /// The C++ for a register at the end of the code. Call `lines` first.
  std::string result(RegisterNumber number) const;

 private:
  /// One instruction, after what came before it.
  struct Step {
    bool needed = false;
    bool flushed = false;                                ///< its result may be subnormal
    std::optional<std::array<float, 3>> values;          ///< its results, if they are the same in every run
    std::array<std::optional<float>, 3> known_operands;  ///< of a, b and c
    RegisterFacts before;                                ///< of a peak that is computed when the C++ runs
  };

  void learn();
  void find_needed(const std::vector<RegisterNumber>& roots);
  std::optional<std::array<float, 3>> values_of(const Instruction& instruction) const;
  SizedOperand sized(RegisterNumber number) const;
  /// The registers that an instruction reads; for a peak also those that its code reads from outside.
  std::vector<RegisterNumber> reads(const Instruction& instruction, const RegisterFacts& before) const;
  std::string operand(RegisterNumber number) const;
  std::string expression(std::size_t number) const;

  ProvedSection proved_;
  const PatchProgram& program_;
  RegisterFacts facts_;  ///< before the code
  RegisterFacts now_;    ///< while it is read, and after it
  std::string prefix_;
  const std::vector<Instruction>& code_;
  std::vector<Step> steps_;              ///< by instruction
  std::vector<RegisterNumber> outside_;  ///< sorted
  std::vector<std::string> names_;       ///< by register: its present name, if the code has written it
  Surroundings kept_;                    ///< as given to `lines`
};

/// A float as C++ with the machine's value, where a subnormal is zero: "2.5f", "(-1.0f)", "arithmetic::infinity".
std::string cpp_literal(float number);
}  // namespace wale
