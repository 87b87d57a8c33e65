#include "compiler/solve/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "compiler/expression/check_expression.hpp"
#include "compiler/solve/copy_terms.hpp"
#include "compiler/solve/only_compared.hpp"
#include "compiler/solve/solve_percepts.hpp"
#include "compiler/solve/vibration.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/sampled_rate.hpp"
#include "schema/spelling.hpp"

namespace wale {

namespace {

class Solver {
 public:
  /// `physics` are the fates of the material's physics, if they are known already.
  Solver(const CheckedMaterial& material, const CheckedModule& module, const SourceSet& sources, Resolver& resolver,
         Diagnostics& diagnostics, const BandShares& shares, std::vector<FateRecord> physics = {})
      : material_(material),
        declarations_(module.declarations()),
        sources_(sources),
        resolver_(resolver),
        diagnostics_(diagnostics),
        shares_(shares),
        physics_(std::move(physics)) {}

  SolvedMaterial solve(const std::string& device_name) {
    solved_.name = material_.name;
    solved_.span = material_.span;
    const DeviceDeclaration* device = declarations_.devices.find(device_name);
    if (!device) {
      report_unknown_device(device_name);
      return std::move(solved_);
    }
    device_ = device;
    solved_.device = device_->profile;
    solved_.parameters = material_.parameters;
    solved_.layers = material_.layers;
    solved_.active_watt = material_.active_watt;
    solved_.patch_width = material_.patch ? (*material_.patch)[0] : device_->profile.patch_width;
    solved_.patch_height = material_.patch ? (*material_.patch)[1] : device_->profile.patch_height;
    cut_patch(device_->profile.widest_patch());
    solved_.patch_rim =
        std::min(device_->profile.patch_rim, 0.25 * std::min(solved_.patch_width, solved_.patch_height));

    carriers_ = material_.carriers;
    open_spans_ = material_.open_spans;
    tables_ = material_.tables;
    force_ = material_.force;
    relief_ = material_.relief;
    solved_.relief_is_length = material_.relief_is_length;
    force_span_ = material_.force_span;
    states_ = material_.states;
    if (!force_ && !realise_percepts()) return std::move(solved_);

    PerceptSolver percepts(material_, declarations_, *device_, shares_, diagnostics_);
    percepts.plan(*open_terms_, carriers_, *force_, realised_, lost_, solved_.parameters);
    for (std::size_t i = 0; i < open_spans_.size(); ++i)
      if (const auto open = static_cast<std::uint32_t>(i);
          !percepts.settled(open) && !material_.blended_opens.contains(open))
        report_open(open);
    size_memories();
    warn_of_fine_periods();
    warn_of_fast_rates();
    if (diagnostics_.has_errors()) return std::move(solved_);
    substitute(percepts);
    percepts.describe(solved_);
    tell_fates(percepts);
    return std::move(solved_);
  }

