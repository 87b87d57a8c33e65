#include "compiler/read/unlimited.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

namespace wale {
namespace {

constexpr double just_below = 1 - 1e-5;  // of the limit: 32-bit floats round

using TickCode = std::vector<Instruction>;

bool is(const Instruction& instruction, Operation operation) {
  return instruction.operation == static_cast<std::uint8_t>(operation);
}

bool writes(const Instruction& instruction, RegisterNumber number) {
  const int results = operation_table[instruction.operation].results;
  return number >= instruction.destination && number < instruction.destination + results;
}

bool reads(const Instruction& instruction, RegisterNumber number) {
  const int operands = operation_table[instruction.operation].operands;
  return (operands > 0 && instruction.a == number) || (operands > 1 && instruction.b == number) ||
         (operands > 2 && instruction.c == number);
}

/// The last instruction before `end` that writes this register.
std::optional<std::size_t> writer_before(const TickCode& code, std::size_t end, RegisterNumber number) {
  while (end > 0)
    if (writes(code[--end], number)) return end;
  return std::nullopt;
}

/// The same if it is of this operation.
std::optional<std::size_t> made_by(const TickCode& code, std::size_t end, RegisterNumber number, Operation operation) {
  const auto found = writer_before(code, end, number);
  return found && is(code[*found], operation) ? found : std::nullopt;
}

/// Whether what an instruction makes is read by one other instruction only.
bool is_only_for(const PatchProgram& program, std::size_t made, std::size_t reader) {
  const RegisterNumber number = program.tick[made].destination;
  for (std::size_t i = made + 1; i < program.tick.size(); ++i) {
    if (i != reader && reads(program.tick[i], number)) return false;
    if (writes(program.tick[i], number)) return true;
  }
  return std::ranges::none_of(program.states, [&](const State& each) { return each.next == number; });
}

/// A `limit` of the whole force, as the compiler writes it: both parts times one factor, which is the ceiling over the
/// force's size where that is less than 1.
struct AuthorLimit {
  RegisterNumber ceiling = 0;
  std::array<std::size_t, 2> multiply{};  ///< where each part becomes smaller
  std::array<RegisterNumber, 2> asked{};  ///< each part before, read there
};

std::optional<AuthorLimit> author_limit(const PatchProgram& program) {
  const TickCode& code = program.tick;
  if (program.outputs.size() != 2) return std::nullopt;
  AuthorLimit found;
  std::array<std::size_t, 2> inner{};
  for (const std::size_t axis : {0, 1}) {
    const auto last = made_by(code, code.size(), program.outputs[axis].value, Operation::limit);
    if (!last) return std::nullopt;
    const auto limit = made_by(code, *last, code[*last].a, Operation::limit);
    if (!limit || !is_only_for(program, *limit, *last)) return std::nullopt;
    const auto multiply = made_by(code, *limit, code[*limit].a, Operation::multiply);
    if (!multiply || !is_only_for(program, *multiply, *limit)) return std::nullopt;
    inner[axis] = *limit, found.multiply[axis] = *multiply;
  }
  found.ceiling = code[inner[0]].b;
  if (code[inner[1]].b != found.ceiling || writer_before(code, code.size(), found.ceiling)) return std::nullopt;
  const Instruction &x = code[found.multiply[0]], &y = code[found.multiply[1]];
  for (const auto& [factor, asked] : {std::pair(x.a, x.b), std::pair(x.b, x.a)}) {
    const auto made = made_by(code, found.multiply[0], factor, Operation::minimum);
    if (!made || (y.a != factor && y.b != factor)) continue;
    if (writer_before(code, found.multiply[1], factor) != made) continue;
    for (const RegisterNumber share : {code[*made].a, code[*made].b}) {
      const auto divide = made_by(code, *made, share, Operation::divide);
      if (!divide || code[*divide].a != found.ceiling) continue;
      if (!made_by(code, *divide, code[*divide].b, Operation::square_root)) continue;
      found.asked = {asked, y.a == factor ? y.b : y.a};
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

namespace {

/// The instructions that read what one makes, until its register is written anew; nothing if a state keeps it.
std::optional<std::vector<std::size_t>> readers_of(const PatchProgram& program, std::size_t made) {
  const RegisterNumber number = program.tick[made].destination;
  std::vector<std::size_t> found;
  for (std::size_t i = made + 1; i < program.tick.size(); ++i) {
    if (reads(program.tick[i], number)) found.push_back(i);
    if (writes(program.tick[i], number)) return found;
  }
  if (std::ranges::any_of(program.states, [&](const State& each) { return each.next == number; })) return std::nullopt;
  if (std::ranges::any_of(program.outputs, [&](const Output& each) { return each.value == number; }))
    return std::nullopt;
  return found;
}

/// The limit whose factor, 1 at most, an instruction makes.
std::optional<PartLimit> limit_made_at(const Bank& bank, std::size_t minimum) {
  const PatchProgram& program = bank.program().description();
  const TickCode& code = program.tick;
  for (const auto& [one, share] : {std::pair(code[minimum].a, code[minimum].b), {code[minimum].b, code[minimum].a}}) {
    if (writer_before(code, code.size(), one) || bank.registers()[one] != 1) continue;
    const auto divide = made_by(code, minimum, share, Operation::divide);
    if (!divide || !made_by(code, *divide, code[*divide].b, Operation::square_root)) continue;
    const RegisterNumber ceiling = code[*divide].a;
    if (writer_before(code, code.size(), ceiling)) continue;
    const auto smaller = readers_of(program, minimum);
    if (!smaller || smaller->empty()) continue;
    PartLimit found{.ceiling = bank.registers()[ceiling], .factor = code[minimum].destination, .one = one};
    for (const std::size_t each : *smaller) {
      const auto held = readers_of(program, each);
      if (!is(code[each], Operation::multiply) || !held || held->size() != 1) return std::nullopt;
      const Instruction& limit = code[held->front()];
      if (!is(limit, Operation::limit) || limit.b != ceiling || limit.a != code[each].destination) return std::nullopt;
      found.multiply.push_back(each), found.limit.push_back(held->front());
    }
    return found;
  }
  return std::nullopt;
}

/// The limit of a number that is kept between one and its opposite, as `clamp` writes it, by the instruction that keeps it
/// last.
std::optional<PartLimit> kept_at(const Bank& bank, std::size_t last) {
  const PatchProgram& program = bank.program().description();
  const TickCode& code = program.tick;
  const bool from_above = is(code[last], Operation::minimum);
  const Operation other = from_above ? Operation::maximum : Operation::minimum;
  const auto fixed = [&](RegisterNumber number) {
    return number > static_cast<RegisterNumber>(Input::shape_edge_y) && !writer_before(code, code.size(), number);
  };
  for (const auto& [inner, bound] : {std::pair(code[last].a, code[last].b), {code[last].b, code[last].a}}) {
    const auto first = made_by(code, last, inner, other);
    if (!first || !fixed(bound) || !is_only_for(program, *first, last)) continue;
    for (const auto& [kept, opposite] : {std::pair(code[*first].a, code[*first].b), {code[*first].b, code[*first].a}}) {
      const double most = bank.registers()[from_above ? bound : opposite];
      if (!fixed(opposite) || fixed(kept) || !(most > 0)) continue;
      if (std::abs(most + bank.registers()[from_above ? opposite : bound]) > (1 - just_below) * most) continue;
      return PartLimit{.keeping = {{*first, kept}, {last, inner}}};
    }
  }
  return std::nullopt;
}

std::vector<float> parameters_of(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  std::vector<float> parameters;
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    parameters.push_back(bank.registers()[program.first_parameter() + i]);
  return parameters;
}

/// Changes a program so that no limit of all of its force is reached. It keeps the parameters of `bank`.
std::optional<Unlimited> without_limit(PatchProgram program, const Bank& bank, int times) {
  if (program.vibrates()) return std::nullopt;
  // A force over a second's ticks is so small that no limit reaches it, and the number of ticks is there as an input.
  const auto seconds = static_cast<RegisterNumber>(Input::seconds_per_tick);
  const auto smaller = [&](RegisterNumber to, RegisterNumber from) {
    return Instruction{static_cast<std::uint8_t>(Operation::multiply), to, from, seconds, 0};
  };
  // The author's limit is in what makes its force smaller; a device's becomes one of something smaller.
  const auto author = author_limit(program);
  std::vector<std::pair<std::size_t, Instruction>> added;  // before which instruction, last first
  for (std::size_t axis = 0; axis < program.outputs.size(); ++axis) {
    const Output& output = program.outputs[axis];
    const auto last = made_by(program.tick, program.tick.size(), output.value, Operation::limit);
    if (!last) return std::nullopt;
    if (author) {
      Instruction& first = program.tick[author->multiply[axis]];
      first = smaller(first.destination, author->asked[axis]);
      for (int i = 1; i < times; ++i)
        added.emplace_back(author->multiply[axis] + 1, smaller(first.destination, first.destination));
      continue;
    }
    Instruction& limit = program.tick[*last];
    for (int i = 0; i < times; ++i) added.emplace_back(*last, smaller(output.value, i == 0 ? limit.a : output.value));
    limit.a = output.value;
  }
  std::ranges::stable_sort(added, std::less(), [](const auto& each) { return each.first; });
  for (std::size_t i = added.size(); i-- > 0;)
    program.tick.insert(program.tick.begin() + static_cast<std::ptrdiff_t>(added[i].first), added[i].second);
  program.places = {};  // those of the instructions before
  // Setup is as it was, and so are its peaks, which cost most: its registers are taken over.
  for (Instruction& each : program.setup)
    if (is(each, Operation::peak)) each = smaller(each.destination, seconds);
  program.peaks = {};
  const std::vector<float> parameters = parameters_of(bank);
  const double ticks = std::pow(program.device.rate, times);
  Result<Program> loaded = Program::load(std::move(program));
  if (!loaded) return std::nullopt;
  Unlimited found{Bank(*loaded, parameters, bank.size()), ticks};
  std::ranges::copy(bank.registers(), found.bank.registers().begin());
  return found;
}

}  // namespace

std::vector<PartLimit> part_limits(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  std::vector<PartLimit> found;
  if (program.vibrates()) return found;
  const auto whole = author_limit(program);
  for (std::size_t i = 0; i < program.tick.size(); ++i) {
    const bool least = is(program.tick[i], Operation::minimum);
    if (!least && !is(program.tick[i], Operation::maximum)) continue;
    if (auto kept = kept_at(bank, i)) found.push_back(*std::move(kept));
    if (!least) continue;
    auto limit = limit_made_at(bank, i);
    if (limit && (!whole || std::ranges::find(limit->multiply, whole->multiply[0]) == limit->multiply.end()))
      found.push_back(*std::move(limit));
  }
  return found;
}

std::optional<Unlimited> without_part_limits(const Bank& bank, std::span<const PartLimit> parts) {
  PatchProgram program = bank.program().description();
  for (const PartLimit& part : parts) {
    for (const auto& [keeps, kept] : part.keeping) program.tick[keeps].a = program.tick[keeps].b = kept;
    for (std::size_t i = 0; i < part.multiply.size(); ++i) {
      Instruction& smaller = program.tick[part.multiply[i]];
      (smaller.a == part.factor ? smaller.a : smaller.b) = part.one;
      Instruction& limit = program.tick[part.limit[i]];
      limit = {static_cast<std::uint8_t>(Operation::multiply), limit.destination, limit.a, part.one, 0};
    }
  }
  return without_limit(std::move(program), bank, 1);
}

std::optional<Unlimited> without_parts(const Bank& bank, std::span<const PartLimit> parts) {
  PatchProgram program = bank.program().description();
  const auto make_nothing = [&](std::size_t at) {
    Instruction& made = program.tick[at];
    made = {static_cast<std::uint8_t>(Operation::subtract), made.destination, made.a, made.a, 0};
  };
  for (const PartLimit& part : parts) {
    if (!part.keeping.empty()) make_nothing(part.keeping.back().first);
    for (const std::size_t each : part.multiply) make_nothing(each);
  }
  return without_limit(std::move(program), bank, 1);
}

glm::dvec2 ForceLimit::cut(glm::dvec2 force) const {
  const double size = glm::length(force);
  if (size > any_way) force *= any_way / size;
  return glm::clamp(force, -along_axis, along_axis);
}

bool ForceLimit::reached_by(glm::dvec2 force) const {
  return at_limit(force, along_axis) || glm::length(force) >= just_below * any_way;
}

ForceLimit limit_of(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  ForceLimit limit{.along_axis = program.device.most()};
  if (program.vibrates()) return limit;
  if (const auto author = author_limit(program)) limit.any_way = bank.registers()[author->ceiling];
  return limit;
}

std::optional<Unlimited> without_limit(const Bank& bank, int times) {
  return without_limit(bank.program().description(), bank, times);
}

bool at_limit(glm::dvec2 force, double most) {
  return std::max(std::abs(force.x), std::abs(force.y)) >= just_below * most;
}

}  // namespace wale
