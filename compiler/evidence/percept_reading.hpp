#pragma once

#include <string>
#include <vector>

#include "compiler/read/read.hpp"

namespace wale {

/// A quantity of a stimulus that is outside what a map was measured with.
struct OutsideRange {
  std::string quantity;      ///< "period"
  double value = 0;          ///< SI
  double low = 0, high = 0;  ///< SI; infinite where the range has no end
  std::string unit;          ///< in which people read them; empty for a plain number
  double unit_in_si = 1;
  bool assumed = false;  ///< the range is assumed, not published
};

/// "period 14 mm, measured to 10", "drag 0.2 N, assumed from 0.43".
std::string in_words(const OutsideRange& outside);

/// "outside what was measured (period 14 mm, measured to 10)", "outside the range assumed for its map (…)".
std::string outside_in_words(const OutsideRange& outside);

/// What a finished program has of one percept, next to what its setup aims at.
struct PerceptReading {
  double aimed = 0;                 ///< the size that its setup aims at, in the record's unit
  double aimed_level = 0;           ///< of that size: the level asked for, where one is
  bool readable = true;             ///< otherwise `size` is the size aimed at, as far as the device gives it
  double size = 0;                  ///< read from the program's force, in the record's unit
  double level = 0, magnitude = 0;  ///< of `size`; not-a-number where no map covers it
  bool unknown = false;  ///< its force is there, but not as any map's stimulus: `outside` says in which quantity
  std::vector<OutsideRange> outside;
};

/// The largest output that the device gives this program, in N or m/s^2; for a pad that shakes at one frequency, the
/// largest there.
double most_given(const Bank& bank, const Declarations& declarations);

/// Reads percept number `index` of the bank's program. `found` is the reading of that bank.
PerceptReading percept_reading(const Bank& bank, std::size_t index, const ForceReading& found,
                               const Declarations& declarations);

/// What is outside of the ranges of a record if its carrier has this size. `size` is 0 without a carrier.
std::vector<OutsideRange> outside_of(const PerceptRecord& record, double size, const Bank& bank,
                                     const ForceReading& found, const Declarations& declarations);

/// Whether people would notice that a carrier of `size` and `level` is not one of `aimed` and `asked`: they differ by
/// more than a just noticeable difference, the scatter of the map and the author's tolerance.
bool differs(const PerceptRecord& record, double aimed, double asked, double size, double level);

/// Whether the percept is a wall's and the patch has none, and no force at all on hands at rest: the face stands
/// outside.
bool stands_outside(const PerceptRecord& record, const ForceReading& found);

/// Why a percept reads otherwise than asked, in a line.
std::string cause_of_difference(const PerceptRecord& record, const PerceptReading& reading, const ForceReading& found,
                                const Declarations& declarations);

/// The quantities outside, other than the size of the carrier.
std::vector<OutsideRange> outside_ranges(const PerceptRecord& record, const PerceptReading& told);

/// Why a percept that is asked for at this level is only approximated by what the program reads, in a line; empty if it
/// is not.
std::string why_approximated(const PerceptRecord& record, const PerceptReading& told, double asked,
                             const ForceReading& found, const Declarations& declarations);

/// Which part of a reading a percept with this extractor needs, and which the percepts of a program need together.
ReadParts parts_for(Extractor extractor);
ReadParts parts_for(const PatchProgram& program);

}  // namespace wale