 private:
  [[gnu::cold, gnu::noinline]] void report_unknown_device(const std::string& name) {
    const auto candidates = declarations_.devices.spellings();
    const auto near = nearest_spelling(name, candidates);
    std::string known;
    for (const auto& candidate : candidates) known += (known.empty() ? "" : ", ") + candidate;
    report(Code::unknown_device, material_.span, fmt::format("nothing declares a device `{}`", name),
           near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", known));
  }

  /// Cuts a patch to the device's workspace, so that one file can serve wide and narrow devices.
  void cut_patch(double workspace) {
    const double width = solved_.patch_width, height = solved_.patch_height;
    float widest =
        static_cast<float>(workspace);  // rounded as in the program, which must not be wider than the workspace
    if (widest > workspace) widest = std::nextafter(widest, 0.0f);
    solved_.patch_width = std::min(width, double{widest});
    solved_.patch_height = std::min(height, double{widest});
    if (std::max(width, height) <= workspace) return;
    const std::string asked = typeable("{:.4g} mm x {:.4g} mm", 1e3 * width, 1e3 * height);
    cut_ = readable("a patch of {}, cut to the workspace, {:.4g} mm across", asked, 1e3 * workspace);
    report(Code::cut_patch, material_.patch ? material_.patch_span : material_.span,
           readable("a patch of {} does not fit `{}` and is cut to its workspace, {:.4g} mm across", asked,
                    device_->profile.name, 1e3 * workspace),
           Advice(typeable("the rest cannot be felt there; `patch {:.4g} mm, {:.4g} mm` fits",
                           1e3 * solved_.patch_width, 1e3 * solved_.patch_height))
               .fact("high", 1e3 * workspace, "mm"));
  }

  /// Gives a material without a force the device's own realisations of its percepts, added together.
  bool realise_percepts() {
    if (material_.percepts.empty() && physics_.empty()) {
      report(Code::no_force, material_.span, fmt::format("`{}` has neither a force nor a percept", material_.name),
             "add `physical { force = … }` or `perceptual { roughness … }`");
      return false;
    }
    terms_ = material_.terms;
    open_terms_ = &terms_;
    ExpressionChecker checker({sources_, declarations_, diagnostics_, &resolver_}, terms_, tables_);
    checker.record().states = states_;
    const std::size_t errors_before = diagnostics_.error_count();
    std::vector<Span> spans;
    const bool vibrates = device_->profile.shaker.has_value();
    for (const auto& asked : material_.percepts) {
      if (!declarations_.percepts.find(asked.name)->has_reference)
        continue;  // it has no levels, which is reported later
      const auto rule = device_->realise.find(asked.name);
      if (rule == device_->realise.end()) {
        lose(asked);
        continue;
      }
      if (vibrates) {
        realise_by_shaking(asked, rule->second, checker, spans);
        continue;
      }
      realise(asked, rule->second, checker);
      spans.resize(checker.record().open_spans.size(), asked.span);
    }
    if (!force_ && vibrates && diagnostics_.error_count() == errors_before) {
      // The rest of the material, such as its picture, is still solved.
      const TermId none = terms_.literal(0);
      force_ = {none, none};
    }
    if (!force_) {
      if (diagnostics_.error_count() == errors_before) lose_all();
      return false;
    }
    if (!material_.percepts.empty()) force_span_ = material_.percepts.front().span;
    if (!vibrates) carriers_ = checker.record().carriers;
    open_spans_ = spans;
    states_ = checker.record().states;
    for (const auto& carrier : carriers_)
      if (carrier.relief) {
        // Heights of one kind lie on each other, as their forces add up.
        const bool is_length = carrier.relief_dimension == declarations_.dimension("length");
        const bool alike = relief_ && is_length == solved_.relief_is_length;
        relief_ = alike ? terms_.apply(Operation::add, *relief_, *carrier.relief) : *carrier.relief;
        solved_.relief_is_length = is_length;
      }
    return diagnostics_.error_count() == errors_before;
  }

  /// Adds the force that renders a percept on this device.
  void realise(const AskedPercept& asked, const Realisation& rule, ExpressionChecker& checker) {
    terms_.attribute(asked.span);  // and not to the device's file
    checker.read(*rule.home);
    Scope scope;
    scope.hand = true;
    const Value value =
        checker.check_as(*rule.tree, rule.force, scope, Value::Type::vector, declarations_.dimension("force"));
    if (value.failed()) return;
    realised_[asked.name] = sources_.text(rule.tree->span(rule.force));
    solved_.active_watt += rule.active_watt;
    if (force_)
      force_ = {terms_.apply(Operation::add, (*force_)[0], value.x),
                terms_.apply(Operation::add, (*force_)[1], value.y)};
    else
      force_ = {value.x, value.y};
  }

  /// Adds the shaking that renders a percept on a device that vibrates.
  void realise_by_shaking(const AskedPercept& asked, const Realisation& rule, ExpressionChecker& checker,
                          std::vector<Span>& spans) {
    terms_.attribute(asked.span);
    checker.read(*rule.home);
    const TermId size =
        terms_.add({.kind = TermKind::open, .index = static_cast<std::uint32_t>(spans.size()), .span = asked.span});
    const auto period = texture_period(material_, *declarations_.percepts.find(asked.name));
    Scope scope = shaking_scope(terms_, size, period ? *period : terms_.literal(rule.period), *device_, declarations_,
                                asked.span);
    const Value amplitude =
        checker.check_as(*rule.tree, rule.force, scope, Value::Type::number, declarations_.dimension("acceleration"));
    const Value rate =
        checker.check_as(*rule.tree, *rule.rate, scope, Value::Type::number, declarations_.dimension("frequency"));
    if (amplitude.failed() || rate.failed()) return;
    const auto of_the_hand = [&](const Value& value) {
      return terms_.dependence(value.x).on(Dependence::position | Dependence::velocity | Dependence::moment);
    };
    if (!device_->profile.has_position() && (of_the_hand(amplitude) || of_the_hand(rate)))
      return lose(asked, fmt::format("`{}` does not know where the hand is", device_->profile.name));
    spans.push_back(asked.span);
    Shaking shaking{amplitude.x, rate.x};
    carriers_.push_back({.name = shaking_carrier(asked.name),
                         .size = size,
                         .open = true,
                         .dimension = declarations_.dimension("acceleration"),
                         .force_x = shaking.amplitude,
                         .force_y = shaking.rate,
                         .relief = {},
                         .span = asked.span,
                         .size_span = asked.span});
    realised_[asked.name] =
        fmt::format("{} at {}", sources_.text(rule.tree->span(rule.force)), sources_.text(rule.tree->span(*rule.rate)));
    if (force_) shaking = together(terms_, {(*force_)[0], (*force_)[1]}, shaking);
    force_ = {shaking.amplitude, shaking.rate};
  }

  /// Records a percept as lost: the device has no rule for it or cannot use the rule.
  void lose(const AskedPercept& asked, const std::string& why = {}) {
    const std::string& device = device_->profile.name;
    const auto maps = declarations_.maps();
    const bool told_by_shaking = std::ranges::any_of(maps, [&](const Map* map) {
      return map->percept == asked.name && map->dimension == declarations_.dimension("acceleration");
    });
    const char* unknown = device_->profile.shaker && !told_by_shaking ? ", and no map ties it to shaking" : "";
    lost_[asked.name] = why.empty() ? fmt::format("`{}` has no rule for {}{}", device, asked.name, unknown) : why;
    if (asked.essential)
      report(Code::percept_unrealised, asked.place(),
             fmt::format("`{}` cannot render {}, which is essential here", device, asked.name),
             "build it for another device, or write the physics: `physical { force = … }`");
    else if (material_.percepts.size() > 1 || device_->profile.shaker)
      report(Code::lost_percept, asked.place(), lost_[asked.name] + ", so it is lost",
             "leave it out, write the physics, or mark it `essential` to refuse such a device");
  }

  /// Reports that no percept can be rendered, so that there is no force.
  void lose_all() {
    const auto& asked = material_.percepts.front();
    if (!declarations_.percepts.find(asked.name)->has_reference)
      return report(Code::untied_map, asked.place(),
                    fmt::format("expected a percept that has levels, found {}, which can only be compared", asked.name),
                    instead_of_a_level(*declarations_.percepts.find(asked.name)));
    report(Code::percept_unrealised, asked.place(),
           fmt::format("expected physics for {}, found none, and `{}` has no rule that makes it from a level",
                       asked.name, device_->profile.name),
           "write the physics: `physical { force = … }`");
  }

  /// Records the fates of the percepts asked for and of the physics. If parts of a force are lost, one warning names
  /// them.
  void tell_fates(const PerceptSolver& percepts) {
    for (const auto& asked : material_.percepts) {
      if (asked.evidence) solved_.claims.push_back({asked.name, *asked.evidence});
      const auto lost = lost_.find(asked.name);
      if (lost == lost_.end())
        solved_.fates.push_back(percepts.fate(asked));
      else
        solved_.fates.push_back({.name = asked.name,
                                 .percept = true,
                                 .fate = Fate::lost,
                                 .asked = static_cast<float>(asked.level),
                                 .reason = lost->second});
    }
    if (material_.force)
      solved_.fates.push_back(
          {.name = "force", .fate = Fate::kept, .reason = "by the material's formulas, not found from a level"});
    if (!cut_.empty()) solved_.fates.push_back({.name = "place", .fate = Fate::approximated, .reason = cut_});
    std::string lost;
    for (const FateRecord& each : physics_)
      if (each.fate == Fate::lost) lost += (lost.empty() ? "" : "; ") + each.name + ": " + each.reason;
    if (!lost.empty())
      report(Code::lost_percept, material_.force_span,
             fmt::format("on `{}`, parts of this force are lost ({})", device_->profile.name, lost),
             "`wale describe FILE --device NAME` lists them; write what matters as a percept, and mark it "
             "`essential` to refuse such a device");
    solved_.fates.insert(solved_.fates.end(), physics_.begin(), physics_.end());
  }

  /// Reports an open size that neither the author nor a percept sets.
  void report_open(std::uint32_t open) {
    const Percept* percept = nullptr;
    for (const auto& carrier : carriers_)
      if (carrier.open && (*open_terms_)[carrier.size].index == open)
        declarations_.percepts.each([&](const std::string&, const Percept& each) {
          if (each.carrier == carrier.name) percept = &each;
        });
    if (!percept)
      return report(Code::open_amplitude, open_spans_[open], "the size of this force is not given",
                    "give it a size; no percept tells it");
    const bool is_force = percept->carrier_dimension == declarations_.dimension("force");
    report(
        Code::open_amplitude, open_spans_[open], "the size of this force is not given",
        fmt::format("give the percept, as in `perceptual {{ {} 0.5 }}`, or the {}{}", percept->name,
                    percept->argument(), is_force ? fmt::format(": `{}: 1.2 N`", percept->argument()) : std::string()));
  }

  /// Computes the number of cells of each memory on the patch.
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
            readable("`{}` has {:.0f} x {:.0f} cells on this patch", memory.name, columns, rows),
            Advice(readable(
                       "at most {:.0f} per side and {:.0f} in total are possible; make the cells wider than {:.3g} mm",
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
                                  .high = static_cast<float>(memory.high),
                                  .si_unit = memory.si_unit});
    }
  }

