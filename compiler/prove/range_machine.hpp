#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/enclosure.hpp"
#include "compiler/prove/look_up.hpp"
#include "compiler/prove/relations.hpp"
#include "wale/program.hpp"

namespace wale {

/// A quantity of a domain that may be split and that a first-order form contains: an input, a parameter or a state.
struct Quantity {
  enum class Kind : std::uint8_t { input, parameter, state } kind;
  std::size_t index;

  Interval& in(Domain& domain) const;
  const Interval& in(const Domain& domain) const;
};

/// The machine over ranges: a register holds what is known of it in all runs from one domain.
class RangeMachine {
 public:
  /// Reads the program's tables once.
  explicit RangeMachine(const Program& program);

  /// Sets the registers that are set before any code runs. Of `quantities`, the first `quantities_limit` get their own
  /// slope.
  void start(const Domain& domain, std::span<const Quantity> quantities);
  /// Runs code. Writes the range of each instruction's results to `results`, which has room for all or is empty.
  void run(std::span<const Instruction> code, std::span<ResultRanges> results = {});
  /// The same for code with known relations, from instruction number `first` of the relations on. The instructions
  /// before must have been run in the same way. Afterwards `length` can use it.
  void run(std::span<const Instruction> code, const Relations& relations, std::size_t first,
           std::span<ResultRanges> results = {});
  /// An upper bound of the length of the vector in two registers, from the code that was last run with its `relations`.
  double length(const Relations& relations, RegisterNumber x, RegisterNumber y) const;
  /// Runs the code of a peak for positions within its extents.
  void run_peak(std::size_t index, std::span<const Instruction> code, std::span<ResultRanges> results = {});

  const Interval& range(RegisterNumber number) const { return registers_[number].range; }
  const PatchProgram& program() const { return description_; }
  /// Code that `peak` instructions run instead of the peaks' own; it gives the same value.
  void replace_peaks(std::vector<std::vector<Instruction>> code) { peaks_ = std::move(code); }

 private:
  void run(std::span<const Instruction> code, const Relations* relations, std::size_t first,
           std::span<ResultRanges> results);
  /// Runs one instruction that reads registers only, using its relations.
  Enclosure related(const Instruction& instruction, std::size_t number, const Relations& relations) const;
  Interval peak_range(std::size_t index);
  KnownRanges known() const { return {registers_, known_}; }

  Program program_;
  const PatchProgram& description_;
  std::vector<TableRanges> tables_;
  std::vector<Grid> grids_;  ///< with cells narrowed to those of the domain
  std::vector<std::vector<Instruction>> peaks_;
  std::vector<Enclosure> registers_;
  std::vector<Interval> known_;  ///< by result, for the code that is run with its relations
};

}  // namespace wale
