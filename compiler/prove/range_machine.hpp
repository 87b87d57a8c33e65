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

/// A place in a domain that may be split, and that a first-order form knows: an input, a parameter or a state.
struct Quantity {
  enum class Kind : std::uint8_t { input, parameter, state } kind;
  std::size_t index;

  Interval& in(Domain& domain) const;
  const Interval& in(const Domain& domain) const;
};

/// The machine over ranges: registers hold what is known of all runs from one domain at once.
class RangeMachine {
 public:
  /// Reads the program's tables once.
  explicit RangeMachine(const Program& program);

  /// Sets the registers that are there before any code runs. Of `quantities` the first `quantities_limit` are told
  /// apart.
  void start(const Domain& domain, std::span<const Quantity> quantities);
  /// Runs code; writes what each instruction's results may be to `results`, which has room for all or is empty.
  void run(std::span<const Instruction> code, std::span<ResultRanges> results = {});
  /// The same for code whose values are related so, from instruction number `first` of the relations on; those before
  /// have been run in the same way. Afterwards `length` knows it.
  void run(std::span<const Instruction> code, const Relations& relations, std::size_t first,
           std::span<ResultRanges> results = {});
  /// No vector of the values that two registers have is longer, by the code that was run last with its `relations`.
  double length(const Relations& relations, RegisterNumber x, RegisterNumber y) const;
  /// Runs the code of a peak, which finds positions within its extents.
  void run_peak(std::size_t index, std::span<const Instruction> code, std::span<ResultRanges> results = {});

  const Interval& range(RegisterNumber number) const { return registers_[number].range; }
  const PatchProgram& program() const { return description_; }
  /// Code that `peak` instructions run instead of the peaks' own; it leaves the same value.
  void replace_peaks(std::vector<std::vector<Instruction>> code) { peaks_ = std::move(code); }

 private:
  void run(std::span<const Instruction> code, const Relations* relations, std::size_t first,
           std::span<ResultRanges> results);
  /// One instruction that reads registers only, with what is known of its relations.
  Enclosure related(const Instruction& instruction, std::size_t number, const Relations& relations) const;
  Interval peak_range(std::size_t index);
  KnownRanges known() const { return {registers_, known_}; }

  Program program_;
  const PatchProgram& description_;
  std::vector<TableRanges> tables_;
  std::vector<Grid> grids_;  ///< their cells narrowed to the domain's
  std::vector<std::vector<Instruction>> peaks_;
  std::vector<Enclosure> registers_;
  std::vector<Interval> known_;  ///< of the code that is run with its relations, by result
};

}  // namespace wale
