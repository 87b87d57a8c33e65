#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/enclosure.hpp"
#include "compiler/prove/look_up.hpp"
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
  /// Runs the code of a peak, which finds positions within its extents.
  void run_peak(std::size_t index, std::span<const Instruction> code, std::span<ResultRanges> results = {});

  const Interval& range(RegisterNumber number) const { return registers_[number].range; }
  const PatchProgram& program() const { return description_; }
  /// Code that `peak` instructions run instead of the peaks' own; it leaves the same value.
  void replace_peaks(std::vector<std::vector<Instruction>> code) { peaks_ = std::move(code); }

 private:
  Interval peak_range(std::size_t index);

  Program program_;
  const PatchProgram& description_;
  std::vector<TableRanges> tables_;
  std::vector<ResultRanges> grids_;
  std::vector<std::vector<Instruction>> peaks_;
  std::vector<Enclosure> registers_;
};

}  // namespace wale
