#include "compiler/describe/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <span>
#include <string_view>

#include "compiler/describe/describe_extracted.hpp"
#include "compiler/describe/describe_percept.hpp"
#include "compiler/measure/coarseness.hpp"
#include "compiler/measure/rehearsal.hpp"
#include "compiler/prove/domain.hpp"
#include "compiler/prove/prove.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/text/readable.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {

namespace {

/// Whether code reads any of `count` registers from `first` on.
bool reads(std::span<const Instruction> code, RegisterNumber first, std::size_t count) {
  return std::ranges::any_of(code, [&](const Instruction& instruction) {
    const std::string_view fields = facts(static_cast<Operation>(instruction.operation)).fields;
    const std::array operands = {instruction.a, instruction.b, instruction.c};
    for (std::size_t i = 0; i < operands.size(); ++i)
      if (fields[i] == 'r' && operands[i] >= first && operands[i] < first + count) return true;
    return false;
  });
}

/// Whether the force can depend on a parameter: code that is run before or in a tick reads it.
bool reads_parameter(const PatchProgram& program, std::size_t index) {
  const auto number = static_cast<RegisterNumber>(program.first_parameter() + index);
  const auto any = [&](std::span<const Instruction> code) { return reads(code, number, 1); };
  return any(program.setup) || any(program.enter) || any(program.tick) ||
         std::ranges::any_of(program.peaks, [&](const auto& each) { return any(each.code); }) ||
         std::ranges::any_of(program.outputs, [&](const Output& each) { return each.value == number; });
}

/// What the force depends on besides the position, as its code reads it: "the hand's velocity", "time", …
std::vector<std::string> dependences(const PatchProgram& program) {
  struct Dependence {
    const char* words;
    std::initializer_list<Input> inputs;
  };
  const auto any = [&](std::initializer_list<Input> inputs) {
    return std::ranges::any_of(inputs,
                               [&](Input input) { return reads(program.tick, static_cast<RegisterNumber>(input), 1); });
  };
  std::vector<std::string> found;
  for (const Dependence& each : std::initializer_list<Dependence>{
           {"the hand's velocity",
            {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y}},
           {"the hand's acceleration",
            {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}},
           {"time", {Input::time}},
           {"the button", {Input::button}}})
    if (any(each.inputs)) found.emplace_back(each.words);
  if (remembers_time_only(program)) {
    if (std::ranges::find(found, "time") == found.end()) found.emplace_back("time");
  } else if (remembers_anything(program)) {
    found.emplace_back("its memory");
  }
  return found;
}

/// Why the program has no texture of its own, in a line; empty if it has one.
std::string why_no_texture(const PatchProgram& program, const Measured& force, bool later) {
  if (std::ranges::find(program.percepts, Extractor::lateral_force, &PerceptRecord::extractor) !=
      program.percepts.end())
    return {};
  if (force.max_newton == 0 && !later) return "it does not push";
  const auto found = dependences(program);
  if (found.empty())
    return depends_on_place(program) ? "its force depends on the position and has no relief"
                                     : "its force is the same everywhere";
  std::string text;
  for (std::size_t i = 0; i < found.size(); ++i)
    text += (i == 0 ? "" : i + 1 == found.size() ? " and " : ", ") + found[i];
  const bool has_places = reads(program, {Input::x, Input::y, Input::workspace_x, Input::workspace_y}) ||
                          (remembers_anything(program) && !remembers_time_only(program));
  return has_places ? fmt::format("its force depends on {}, so it has no single texture", text)
                    : fmt::format("its force depends on {}, and is the same at every place", text);
}

/// "roughness from 0.7 mm to 10 mm, …": the periods of the percepts of textures.
std::string bands_in_words(const Declarations& declarations) {
  std::string text;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (percept.extractor != Extractor::lateral_force || !percept.has_reference) return;
    const auto [low, high] = percept.period;
    const std::string to = std::isfinite(high) ? readable(" to {:.3g} mm", 1e3 * high) : "";
    text += readable("{}{} from {:.3g} mm{}", text.empty() ? "" : ", ", name, 1e3 * low, to);
  });
  return text;
}

