#include "compiler/solve/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/law.hpp"
#include "compiler/text/spelling.hpp"

namespace wale {

namespace {

class Solver {
 public:
  Solver(const CheckedMaterial& material, const CheckedModule& module, const SourceSet& sources, Resolver& resolver,
         Diagnostics& diagnostics)
      : material_(material),
        declarations_(module.declarations()),
        sources_(sources),
        resolver_(resolver),
        diagnostics_(diagnostics) {}

  SolvedMaterial solve(const std::string& device_name) {
    solved_.name = material_.name;
    solved_.span = material_.span;
    const DeviceDeclaration* device = declarations_.devices.find(device_name);
    if (!device) {
      const auto candidates = declarations_.devices.spellings();
      const auto near = nearest_spelling(device_name, candidates);
      std::string known;
      for (const auto& candidate : candidates) known += (known.empty() ? "" : ", ") + candidate;
      report(Code::unknown_device, material_.span, fmt::format("nothing declares a device `{}`", device_name),
             near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", known));
      return std::move(solved_);
    }
    device_ = device;
    solved_.device = device_->profile;
    solved_.parameters = material_.parameters;
    solved_.layers = material_.layers;
    solved_.active_watt = material_.active_watt;
    solved_.patch_width = material_.patch ? (*material_.patch)[0] : device_->profile.patch_width;
    solved_.patch_height = material_.patch ? (*material_.patch)[1] : device_->profile.patch_height;
    solved_.patch_rim =
        std::min(device_->profile.patch_rim, 0.25 * std::min(solved_.patch_width, solved_.patch_height));

    const double workspace = device_->profile.workspace_diameter;
    if (std::max(solved_.patch_width, solved_.patch_height) > workspace)
      report(Code::value_out_of_range, material_.patch ? material_.patch_span : material_.span,
             fmt::format("a patch of {:.4g} mm x {:.4g} mm does not fit `{}`", 1e3 * solved_.patch_width,
                         1e3 * solved_.patch_height, device_name),
             Advice(fmt::format("its workspace is {:.4g} mm across", 1e3 * workspace))
                 .fact("high", 1e3 * workspace, "mm"));

    open_terms_ = material_.terms;
    carriers_ = material_.carriers;
    open_spans_ = material_.open_spans;
    tables_ = material_.tables;
    force_ = material_.force;
    relief_ = material_.relief;
    solved_.relief_is_length = material_.relief_is_length;
    force_span_ = material_.force_span;
    if (!force_ && !realise_percepts()) return std::move(solved_);

    for (const auto& asked : material_.percepts) solve_percept(asked);
    for (std::size_t i = 0; i < open_spans_.size(); ++i)
      if (const auto open = static_cast<std::uint32_t>(i);
          !solutions_.contains(open) && !complained_.contains(open) && !material_.blended_opens.contains(open))
        report(Code::open_amplitude, open_spans_[i], "nothing says how hard this pushes",
               fmt::format(
                   "say what it feels like, as in `perceptual {{ {} 0.5 }}`, or give the amplitude: `amplitude: 1.2 N`",
                   percept_of(i)));
    size_memories();
    warn_of_fine_periods();
    if (diagnostics_.has_errors()) return std::move(solved_);
    substitute();
    describe_percepts();
    return std::move(solved_);
  }

 private:
  /// A material without a force takes the device's own realisation of its percept.
  bool realise_percepts() {
    if (material_.percepts.empty()) {
      report(Code::no_force, material_.span,
             fmt::format("`{}` says neither how it pushes nor how it feels", material_.name),
             "add `physical { force = … }` or `perceptual { roughness … }`");
      return false;
    }
    const auto& asked = material_.percepts.front();
    const auto realisation = device_->realise.find(asked.name);
    if (realisation == device_->realise.end()) {
      report(Code::percept_unrealised, asked.span,
             fmt::format("`{}` has no realisation of {} of its own", device_->profile.name, asked.name),
             "write the physics: `physical { force = … }`");
      return false;
    }
    const auto& [tree, expr, home] = realisation->second;
    open_terms_.attribute(asked.span);  // not to the device's file
    ExpressionChecker checker({sources_, declarations_, diagnostics_, &resolver_}, open_terms_, tables_);
    checker.read(*home);
    Scope scope;
    scope.hand = true;
    const Value value = checker.check_as(*tree, expr, scope, Value::Type::vector, declarations_.dimension("force"));
    if (value.failed()) return false;
    force_ = {value.x, value.y};
    force_span_ = asked.span;
    carriers_ = checker.carriers();
    open_spans_ = checker.open_spans();
    for (auto& span : open_spans_) span = asked.span;
    for (const auto& carrier : carriers_)
      if (carrier.relief) {
        relief_ = carrier.relief;
        solved_.relief_is_length = carrier.relief_dimension == declarations_.dimension("length");
      }
    return true;
  }

  /// The map for a percept on this device, or the one of the percept's own device, with its handle transferred.
  /// Without one: reported at `span`, if there is one.
  const Map* map_for(const Percept& percept, std::optional<Span> span) {
    for (const auto& device : {device_->profile.name, percept.reference_device}) {
      const Map* found = nullptr;
      for (const Map* map : declarations_.maps()) {
        if (map->percept != percept.name || map->device != device) continue;
        if (found) {
          if (span)
            report(Code::no_map, *span,
                   fmt::format("two maps for {} on `{}`: {}; {}", percept.name, device, found->source, map->source),
                   "keep one of them");
          return nullptr;
        }
        found = map;
      }
      if (found) return found;
    }
    if (span)
      report(Code::no_map, *span, fmt::format("no map ties {} to a force on `{}`", percept.name, device_->profile.name),
             "declare one, as in calibration/minsky1995.wale");
    return nullptr;
  }

  /// What to do about several sizes left open, the second of which is where it is reported.
  static Advice left_open(const std::vector<const Carrier*>& open) {
    Advice advice = "add the heights up in one `lateral(a + b)`, or give all but one an amplitude";
    for (std::size_t i = 0; i < open.size(); ++i)
      if (i != 1) advice = std::move(advice).see(open[i]->span, "this one is open too");
    return advice;
  }

  void solve_percept(const AskedPercept& asked) {
    const Percept& percept = *declarations_.percepts.find(asked.name);
    std::vector<const Carrier*> mine, open;
    for (const auto& carrier : carriers_) {
      if (carrier.name != percept.carrier) continue;
      mine.push_back(&carrier);
      if (carrier.open) open.push_back(&carrier);
    }
    if (mine.empty()) {
      report(Code::percept_unrealised, asked.span, fmt::format("nothing in the force carries {}", asked.name),
             fmt::format("{} is carried by the {}; add such a force", asked.name, percept.carrier));
      return;
    }
    if (open.size() > 1) {
      for (const auto* carrier : open) complained_.insert(open_terms_[carrier->size].index);
      report(Code::several_open, open[1]->span,
             fmt::format("{} sizes are left open for one {}", open.size(), asked.name), left_open(open));
      return;
    }
    const Map* map = map_for(percept, asked.span);
    if (!map) {
      if (!open.empty()) complained_.insert(open_terms_[open[0]->size].index);
      return;
    }
    const Law law(*map, percept);
    if (open.empty()) return check_conflict(asked, *mine.front(), law, *map);

    const double size = law.carrier_of(asked.level);
    if (std::isnan(size)) {
      complained_.insert(open_terms_[open[0]->size].index);
      report(Code::unsolvable_law, map->span,
             fmt::format("the law of {} from {} cannot be solved for `{}`", map->percept, map->from, map->from),
             "laws of one `magnitude` and one carrier in + - * / ^ log exp sqrt can");
      return;
    }
    warn_of_range(asked, *map, percept, law, size);
    for (std::size_t i = 0; i < material_.parameters.size(); ++i)
      if (material_.parameters[i].name == asked.name)
        report(Code::declared_twice, material_.parameter_spans[i],
               fmt::format("a parameter `{}` would stand beside the percept of that name", asked.name),
               Advice("give the parameter another name").see(asked.span, "asked for here"));
    solutions_[open_terms_[open[0]->size].index] = {&percept, map,
                                                    static_cast<std::uint32_t>(solved_.parameters.size()), asked.span};
    solved_.parameters.push_back(
        {.name = asked.name,
         .unit = "",
         .unit_in_si = 1,
         .value = static_cast<float>(asked.level),
         .low = 0,
         .high = 1,
         .soft_low = 0,
         .soft_high = 1,
         .description = fmt::format("level of {}: 0 none, 1 its reference stimulus", asked.name)});
  }

  void warn_of_range(const AskedPercept& asked, const Map& map, const Percept& percept, const Law& law, double size) {
    const auto& names = declarations_.names();
    const std::string unit = names.unit(percept.carrier_dimension);
    constexpr double rounding = 1e-6;  // a reference stimulus at the very end of the range is inside it
    if (size > device_->profile.force_newton)
      report(Code::saturates, asked.span,
             fmt::format("{} {:.3g} needs {:.3g} {}, and `{}` pushes {:.3g} {} at most", asked.name, asked.level, size,
                         unit, device_->profile.name, device_->profile.force_newton, unit),
             Advice(fmt::format("the most it can render is {:.2g}", law.level_of(device_->profile.force_newton)))
                 .fact("most_level", law.level_of(device_->profile.force_newton))
                 .fact("needed", size, unit)
                 .fact("most", device_->profile.force_newton, unit));
    if (asked.level < percept.near_threshold || size < map.valid_low * (1 - rounding) ||
        size > map.valid_high * (1 + rounding))
      report(Code::beyond_validity, asked.span,
             asked.level < percept.near_threshold
                 ? fmt::format("{} {:.3g} is near or below threshold", asked.name, asked.level)
                 : fmt::format("{} {:.3g} lies outside what was measured ({})", asked.name, asked.level, map.source),
             fmt::format("measured: levels {:.2g} to {:.2g}, {:.3g} to {:.3g} {}", law.level_of(map.valid_low),
                         law.level_of(map.valid_high), map.valid_low, map.valid_high, unit));
  }

  /// Percept and physics both given: they must agree within the scatter of the map.
  void check_conflict(const AskedPercept& asked, const Carrier& carrier, const Law& law, const Map& map) {
    const auto size = constant_value(open_terms_, carrier.size);
    if (!size) return;
    const double level = law.level_of(*size);
    const double difference = std::abs(std::log10(level) - std::log10(asked.level));
    if (difference <= map.scatter || std::abs(level - asked.level) <= asked.tolerance) return;
    diagnostics_.report({.code = Code::percept_conflict,
                         .span = asked.span,
                         .message = fmt::format("{} {:.3g} is asked for, and the amplitude given makes it {:.2g}",
                                                asked.name, asked.level, level),
                         .expected = fmt::format("an amplitude of {:.3g} {}", law.carrier_of(asked.level),
                                                 declarations_.names().unit(carrier.dimension)),
                         .found = fmt::format("{:.3g} {}", *size, declarations_.names().unit(carrier.dimension)),
                         .help = "leave out the amplitude, and it is solved from the percept; or leave out the percept",
                         .secondary = {{carrier.size_span, fmt::format("gives {} {:.2g}", asked.name, level)}},
                         .facts = {{"asked", NumberWithUnit{asked.level, ""}}, {"given", NumberWithUnit{level, ""}}}});
  }

  /// Lays the memories' cells over the patch.
  void size_memories() {
    constexpr double most_cells_a_side = 1024, most_cells = 1 << 20;
    double all = 0;
    for (const auto& memory : material_.memories) {
      const double columns = std::max(1.0, std::round(solved_.patch_width / memory.cell));
      const double rows = std::max(1.0, std::round(solved_.patch_height / memory.cell));
      all += columns * rows;
      if (std::max(columns, rows) > most_cells_a_side || all > most_cells) {
        report(
            Code::unbounded_memory, memory.span,
            fmt::format("`{}` has {:.0f} x {:.0f} cells on this patch", memory.name, columns, rows),
            Advice(fmt::format("at most {:.0f} a side and {:.0f} in all are kept; make the cells wider than {:.3g} mm",
                               most_cells_a_side, most_cells,
                               1e3 * std::max(solved_.patch_width, solved_.patch_height) / most_cells_a_side))
                .fact("columns", columns)
                .fact("rows", rows)
                .fact("most_a_side", most_cells_a_side)
                .fact("most", most_cells));
        return;
      }
      solved_.memories.push_back({.name = memory.name,
                                  .columns = static_cast<std::uint32_t>(columns),
                                  .rows = static_cast<std::uint32_t>(rows),
                                  .initial = static_cast<float>(memory.initial),
                                  .low = static_cast<float>(memory.low),
                                  .high = static_cast<float>(memory.high)});
    }
  }

  /// A period that falls between two encoder counts is noise at the handle.
  void warn_of_fine_periods() {
    const double step = device_->profile.position_step();
    std::set<std::pair<std::uint32_t, std::uint32_t>> said;
    for (const auto& period : material_.periods) {
      const auto length = constant_value(open_terms_, period.length, &material_.parameters);
      if (!length || *length >= 2 * step || !said.emplace(period.span.source, period.span.begin).second) continue;
      report(Code::under_resolution, period.span,
             fmt::format("a period of {:.3g} mm is less than two counts of the encoder of `{}` ({:.3g} mm each)",
                         1e3 * *length, device_->profile.name, 1e3 * step),
             Advice(fmt::format("make it {:.2g} mm or more", std::ceil(2e4 * step) / 10))
                 .fact("period", 1e3 * *length, "mm")
                 .fact("least", 2e3 * step, "mm"));
    }
  }

  /// Copies everything, the solved expressions in place of what was open.
  void substitute() {
    solved_.terms.reserve(open_terms_.size());
    TermCopier copier(open_terms_, solved_.terms);
    std::map<std::uint32_t, TermId> sizes;
    for (const auto& [index, solution] : solutions_) {
      solved_.terms.attribute(solution.asked);
      const TermId level = solved_.terms.parameter(solution.parameter);
      sizes[index] = *Law(*solution.map, *solution.percept).carrier(solved_.terms, level);
    }
    solved_.terms.attribute({});
    for (TermId id = 0; id < open_terms_.size(); ++id)
      if (const Term& term = open_terms_[id]; term.kind == TermKind::open && sizes.contains(term.index))
        copier.replace(id, sizes.at(term.index));
      else if (term.kind == TermKind::cells)
        copier.replace(id, solved_.terms.literal(term.index % 2 == 0 ? solved_.memories[term.index / 2].columns
                                                                     : solved_.memories[term.index / 2].rows));
    solved_.force = {copier((*force_)[0]), copier((*force_)[1])};
    if (relief_) solved_.relief = copier(*relief_);
    if (material_.colour)
      solved_.colour = {copier((*material_.colour)[0]), copier((*material_.colour)[1]), copier((*material_.colour)[2])};
    for (const auto& state : material_.states) {
      solved_.states.push_back(state);
      solved_.states.back().initial = copier(state.initial);
      solved_.states.back().next = copier(state.next);
    }
    for (std::size_t i = 0; i < material_.memories.size(); ++i)
      if (const auto& next = material_.memories[i].next) {
        solved_.writes.push_back(
            {static_cast<std::uint16_t>(i), copier(next->u), copier(next->v), copier(next->value)});
      }
    for (const auto& mark : material_.marks) {
      solved_.marks.push_back(mark);
      for (auto& operand : solved_.marks.back().operands) operand = copier(operand);
    }
    solved_.force_span = force_span_;
    solved_.tables = tables_;
    for (const auto& carrier : carriers_) solved_sizes_.push_back(copier(carrier.size));
  }

  /// The carrier that tells of a percept: the one solved for it, or the only one there is.
  std::optional<std::size_t> carrier_of(const Percept& percept) const {
    std::optional<std::size_t> only;
    int count = 0;
    for (std::size_t i = 0; i < carriers_.size(); ++i) {
      if (carriers_[i].name != percept.carrier) continue;
      if (carriers_[i].open) return i;
      only = i, ++count;
    }
    return count == 1 ? only : std::nullopt;
  }

  /// Every percept that a carrier of the force tells of, asked for or not, is told from the program.
  void describe_percepts() {
    for (const auto& name : declarations_.percepts.spellings()) {
      const Percept& percept = *declarations_.percepts.find(name);
      const auto index = carrier_of(percept);
      if (!index) continue;
      const Map* map = map_for(percept, std::nullopt);  // asked for, it has been reported
      if (!map) continue;
      const Carrier& carrier = carriers_[*index];
      SolvedPercept solved;
      solved.amplitude = solved_sizes_[*index];
      const Law law(*map, percept);
      solved_.terms.attribute(map->span);
      const TermId probe = solved_.terms.input(Input::probe);
      const auto magnitude = law.magnitude(solved_.terms, probe), level = law.level(solved_.terms, probe);
      if (!magnitude || !level) {
        report(Code::unsolvable_law, map->span, fmt::format("the law of {} cannot be solved for its magnitude", name),
               "laws of one `magnitude` and one carrier in + - * / ^ log exp sqrt can");
        continue;
      }
      solved.magnitude = *magnitude;
      solved.level = *level;
      for (const auto& asked : material_.percepts)
        if (asked.name == name) solved.asked = asked.level;
      PerceptRecord& record = solved.record;
      record.name = name;
      record.carrier = percept.carrier;
      if (carrier.open)
        record.parameter = static_cast<std::uint16_t>(solutions_.at(open_terms_[carrier.size].index).parameter);
      record.alone = force_ && (*force_)[0] == carrier.force_x && (*force_)[1] == carrier.force_y;
      record.valid_low = static_cast<float>(map->valid_low);
      record.valid_high = static_cast<float>(map->valid_high);
      record.scatter = static_cast<float>(map->scatter);
      record.slope = map->slope;
      record.anchor = map->anchor;
      record.handle = map->device == device_->profile.name ? map->handle : Evidence::transferred;
      record.map = fmt::format("{} from {}", map->percept, map->from);
      record.device = map->device;
      record.source = map->source;
      solved_.percepts.push_back(std::move(solved));
    }
  }

  std::string percept_of(std::size_t open) const {
    for (const auto& carrier : carriers_)
      if (carrier.open && open_terms_[carrier.size].index == open)
        for (const auto& name : declarations_.percepts.spellings())
          if (declarations_.percepts.find(name)->carrier == carrier.name) return name;
    return "roughness";
  }

  void report(Code code, Span span, std::string message, Advice advice) {
    diagnostics_.report(std::move(advice).about(code, span, std::move(message)));
  }

  struct Solution {
    const Percept* percept;
    const Map* map;
    std::uint32_t parameter;
    Span asked;
  };

  const CheckedMaterial& material_;
  const Declarations& declarations_;
  const SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  const DeviceDeclaration* device_ = nullptr;
  SolvedMaterial solved_;
  Terms open_terms_;
  std::vector<Carrier> carriers_;
  std::vector<Span> open_spans_;
  std::vector<HeightTable> tables_;
  std::optional<std::array<TermId, 2>> force_;
  std::optional<TermId> relief_;
  Span force_span_;
  std::map<std::uint32_t, Solution> solutions_;
  std::set<std::uint32_t> complained_;
  std::vector<TermId> solved_sizes_;
};

}  // namespace

SolvedMaterial solve(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                     const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  return Solver(material, module, sources, resolver, diagnostics).solve(device);
}

}  // namespace wale