  /// Warns of frequencies with hardly two ticks a period or fewer, which come out as other forces.
  void warn_of_fast_rates() {
    const double loop = device_->profile.rate, half = loop / 2, most = fastest_as_written(loop);
    for (const CheckedRate& rate : material_.rates)
      if (const auto frequency = constant_value(*open_terms_, rate.frequency, &material_.parameters);
          frequency && *frequency > most)
        report(Code::under_resolution, rate.span,
               readable("a frequency of {:.4g} Hz is {} half of the {:.4g} ticks a second of `{}`, so it comes "
                        "out as {}",
                        *frequency, *frequency > half ? "more than" : *frequency == half ? "just" : "nearly", loop,
                        device_->profile.name, what_comes_out(*frequency, loop)),
               Advice(readable("make it {:.4g} Hz or less", most))
                   .fact("frequency", *frequency, "Hz")
                   .fact("most", most, "Hz"));
  }

  /// Warns of periods of less than two encoder counts, which become noise at the handle.
  void warn_of_fine_periods() {
    const double step = device_->profile.position_step();
    std::set<std::pair<std::uint32_t, std::uint32_t>> said;
    for (const auto& period : material_.periods) {
      const auto length = constant_value(*open_terms_, period.length, &material_.parameters);
      const double widest = std::max(solved_.patch_width, solved_.patch_height);
      constexpr double patches = 4;  // even half a period of it is not felt any more
      constexpr double metres_by_mistake = 0.5;  // m
      if (length && *length > patches * widest && said.emplace(period.span.source, period.span.begin).second)
        report(Code::beyond_soft_range, period.span,
               readable("a period of {} is {:.0f} times as long as the patch ({:.2g} mm), so nothing repeats",
                        *length < 1 ? readable("{:.4g} mm", 1e3 * *length) : readable("{:.4g} m", *length),
                        *length / widest, 1e3 * widest),
               // Who writes metres may mean millimetres; a few centimetres are meant.
               Advice(*length < metres_by_mistake ? std::string("make it shorter, or the patch larger")
                                                  : typeable("for millimetres write `{:.4g} mm`", *length))
                   .fact("period", 1e3 * *length, "mm")
                   .fact("most", 1e3 * patches * widest, "mm"));
      if (!length || *length >= 2 * step || !said.emplace(period.span.source, period.span.begin).second) continue;
      report(Code::under_resolution, period.span,
             readable("a period of {:.3g} mm is less than two counts of the encoder of `{}` ({:.3g} mm each)",
                      1e3 * *length, device_->profile.name, 1e3 * step),
             Advice(readable("make it {:.2g} mm or more", std::ceil(2e4 * step) / 10))
                 .fact("period", 1e3 * *length, "mm")
                 .fact("least", 2e3 * step, "mm"));
    }
  }