/// Why nothing that people name was read, in a line.
std::string why_no_percept(const Description& description, const PatchProgram& program,
                           const Declarations& declarations) {
  const bool later = description.grade.later_newton > 0;
  if (description.force.max_newton == 0)
    return later ? readable("it does not push in the first {:.3g} s", still_seconds) : "it does not push";
  if (description.texture && description.texture->force.amplitude > 0)
    return description.texture->force.period > 0
               ? readable("its texture has a period of {:.3g} mm ({})", 1e3 * description.texture->force.period,
                          bands_in_words(declarations))
               : "its texture has no period that a map covers";
  constexpr double just_below = 1 - 1e-5;  // single precision rounds
  if (description.limit_matters && description.force.max_newton >= just_below * program.device.most() &&
      depends_on_place(program))
    return readable("`{}` cuts its force, and a force that is cut has no size that a map covers",
                    description.device.name);
  // Such a resistance has no texture, but that is not why: its law is none of those that maps cover.
  if (dependences(program) == std::vector<std::string>{"the hand's velocity"} && !description.motion.explained)
    return "its resistance is neither a friction nor in proportion to the speed, and no map covers another";
  const std::string why = why_no_texture(program, description.force, description.grade.later_newton > 0);
  return why.empty() ? "no map covers what it does" : why;
}

/// The measured force.
Measured measured(const Bank& bank, const Declarations& declarations) {
  Measured force = measure(bank);
  // A program with memory may push harder once it has been rubbed.
  if (remembers(bank.program().description()))
    for (const Force felt : rehearse(bank, declarations.hands.find("showing")).forces)
      force.max_newton = std::max(force.max_newton, std::hypot(felt.x, felt.y));
  return force;
}

constexpr double nearly_all = 0.99;  // of a proved bound: then what was found is the largest

/// The proved bounds of the force.
void describe_bounds(Description& description, const Program& program) {
  constexpr float lasting = 1e9f;    // s, thirty years: a time at which formulas still give numbers
  constexpr double rounding = 1e-6;  // of a ceiling
  description.bound = force_bound(program);
  Domain domain = whole_domain(program.description());
  domain[Input::time] = Interval::between(0, lasting);
  Proof proof = prove(program, domain);
  for (const std::size_t axis : {0, 1}) {
    Interval& asked = proof.unlimited[axis];
    // A force that a limit cuts is as large as the limit, so a smaller bound shows that the limit cuts none.
    const double most = description.bound.axis_newton[axis];
    if (most < proof.ceiling[axis].low * (1 - rounding) && most < asked.largest())
      asked = Interval::between(static_cast<float>(-most), static_cast<float>(most), asked.maybe_nan);
  }
  description.limit_matters = proof.limit_matters(0) || proof.limit_matters(1);
  description.asked = hull(proof.unlimited[0], proof.unlimited[1]);
}

/// N: a bound, proved for the bank's parameters and size, of a program whose force depends on motion: no search tries all
/// places at all velocities. 0 for others, whose places are searched closely.
double bound_with_these(const Bank& bank) {
  if (!depends_on_motion(bank.program().description())) return 0;
  return prove(bank.program(), domain_of(bank)).bound_newton;
}

/// What is called the largest force is the largest of all searches: with these parameters on this patch, and of any.
void settle_largest(Description& description, const Bank& bank, const ForceReading& read) {
  float& most = description.force.max_newton;
  // What lasts long enough to be a percentile was found, too.
  most = std::max({most, static_cast<float>(description.grade.largest_newton), static_cast<float>(read.other.rehearsed),
                   description.force.p99_newton});
  LargestForce& found = description.bound.found;
  const auto first = bank.registers().begin() + bank.program().description().first_parameter();
  const glm::vec2 half = 0.5f * glm::vec2(bank.size().width, bank.size().height), at = glm::abs(found.hand.position);
  if (found.size == bank.size() && std::equal(found.parameters.begin(), found.parameters.end(), first) &&
      at.x <= half.x && at.y <= half.y)
    most = std::max(most, static_cast<float>(found.newton));
  // The bound is proved; a sum of squares in floats may be above it by rounding.
  most = std::min(most, static_cast<float>(description.bound.newton));
  description.force.may_be_larger |= most < nearly_all * bound_with_these(bank);
  found.newton = std::max(found.newton, static_cast<double>(most));
}

/// The steepest slope of the force is exact, and a face is fitted to samples: beyond the slope by no more than a reading's
/// error, it is that slope. Where memory or time play a part, the slope is another one, and the face stays as it is read.
void settle_stiffness(Description& description) {
  const Grade& grade = description.grade;
  if (!description.wall || grade.jumps || grade.standing == Standing::not_analysed) return;
  const auto settle = [&](double& stiffness) {
    if (stiffness <= (1 + reading) * grade.stiffness) stiffness = std::min(stiffness, grade.stiffness);
  };
  settle(description.wall->face.stiffness);
  for (Description::Wall& each : description.more_walls) settle(each.face.stiffness);
}

