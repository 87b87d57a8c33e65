#include <utility>

#include "calibration/feel/felt_report.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/evidence/percept_reading.hpp"

namespace wale {

void tell_read_percepts(FeltReport& report, const Bank& bank, const Declarations& declarations) {
  const PatchProgram& program = bank.program().description();
  if (report.felt.vibration) return;
  if (report.levels.empty()) {
    for (const DescribedPercept& percept : describe(bank, declarations).percepts)
      report.read.emplace_back(percept.name, percept.level);
    return;
  }
  const ForceReading found = read(bank, declarations, parts_for(program));
  for (LevelBack& level : report.levels) {
    const PerceptReading told = percept_reading(bank, level.percept, found, declarations);
    if (level.back && told.unknown)
      level.back = Error{.code = Code::not_measured,
                         .sentence = outside_in_words(outside_ranges(program.percepts[level.percept], told).front()),
                         .place = {.name = level.name}};
  }
}

}  // namespace wale
