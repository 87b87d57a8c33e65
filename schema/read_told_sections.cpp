#include "schema/patch_program_format.hpp"
#include "schema/read_sections.hpp"

namespace wale::patch_program_format {

namespace {

Evidence read_evidence(ByteReader& in, std::string_view what) {
  const std::uint8_t value = in.u8();
  if (value < static_cast<std::uint8_t>(Evidence::measured) ||
      value > static_cast<std::uint8_t>(Evidence::simulated)) {
    in.damaged(" has evidence grade ", int{value}, " for ", what, ", which this Wale does not know");
  }
  return static_cast<Evidence>(value);
}

}  // namespace

std::vector<PerceptRecord> read_percepts(ByteReader& in) {
  std::vector<PerceptRecord> percepts(in.count(93, "percepts"));
  for (PerceptRecord& percept : percepts) {
    percept.name = in.text("a percept's name");
    percept.carrier = in.text("a percept's carrier");
    const std::uint8_t live = in.u8();
    if (live > 2) in.damaged(" holds ", int{live}, " for how a percept's level is set, expected 0, 1 or 2");
    const std::uint16_t parameter = in.u16();
    if (live == 1) percept.parameter = parameter;
    percept.blended = live == 2;
    if (live != 1 && parameter != 0) in.damaged(" names parameter ", parameter, " for a percept without a parameter");
    percept.amplitude = in.u16();
    percept.alone = in.boolean("whether a percept is alone");
    percept.prediction = in.code();
    percept.magnitude = in.u16();
    percept.level = in.u16();
    percept.valid_low = in.finite_f32("a percept's valid range");
    percept.valid_high = in.finite_f32("a percept's valid range");
    percept.uncertainty.scatter = in.finite_f32("a percept's scatter");
    percept.slope = read_evidence(in, "a slope");
    percept.anchor = read_evidence(in, "an anchor");
    percept.handle = read_evidence(in, "a handle");
    percept.map = in.text("a map's name");
    percept.device = in.text("a map's device");
    percept.source = in.text("a map's source");
    percept.unit = in.text("a carrier's unit");
    const std::uint8_t extractor = in.u8();
    if (extractor > static_cast<std::uint8_t>(Extractor::acceleration)) {
      in.damaged(" has extractor ", int{extractor}, ", which this Wale does not know");
    }
    percept.extractor = static_cast<Extractor>(extractor);
    for (float* figure : {&percept.period_low, &percept.period_high, &percept.one, &percept.near_threshold,
                          &percept.uncertainty.spread, &percept.weber, &percept.floor}) {
      *figure = in.finite_f32("a percept's figure");
    }
    percept.uncertainty.observers = in.u16();
    percept.weber_evidence = read_evidence(in, "a threshold");
    percept.weber_source = in.text("a threshold's source");
    percept.realisation = in.text("a realisation");
  }
  if (percepts.empty()) in.damaged(" is empty; a file without percepts leaves it out");
  return percepts;
}

void read_bases(ByteReader& in, std::vector<PerceptRecord>& percepts) {
  if (in.count(40, "percepts") != percepts.size() || percepts.empty())
    in.damaged(" has not as many entries as there are percepts");
  for (PerceptRecord& percept : percepts) {
    Basis& basis = percept.basis;
    basis.share = in.finite_f32("the share of a carrier");
    basis.tolerance = in.finite_f32("the tolerance of a level");
    LawUncertainty& law = percept.uncertainty;
    for (float* figure : {&law.slope_error, &law.noise}) *figure = in.finite_f32("the uncertainty of a law");
    law.stimuli = in.u16();
    for (bool* answer :
         {&basis.summand, &basis.valid_assumed, &law.scatter_assumed, &law.spread_assumed, &law.noise_assumed})
      *answer = in.boolean("what is assumed");
    StimulusDomain& domain = basis.domain;
    domain.stated = in.boolean("whether stimuli are stated");
    domain.profiles = in.u8(), domain.dimensions = in.u8();
    if (domain.profiles > 15 || domain.dimensions > 2) in.damaged(" has stimuli that this Wale does not know");
    domain.alone = in.boolean("whether stimuli were alone");
    domain.crest_low = in.finite_f32("the crest of stimuli");
    domain.crest_high = in.finite_f32("the crest of stimuli");
    domain.crest_assumed = in.boolean("whether a crest is assumed");
    basis.ranges.resize(in.count(25, "ranges"));
    for (MeasuredRange& range : basis.ranges) {
      range.quantity = in.text("the quantity of a range");
      range.low = in.finite_f32("a range");
      range.high = in.finite_f32("a range");
      range.unit = in.text("the unit of a range");
      range.unit_in_si = in.finite_f64("the unit of a range");
      range.assumed = in.boolean("whether a range is assumed");
    }
  }
}

std::vector<LevelClaim> read_claims(ByteReader& in) {
  std::vector<LevelClaim> claims(in.count(5, "claims"));
  for (LevelClaim& claim : claims) {
    claim.percept = in.text("a percept's name");
    claim.evidence = read_evidence(in, "a level");
  }
  if (claims.empty()) in.damaged(" is empty; a file without claims leaves it out");
  return claims;
}

std::vector<FateRecord> read_fates(ByteReader& in) {
  std::vector<FateRecord> fates(in.count(18, "fates"));
  for (FateRecord& fate : fates) {
    fate.name = in.text("the name of a fate");
    fate.percept = in.boolean("whether a fate is of a percept");
    const std::uint8_t word = in.u8();
    if (word < static_cast<std::uint8_t>(Fate::kept) || word > static_cast<std::uint8_t>(Fate::lost)) {
      in.damaged(" has fate ", int{word}, ", which this Wale does not know");
    }
    fate.fate = static_cast<Fate>(word);
    fate.asked = in.finite_f32("the level asked for");
    fate.given = in.finite_f32("the level given");
    fate.reason = in.text("the reason of a fate");
  }
  if (fates.empty()) in.damaged(" is empty; a file without fates leaves it out");
  return fates;
}

Layers read_layers(ByteReader& in) {
  Layers layers;
  layers.representative.resize(in.count(8, "entries"));
  for (auto& [key, values] : layers.representative) {
    key = in.text("an entry's name");
    values.resize(in.count(4, "values"));
    for (std::string& value : values) value = in.text("an entry's value");
  }
  layers.perceptual = in.text("the perceptual layer");
  layers.physical = in.text("the physical layer");
  layers.documentation = in.text("the documentation");
  if (layers == Layers{}) in.damaged(" is empty; a file without layers leaves it out");
  return layers;
}

SourcePlaces read_places(ByteReader& in, const PatchProgram& program) {
  SourcePlaces places;
  places.files.resize(in.count(4, "files"));
  for (std::string& file : places.files) file = in.text("a file's name");
  if (places.files.empty()) in.damaged(" is empty; a file without places leaves it out");
  for (const auto& [section, index] : code_of(program)) {
    auto& runs = places.sections.emplace_back(in.count(10, "runs"));
    std::uint64_t placed = 0;
    for (SourcePlaces::Run& run : runs) {
      run.instructions = in.u32();
      run.file = in.u16();
      run.line = in.u32();
      if (run.instructions == 0) in.damaged(" has a run of no instructions");
      if (run.file >= places.files.size()) {
        in.damaged(" names file ", run.file, " but has only ", places.files.size());
      }
      if (run.line == 0) in.damaged(" names line 0; lines are numbered from 1");
      placed += run.instructions;
    }
    const std::size_t written = program.code(section, index).size();
    if (placed != written) {
      in.damaged(" has places for ", placed, " instructions, but the code has ", written);
    }
  }
  return places;
}

}  // namespace wale::patch_program_format