/// The force, the stability of the loop, and the percepts and the texture that the force shows.
void describe_force(Description& description, const Bank& bank, const Declarations& declarations, Texture texture) {
  const PatchProgram& program = bank.program().description();
  ForceReading found;
  const ReadParts needed = texture != Texture::left_out ? ReadParts{} : parts_for(program);
  // The tasks are independent; the longest come first.
  const std::array<std::function<void()>, 4> tasks = {
      [&] { found = read(bank, declarations, needed); },
      [&] { description.grade = grade(bank, normal_hand(declarations)); },
      [&] { describe_bounds(description, bank.program()); },
      [&] { description.force = measured(bank, declarations); },
  };
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t, std::size_t) {
    for (std::size_t task = next++; task < tasks.size(); task = next++) tasks[task]();
  };
  // A force that is the same everywhere is measured too fast for a second thread to pay.
  if (depends_on_place(program))
    in_parallel(tasks.size(), work);
  else
    work(0, 1);
  settle_largest(description, bank, found);
  description.no_texture = why_no_texture(program, description.force, description.grade.later_newton > 0);
  description.percepts = recorded_percepts(bank, found, declarations);
  description.fates = fates_at(bank, found, declarations);
  if (texture == Texture::left_out) return;
  if (texture == Texture::extracted) {
    tell_settings(description.percepts, bank, found, declarations);
    tell_ends(description.percepts, bank, found, declarations);
  }
  if (texture == Texture::extracted && description.limit_matters) {
    const auto speed = static_cast<float>(normal_hand(declarations).speed());
    const std::size_t searched = parameters_searched(program);
    std::size_t done = 0;
    for (std::size_t i = 0; i < program.parameters.size(); ++i) {
      description.cuts.emplace_back();
      if (!reads_parameter(program, i)) continue;
      if (done++ < searched)
        description.cuts.back() = cut_ranges(bank, i, speed);
      else
        ++description.not_searched;
    }
  }
  describe_extracted(description, bank, found, declarations);
  settle_stiffness(description);
  if (description.percepts.empty()) description.no_percept = why_no_percept(description, program, declarations);
}

/// The shaking of a pad.
void describe_shaking(Description& description, const Bank& bank, const Declarations& declarations) {
  description.shaking = measure_shaking(bank, declarations.hands.find("normal"));
  description.percepts = recorded_percepts(bank, {}, declarations);
  description.fates = fates_at(bank, {}, declarations);
  if (description.percepts.empty()) description.no_percept = "it does not shake the device";
}

}  // namespace

std::string fate_word(Fate fate) {
  switch (fate) {
    case Fate::kept: return "kept";
    case Fate::approximated: return "approximated";
    case Fate::saturated: return "saturated";
    case Fate::lost: return "lost";
  }
  return "unknown";
}

std::string evidence_word(Evidence evidence) {
  switch (evidence) {
    case Evidence::measured: return "measured";
    case Evidence::published: return "published";
    case Evidence::estimated: return "estimated";
    case Evidence::recalled: return "recalled";
    case Evidence::transferred: return "transferred";
    case Evidence::extrapolated: return "extrapolated";
    case Evidence::simulated: return "simulated";
  }
  return "unknown";
}

std::string mark_word(MarkKind kind) {
  switch (kind) {
    case MarkKind::point: return "point";
    case MarkKind::circle: return "circle";
    case MarkKind::box: return "box";
    case MarkKind::line: return "line";
    case MarkKind::spring: return "spring";
    case MarkKind::trajectory: return "trajectory";
  }
  return "unknown";
}

Description describe(const Bank& bank, const Declarations& declarations, Texture texture) {
  const PatchProgram& program = bank.program().description();
  Description description{
      .material = program.material, .device = program.device, .layers = program.layers, .patch = bank.size()};
  if (program.vibrates())
    describe_shaking(description, bank, declarations);
  else
    describe_force(description, bank, declarations, texture);
  description.parameters = program.parameters;
  description.states = program.states;
  description.memories = program.grids;
  // The relief of a program without a surface is a constant.
  const RegisterNumber relief = program.picture.relief;
  description.shows_relief = relief < first_constant || relief >= program.first_parameter();
  description.shows_colour = program.picture.colour.has_value();
  description.marks = program.picture.marks;
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    description.parameters[i].value = bank.registers()[program.first_parameter() + i];
  auto& code = description.code;
  code.setup = program.setup.size(), code.setup_cost = cost_of(program.setup);
  code.enter = program.enter.size(), code.enter_cost = cost_of(program.enter);
  code.frame = program.picture.frame.size(), code.frame_cost = cost_of(program.picture.frame);
  code.tick = program.tick.size(), code.tick_cost = cost_of(program.tick);
  code.picture = program.picture.code.size(), code.picture_cost = cost_of(program.picture.code);
  for (const auto& peak : program.peaks) {
    code.peaks += peak.code.size();
    code.peak_cost += cost_of(peak.code) * peak.points;
  }
  description.coarseness = coarseness_of(program);
  description.bytes = write_patch_program(program).size();
  return description;
}

}  // namespace wale
