#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/patch_program.hpp"

namespace wale {

/// A section's code as C++: a constant for each result, no register written twice, what no root needs left out.
class CppCode {
 public:
  /// Runs in the order of the program's instructions; `prefix` and the instruction's number name its result.
  CppCode(const PatchProgram& program, CodeSection section, std::size_t index, std::string prefix,
          std::vector<RegisterNumber> roots);

  /// Registers that the code, or a root, reads and the code has not written by then.
  const std::vector<RegisterNumber>& read_from_outside() const { return outside_; }

  struct Surroundings {
    /// The C++ for a register that is not the section's own; never a constant's.
    std::function<std::string(RegisterNumber)> outside;
    std::function<std::string(std::uint16_t)> table, grid_shape, grid_cells;
    /// Lines that work out a peak, and its result's name.
    std::function<void(const Instruction&, const std::function<std::string(RegisterNumber)>& now,
                       const std::string& name, std::string& lines)>
        peak = {};
  };
  /// The lines, each with `indent` before it and its line of Wale behind it.
  std::string lines(const Surroundings& surroundings, std::size_t indent);
  /// After `lines`: the C++ for a register as the code leaves it.
  std::string result(RegisterNumber number) const;

 private:
  void find_needed(const std::vector<RegisterNumber>& roots);
  /// What an instruction reads: a peak also what its code reads from outside.
  std::vector<RegisterNumber> reads(const Instruction& instruction) const;
  std::string operand(RegisterNumber number) const;
  std::string expression(const Instruction& instruction) const;

  const PatchProgram& program_;
  CodeSection section_;
  std::size_t index_;
  std::string prefix_;
  const std::vector<Instruction>& code_;
  std::vector<char> needed_;             ///< by instruction
  std::vector<RegisterNumber> outside_;  ///< sorted
  std::vector<std::string> names_;       ///< by register: what it is at present, where the code has written it
  Surroundings kept_;                    ///< what `lines` was given
};

/// A float as C++ as the machine takes it, a subnormal one being zero: "2.5f", "(-1.0f)", "arithmetic::infinity".
std::string cpp_literal(float number);
/// The same, hidden from the compiler where it would calculate as if subnormals were not zero.
std::string cpp_hidden(float value);

}  // namespace wale
