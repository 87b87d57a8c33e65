#include "compiler/check/check_material.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "compiler/check/blend.hpp"
#include "compiler/check/check_statements.hpp"
#include "compiler/check/check_usage.hpp"
#include "compiler/modules/representative.hpp"

namespace wale {

namespace {

class MaterialChecker {
 public:
  MaterialChecker(const Declared<MaterialDecl>& declared, const Surroundings& surroundings, bool whole)
      : tree_(*declared.tree),
        node_(*declared.node),
        declared_(declared),
        surroundings_(surroundings),
        checker_(surroundings, material_.terms, material_.tables),
        whole_(whole),
        errors_before_(surroundings.diagnostics.error_count()),
        said_before_(surroundings.diagnostics.all().size()) {}

  CheckedMaterial check() {
    constexpr std::size_t terms_of_a_statement = 16;  // about; only for reserving memory
    material_.terms.reserve(terms_of_a_statement * node_.physical.size());
    material_.name = node_.name.text;
    material_.span = node_.name.span;
    const auto assembled = assemble(declared_, surroundings_);
    check_representative(assembled.get());
    if (assembled) {
      material_.percepts = assembled->percepts;
      compose(*assembled);
    }
    const auto& sources = surroundings_.sources;
    if (node_.perceptual_span) material_.layers.perceptual = sources.text(*node_.perceptual_span);
    if (node_.physical_span) material_.layers.physical = sources.text(*node_.physical_span);
    if (!node_.physical_span && node_.derived_from)
      material_.layers.physical = sources.text(tree_.span(*node_.derived_from));
    material_.layers.documentation = node_.documentation;
    if (surroundings_.diagnostics.error_count() == errors_before_) {
      const std::size_t said = surroundings_.diagnostics.all().size();
      material_.cycles = checker_.record().cycles;
      for (const CheckedAngle& each : check_usage(material_, checker_.record(), surroundings_))
        material_.cycles.push_back({each.angle, true, each.span});
      keep_doubts(said);
    }
    material_.carriers = std::move(checker_.record().carriers);
    material_.open_spans = checker_.record().open_spans;
    material_.states = std::move(checker_.record().states);
    material_.periods = checker_.record().periods;
    material_.rates = checker_.record().rates;
    material_.operands = checker_.record().operands;
    return std::move(material_);
  }

 private:
  /// The forces of the material and of all that it blends.
  void compose(const AssembledMaterial& assembled) {
    Blender blender(material_, checker_, surroundings_, node_.name.span);
    StatementChecker own(material_, checker_, surroundings_, "");
    const auto force = blender.compose(assembled, own);
    for (auto& percept : material_.percepts)
      if (const auto shares = blender.levels().find(percept.name); percept.blended && shares != blender.levels().end())
        percept.shares = shares->second;
    if (force) {
      material_.force = {force->x, force->y};
      material_.force_span = own.layers().empty() ? node_.name.span : own.layers().front().span;
      for (const auto& layer : own.layers()) {
        const std::string_view text = surroundings_.sources.text(layer.span);
        const bool of_library = std::ranges::any_of(checker_.record().carriers, [&](const Carrier& each) {
          return each.span.source == layer.span.source && each.span.begin > layer.span.begin &&
                 each.span.end <= layer.span.end;
        });
        material_.forces.push_back({{layer.force.x, layer.force.y},
                                    layer.span,
                                    text.starts_with('+') || (text.starts_with('-') && of_library)});
      }
    }
    // After an error, a name may only seem unused: the erroneous expression may use it.
    if (whole_ && surroundings_.diagnostics.error_count() == errors_before_) own.warn_of_unused_names(node_.span);
    if (!material_.relief) find_relief(own);
    if (force) find_scaled_textures();
  }

