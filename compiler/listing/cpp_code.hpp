#pragma once

#include <functional>
#include <string>
#include <vector>

#include "schema/patch_program.hpp"

namespace wale {

/// The code of a section as C++: a constant for each result, each register written once, and results that no root needs
/// left out.
class CppCode {
 public:
  /// In the order of the program's instructions. `prefix` and the number of an instruction name its result.
  CppCode(const PatchProgram& program, CodeSection section, std::size_t index, std::string prefix,
          std::vector<RegisterNumber> roots);

  /// Registers that the code or a root reads before the code writes them.
  const std::vector<RegisterNumber>& read_from_outside() const { return outside_; }

  struct Surroundings {
    /// The C++ for a register of another section; never called for a constant.
    std::function<std::string(RegisterNumber)> outside;
    std::function<std::string(std::uint16_t)> table, grid_shape, grid_cells;
    /// The lines that compute a peak, and the name of its result.
    std::function<void(const Instruction&, const std::function<std::string(RegisterNumber)>& now,
                       const std::string& name, std::string& lines)>
        peak = {};
  };
  /// The lines of C++, each with `indent` before it and its line of Wale after it.
  std::string lines(const Surroundings& surroundings, std::size_t indent);
  /// The C++ for a register at the end of the code. Call `lines` first.
  std::string result(RegisterNumber number) const;

 private:
  void find_needed(const std::vector<RegisterNumber>& roots);
  /// The registers that an instruction reads; for a peak also those that its code reads from outside.
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
  std::vector<std::string> names_;       ///< by register: its present name, if the code has written it
  Surroundings kept_;                    ///< as given to `lines`
};

/// A float as C++ with the machine's value, where a subnormal is zero: "2.5f", "(-1.0f)", "arithmetic::infinity".
std::string cpp_literal(float number);
/// The same, hidden from the C++ compiler if it would fold it as if subnormals were not zero.
std::string cpp_hidden(float value);

}  // namespace wale
