#pragma once

#include <span>
#include <vector>

#include "compiler/grade/grade.hpp"

namespace wale {

/// The largest powers, W, that exploring hands find.
struct ExploredPower {
  double gained = 0;  ///< net energy that the hand keeps when it goes back to where it began, by time
  double moved = 0;   ///< energies in both directions, by time

  void add(const ExploredPower& other);
};

/// What hands find that enter, stroke to and fro or circle, and hold the button or not.
///
/// They do so for a second, and for as long as a reading looks (`still_seconds`) if the program reads the time or has a
/// state that is still on its way after that second, as a clock is.
struct Exploration {
  std::vector<Hand> hands;     ///< one per tick of the first second, then some of them
  std::vector<float> states;   ///< before each tick, hand by hand
  std::vector<char> changing;  ///< for each state, whether it changed after it was entered
  /// Hands of one way, evenly spaced in time.
  struct Run {
    std::size_t begin = 0, end = 0;  ///< of its hands
    bool usual = false;              ///< of the first second around the centre, with the button up
  };
  std::vector<Run> runs;
  ExploredPower usual;         ///< of the first second around the centre
  ExploredPower beyond;        ///< of later seconds, other places and pressed buttons
  bool runs_on = false;        ///< a state runs on at the end as it did before, so that more may come

  /// Takes up what another exploration of the same program found.
  void add(Exploration other);
};

/// Runs the program under hands that stroke to and fro and then circle around the centre, at its device's rate, without
/// guards. The hand's radius is limited to the room on the patch. Deterministic.
Exploration explore(const Bank& bank, const GradingHand& hand, bool button);

/// Runs it under hands that enter at each of `centres`, circle there for a quarter of a second, and press the button on
/// the way, keep it up, or hold it if `reads_button`. Of what it gives after a press counts only what was not in the
/// field that the press switched on. The circles are narrow; `begins` is the time at which they enter, s.
/// Deterministic.
Exploration visit(const Bank& bank, const GradingHand& hand, std::span<const Hand> centres, bool reads_button);

}  // namespace wale
