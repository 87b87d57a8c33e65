#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/truth/families.hpp"

namespace wale::truth {

/// A program that is read wrongly.
struct Fault {
  std::string name, faults, source;
  double error = 0;  ///< of its worst cue
};

/// How well the programs of one class are read.
struct Score {
  struct OfCue {
    std::size_t right = 0, judged = 0;
    std::size_t sized_right = 0, sized = 0;  ///< where the program has this cue, and of a known size
    double worst = 0;
    std::string worst_fault;
  };
  std::string family;
  std::size_t programs = 0, right = 0, inventing = 0;
  std::array<OfCue, judged_count> cues;
  std::vector<Fault> faults;

  /// Of all programs and cues.
  std::size_t right_cues() const;
};

/// Reads the first `count` programs of a class.
Score score_of(const Family& family, std::size_t count);

/// A line for each class: programs, right, and right of judged for each cue.
std::string table_of(const std::vector<Score>& scores);
/// The worst of each class and cue.
std::string worst_of(const std::vector<Score>& scores);
/// The bars of the reading, and which classes do not meet them.
std::string bars_of(const std::vector<Score>& scores);

}  // namespace wale::truth