  /// Substitutes the solved expressions for the open quantities.
  void substitute(PerceptSolver& percepts) {
    Terms& terms = solved_.terms;
    const Terms& author = *open_terms_;
    terms.reserve(author.size() + author.size() / 4 + 128);  // room for the solutions
    TermCopier copier(author, terms);
    const std::map<std::uint32_t, TermId> sizes = percepts.sizes(solved_, copier);
    std::vector<std::pair<TermId, TermId>> solutions;
    for (TermId id = 0, end = static_cast<TermId>(author.size()); id < end; ++id) {
      const Term& term = author[id];
      if (term.kind != TermKind::open && term.kind != TermKind::cells) continue;
      if (term.kind == TermKind::open) {
        if (const auto size = sizes.find(term.index); size != sizes.end()) solutions.emplace_back(id, size->second);
      } else {
        const Grid& memory = solved_.memories[term.index / 2];
        solutions.emplace_back(id, terms.literal(term.index % 2 == 0 ? memory.columns : memory.rows));
      }
    }
    const TermId first = solved_.solutions_end = terms.append(author);
    for (const auto& [open, solution] : solutions) terms.settle(first + open, solution);

    solved_.force = {first + (*force_)[0], first + (*force_)[1]};
    if (relief_) solved_.relief = first + *relief_;
    if (const auto& colour = material_.colour)
      solved_.colour = {first + (*colour)[0], first + (*colour)[1], first + (*colour)[2]};
    solved_.states = std::move(states_);
    for (auto& state : solved_.states) state.initial += first, state.next += first;
    for (std::size_t i = 0; i < material_.memories.size(); ++i)
      if (const auto& next = material_.memories[i].next)
        solved_.writes.push_back(
            {static_cast<std::uint16_t>(i), first + next->u, first + next->v, first + next->value});
    solved_.marks = material_.marks;
    for (auto& mark : solved_.marks)
      for (auto& operand : mark.operands) operand += first;
    solved_.force_span = force_span_;
    solved_.tables = std::move(tables_);
  }