  /// Finds `2 * lateral(h)`: the percept is solved for `lateral(h)`, so the handle would give twice as much. A
  /// factor that changes from tick to tick is fine: it modulates the texture in time.
  void find_scaled_textures() {
    const Terms& terms = material_.terms;
    for (const auto& carrier : checker_.record().carriers) {
      if (!carrier.open) continue;
      if (!checker_.charge(terms.size() / 8, carrier.span)) return;
      for (TermId id = carrier.force_x + 1; id < terms.size(); ++id) {
        const Term& term = terms[id];
        const bool product = term.kind == TermKind::operation && term.operation == Operation::multiply;
        const bool quotient = term.kind == TermKind::operation && term.operation == Operation::divide;
        if (!(product && term.b == carrier.force_x) && !(quotient && term.a == carrier.force_x)) continue;
        if (terms.dependence(product ? term.a : term.b).in_tick()) continue;
        material_.scaled_textures.push_back(term.span);
      }
    }
  }

  /// Sets the look of the surface if the author does not: the heights of the textures, or else the last height in the
  /// text.
  void find_relief(const StatementChecker& own) {
    const Dimension length = surroundings_.declarations.dimension("length");
    for (const auto& carrier : checker_.record().carriers) {
      if (!carrier.relief) continue;
      material_.relief_is_length = carrier.relief_dimension == length;
      material_.relief = material_.relief ? material_.terms.apply(Operation::add, *material_.relief, *carrier.relief)
                                          : *carrier.relief;
    }
    if (material_.relief || !own.last_height()) return;
    material_.relief = own.last_height()->x;
    material_.relief_is_length = own.last_height()->dimension == length;
  }

  void check_representative(const AssembledMaterial* assembled) {
    bool has_kind = false;
    std::map<std::string, Span> set;
    for (const auto& setting : node_.representative) {
      const auto& key = setting.key.text;
      if (key == "like") continue;  // `assemble` reads it
      if (!is_representative_setting(key)) {
        if (surroundings_.declarations.percepts.find(key)) {
          report(Code::unknown_setting, setting.key.span, fmt::format("a representative block has no setting `{}`", key),
                 fmt::format("{} is a percept: put it into `perceptual {{ … }}`", key));
          continue;
        }
        report(Code::unknown_setting, setting.key.span, fmt::format("a representative block has no setting `{}`", key),
               did_you_mean(setting.key.span, key, representative_settings(),
                            fmt::format("it has: {}", fmt::join(representative_settings(), ", "))));
        continue;
      }
      has_kind = has_kind || key == "kind";
      RepresentativeEntry entry = representative_entry(setting, tree_, surroundings_.diagnostics);
      const auto [first, is_new] = set.emplace(entry.key, setting.key.span);
      if (!is_new)
        report(Code::declared_twice, setting.key.span, fmt::format("`{}` is set twice", entry.key),
               Advice("put everything into one").see(first->second, "set here first"));
      material_.layers.representative.emplace_back(std::move(entry.key), std::move(entry.values));
    }
    if (!has_kind && assembled && assembled->kind) {
      RepresentativeEntry kind =
          representative_entry(*assembled->kind, *assembled->kind_tree, surroundings_.diagnostics);
      material_.layers.representative.emplace_back(std::move(kind.key), std::move(kind.values));
    }
  }

  void report(Code code, Span span, std::string message, Advice advice) {
    surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
  }

  const SyntaxTree& tree_;
  const MaterialDecl& node_;
  const Declared<MaterialDecl>& declared_;
  const Surroundings& surroundings_;
  CheckedMaterial material_;
  ExpressionChecker checker_;
  bool whole_;
  /// Keeps what `check_usage` has said from that place on, and the exchanged arguments that were reported before.
  void keep_doubts(std::size_t usage) {
    const auto& all = surroundings_.diagnostics.all();
    for (std::size_t i = std::min(said_before_, all.size()); i < all.size(); ++i)
      if (i >= usage || all[i].code == Code::swapped_arguments) material_.doubts.push_back(all[i]);
  }

  std::size_t errors_before_;
  std::size_t said_before_;
};

}  // namespace

CheckedMaterial check_material(const Declared<MaterialDecl>& declared, const Surroundings& surroundings, bool whole) {
  return MaterialChecker(declared, surroundings, whole).check();
}

}  // namespace wale
