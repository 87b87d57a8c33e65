#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/fundamental.hpp"
#include "compiler/read/harmonic_fit.hpp"
#include "compiler/read/still_forces.hpp"
#include "compiler/read/waves.hpp"

namespace wale {

inline constexpr double negligible_rest = 0.004;  // of the whole mean square: no more waves are searched in it

/// The waves of a static force that are found so far, fitted together with a line.
class FittedWaves {
 public:
  /// Keeps references to the forces of the whole patch and to the features beside which waves are searched.
  FittedWaves(const StillForces& whole, const std::vector<Feature>& features);

  const FoundWaves& found() const { return found_; }
  /// N^2: the mean square of the forces beside a line.
  double all() const { return all_; }
  /// The forces at some places without the line, the features and the waves.
  std::vector<glm::dvec2> rest_at(const std::vector<glm::dvec2>& places, std::vector<glm::dvec2> forces) const;

  /// Takes off one more wave and fits all anew. False if that leaves as much as before.
  bool take_off(glm::dvec2 waves, const Fundamental& fundamental);
  /// Takes off all waves at once, from where they seem to be (periods over a metre), if nothing was found before and
  /// they leave hardly anything but finer waves; otherwise it does nothing, and returns false.
  bool take_off_together(const std::vector<glm::dvec2>& waves);
  /// Keeps a wave that only holds in a window, whose forces without the rest these are.
  void keep_local(const StillForces& window, const std::vector<glm::dvec2>& forces, const Fundamental& fundamental);
  void keep_lattice(const Lattice& lattice) { found_.lattice = lattice; }
  /// What was found, the strongest wave first. This is empty afterwards.
  FoundWaves finished();

 private:
  void update_rest() { found_.rest = rest_at(whole_.places, whole_.forces); }
  /// The same where the trend alone has changed, which was this one.
  void update_rest_after(const LinearForce& trend);
  bool is_slow(glm::dvec2 waves) const;
  /// Every so-many-th place of the whole. They lie anywhere in their cells, so that no choice among them aliases.
  StillForces every(std::size_t step) const;
  void add_to_rest(const FoldedWave& wave, double times);

  /// The linear part of what the waves leave. Slow waves are fitted with it: a few periods look a little like a slope.
  void fit_trend(StillForces& rest);
  /// The linear part beside all waves at once, so that it holds nothing of their incomplete periods, if that is better.
  void settle_trend();
  /// Fits the trend and all waves, the last of which is new, in turn: at few places, at more, then once at all.
  void fit_together(bool slow);

  /// Finds the waveform anew beside all others, with another period and number of parts if they are not its own.
  void fold_anew(FoundWave& found, glm::dvec2 waves, std::size_t bins);
  /// Finds a wave anew whose harmonics are all multiples of one.
  void shorten(FoundWave& found, std::size_t step);
  /// If only every so many-th harmonic of a wave is there, it is that much shorter.
  void shorten_if_longer(FoundWave& found);
  /// The number of a wave among the harmonics of a coarser one; 0 if it is none.
  std::size_t harmonic_of(const FoundWave& coarse, const FoundWave& fine) const;
  /// Joins waves that are harmonics of another one to it, unless they are waves of their own.
  void join_harmonics();
  /// A harmonic that two waves share belongs to the one that has others beside it.
  void settle_shared_harmonics();
  /// A wave of long period all of whose harmonics stand about a carrier's is that one, and wavers.
  static void tell_carrier(FoundWave& found);
  /// A wave that lay nearly where a part of a sum does looked like one until it was found itself.
  void drop_parts_that_are_gone();
  /// Some places of the whole, with the forces that the waves and the line together are to tell.
  StillForces to_fit_together() const;
  /// Replaces the waves and the line by these, fitted anew. False, with all as before, if they leave no less.
  bool replace_by(HarmonicFit fit);
  /// Whether the waves leave hardly more than what is finer than the means over small cells.
  bool hardly_any_slow_rest() const;
  /// What may be waves of their own, as periods over a metre: the waves that were found, the strongest harmonics of
  /// each.
  std::vector<glm::dvec2> may_be_waves() const;
  /// Over few periods two waves look like one whose harmonic the finer is, and each one is moved a little by the other.
  /// Fitted together they come apart, if they are no such wave.
  void part_slow_waves();

  const StillForces& whole_;
  const std::vector<Feature>& features_;
  FoundWaves found_;
  double all_ = 0;  // N^2, without the first trend
};

}  // namespace wale