  [[gnu::cold, gnu::noinline]] void report(Code code, Span span, std::string message, Advice advice) {
    diagnostics_.report(std::move(advice).about(code, span, std::move(message)));
  }

  const CheckedMaterial& material_;
  const Declarations& declarations_;
  const SourceSet& sources_;
  Resolver& resolver_;
  Diagnostics& diagnostics_;
  const BandShares& shares_;
  const DeviceDeclaration* device_ = nullptr;
  SolvedMaterial solved_;
  Terms terms_;  ///< the material's, and those of a realisation if there is one
  const Terms* open_terms_ = &material_.terms;
  std::vector<Carrier> carriers_;
  std::vector<Span> open_spans_;
  std::vector<HeightTable> tables_;
  std::optional<std::array<TermId, 2>> force_;
  std::optional<TermId> relief_;
  Span force_span_;
  std::vector<CheckedState> states_;             ///< the material's, and those that a realisation adds
  std::map<std::string, std::string> realised_;  ///< for percepts that the device renders by its own rule: how
  std::map<std::string, std::string> lost_;      ///< for percepts that the device does not render: why
  std::vector<FateRecord> physics_;              ///< fates of the parts of the force that the device cannot exert
  std::string cut_;                              ///< sentence about a patch that was cut to the device; otherwise empty
};

}  // namespace

SolvedMaterial solve(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                     const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics, const BandShares& shares) {
  const DeviceDeclaration* found = module.declarations().devices.find(device);
  if (!found || !found->profile.shaker || !material.force)
    return Solver(material, module, sources, resolver, diagnostics, shares).solve(device);
  std::vector<FateRecord> physics;
  const CheckedMaterial rest = without_force(material, *found, module.declarations(), physics);
  return Solver(rest, module, sources, resolver, diagnostics, shares, std::move(physics)).solve(device);
}

}  // namespace wale
