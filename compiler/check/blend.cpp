#include "compiler/check/blend.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wale {

namespace {

/// If the sum of the weights is less than this, all components are absent; dividing by the sum would be meaningless.
constexpr double least_whole = 1e-6;

}  // namespace

std::optional<Value> Blender::compose(const AssembledMaterial& assembled, StatementChecker& own) {
  Superposition sum;
  std::vector<TermId> weights;
  for (const auto& component : assembled.components) weights.push_back(add_weight(component));
  for (std::size_t i = 0; i < weights.size(); ++i)
    superpose(assembled.components[i], weights[i], share_of(weights[i], weights), sum);
  if (!sum.textures.empty()) add_textures(sum);
  own.check(assembled.statements);
  for (const auto& layer : own.layers()) sum.force = add(sum.force, layer.force);
  levels_ = std::move(sum.levels);
  return sum.force;
}

/// Makes the weight a parameter, so that a slider can move a blend from one component to another.
TermId Blender::add_weight(const AssembledMaterial::Component& component) {
  std::string name = component.weight_name;
  for (int count = 2; std::ranges::find(material_.parameters, name, &Parameter::name) != material_.parameters.end();
       ++count)
    name = fmt::format("{}_{}", component.weight_name, count);
  const auto index = static_cast<std::uint32_t>(material_.parameters.size());
  const float weight = static_cast<float>(component.weight), most = std::max(1.0f, weight);
  material_.parameters.push_back({.name = name,
                                  .unit = "",
                                  .unit_in_si = 1,
                                  .value = weight,
                                  .low = 0,
                                  .high = most,
                                  .soft_low = 0,
                                  .soft_high = most,
                                  .description = fmt::format("how much of {} there is", component.name)});
  material_.parameter_spans.push_back(component.span);
  return material_.terms.parameter(index, component.span);
}

/// A weight divided by the sum of all; 0 if all are 0.
TermId Blender::share_of(TermId weight, const std::vector<TermId>& weights) {
  Terms& terms = material_.terms;
  TermId whole = weights.front();
  for (std::size_t i = 1; i < weights.size(); ++i) whole = terms.apply(Operation::add, whole, weights[i], span_);
  whole = terms.apply(Operation::maximum, whole, terms.literal(least_whole, span_), span_);
  return terms.apply(Operation::divide, weight, whole, span_);
}

void Blender::superpose(const AssembledMaterial::Component& component, TermId weight, TermId share,
                        Superposition& sum) {
  const std::size_t first_carrier = checker_.record().carriers.size();
  StatementChecker statements(material_, checker_, surroundings_, component.name);
  const std::size_t errors_before = surroundings_.diagnostics.error_count();
  const auto force = compose(*component.material, statements);
  add_levels(component, share, sum);
  if (!force) {
    if (surroundings_.diagnostics.error_count() == errors_before)
      surroundings_.diagnostics.report(
          {.code = Code::different_structures,
           .span = span_,
           .message = fmt::format("`{}` has percepts but no force, so there is nothing to blend", component.name),
           .help = "give it a `physical` block, or leave it out and ask for its percepts in the blend"});
    return;
  }
  // The force is a sum. Separate its open textures from the other terms.
  std::vector<Value> waiting{*force};
  while (!waiting.empty()) {
    const Value leaf = waiting.back();
    waiting.pop_back();
    const Term x = material_.terms[leaf.x], y = material_.terms[leaf.y];
    const auto is_carrier = [&](const Carrier& carrier) {
      return carrier.force_x == leaf.x && carrier.force_y == leaf.y;
    };
    const bool carried = std::any_of(checker_.record().carriers.begin() + static_cast<std::ptrdiff_t>(first_carrier),
                                     checker_.record().carriers.end(), is_carrier);
    const bool is_sum = x.kind == TermKind::operation && x.operation == Operation::add &&
                        y.kind == TermKind::operation && y.operation == Operation::add;
    if (carried || !is_sum) {
      add_leaf(weight, component.name, leaf, first_carrier, sum);
      continue;
    }
    for (const auto& [a, b] : {std::pair{x.b, y.b}, std::pair{x.a, y.a}}) {
      Value part = leaf;
      part.x = a, part.y = b;
      waiting.push_back(part);
    }
  }
}

/// Adds the levels that a component or its own components ask for, each weighted by the component's share.
void Blender::add_levels(const AssembledMaterial::Component& component, TermId share, Superposition& sum) {
  for (const auto& asked : component.material->percepts) {
    auto& all = sum.levels[asked.name];
    if (!asked.blended) {
      all.push_back({component.name, asked.level, share});
      continue;
    }
    for (LevelShare part : levels_[asked.name]) {
      part.share = material_.terms.apply(Operation::multiply, share, part.share, span_);
      all.push_back(std::move(part));
    }
  }
}

void Blender::add_leaf(TermId weight, const std::string& name, const Value& leaf, std::size_t first_carrier,
                       Superposition& sum) {
  auto& carriers = checker_.record().carriers;
  const auto found =
      std::find_if(carriers.begin() + static_cast<std::ptrdiff_t>(first_carrier), carriers.end(),
                   [&](const Carrier& carrier) { return carrier.force_x == leaf.x && carrier.force_y == leaf.y; });
  if (found != carriers.end() && found->open) {
    sum.textures.push_back({weight, *found});
    carriers.erase(found);
    return;
  }
  if (found == carriers.end() && material_.terms.dependence(leaf.x).on(Dependence::open)) {
    surroundings_.diagnostics.report(
        {.code = Code::different_structures,
         .span = span_,
         .message = fmt::format("the open texture of `{}` is not a separate term of its force", name),
         .help = "write its force as a sum with the texture as one term, or give the texture an amplitude"});
    return;
  }
  const Value weighed = scaled(leaf, weight);
  if (found != carriers.end()) {
    found->size = material_.terms.apply(Operation::multiply, found->size, weight);
    found->force_x = weighed.x;
    found->force_y = weighed.y;
  }
  sum.force = add(sum.force, weighed);
}

/// Replaces several textures by one: the same force function of the blended height, with its size open again.
void Blender::add_textures(Superposition& sum) {
  const auto textures = sum.textures;
  const std::string function_name = textures.front().carrier.name.substr(0, textures.front().carrier.name.find(' '));
  for (const auto& texture : textures) {
    if (texture.carrier.relief && texture.carrier.name == textures.front().carrier.name) continue;
    surroundings_.diagnostics.report(
        {.code = Code::different_structures,
         .span = span_,
         .message = fmt::format("`{}` is left open in one material and `{}` in another", textures.front().carrier.name,
                                texture.carrier.name),
         .help =
             "only textures of heights can be blended while their sizes are open; give the other forces their sizes"});
    return;
  }
  for (const auto& texture : textures) material_.blended_opens.insert(material_.terms[texture.carrier.size].index);
  const auto* function = surroundings_.declarations.functions.find(function_name);
  const auto height = blended_height(textures);
  if (!function || !height) return;
  std::vector<Actual> actuals(function->node->parameters.size());
  for (std::size_t i = 0; i < actuals.size(); ++i)
    if (function->node->parameters[i].name.text == "height")
      actuals[i] = {.value = *height, .span = span_, .given = true};
  Scope scope;
  scope.hand = true;
  const Value force = checker_.call_with(*function, std::move(actuals), scope, span_);
  if (!force.failed()) sum.force = add(sum.force, force);
}

/// Each height divided by its own steepest slope (the 99th percentile, as for its amplitude) is a length. The result is
/// the sum of these lengths by weight.
std::optional<Value> Blender::blended_height(const std::vector<Texture>& textures) {
  Terms& terms = material_.terms;
  std::vector<TermId> weights;
  for (const auto& texture : textures) weights.push_back(texture.weight);
  std::optional<TermId> height;
  for (const auto& [weight, carrier] : textures) {
    const TermId along_x = terms.add({.kind = TermKind::gradient, .a = *carrier.relief, .index = 0, .span = span_});
    const TermId along_y = terms.add({.kind = TermKind::gradient, .a = *carrier.relief, .index = 1, .span = span_});
    const TermId squares = terms.apply(Operation::add, terms.apply(Operation::multiply, along_x, along_x, span_),
                                       terms.apply(Operation::multiply, along_y, along_y, span_), span_);
    const TermId slope = terms.apply(Operation::square_root, squares, span_);
    const TermId steepest = terms.add({.kind = TermKind::peak, .a = slope, .span = span_});
    const TermId share =
        terms.apply(Operation::multiply, terms.apply(Operation::divide, *carrier.relief, steepest, span_),
                    share_of(weight, weights), span_);
    height = height ? terms.apply(Operation::add, *height, share, span_) : share;
  }
  if (!height) return std::nullopt;
  return Value{.type = Value::Type::number,
               .x = *height,
               .dimension = surroundings_.declarations.dimension("length"),
               .span = span_};
}

Value Blender::scaled(const Value& vector, TermId weight) {
  Value result = vector;
  result.x = material_.terms.apply(Operation::multiply, weight, vector.x, span_);
  result.y = material_.terms.apply(Operation::multiply, weight, vector.y, span_);
  return result;
}

Value Blender::add(const std::optional<Value>& left, const Value& right) {
  if (!left) return right;
  Value result = right;
  result.x = material_.terms.apply(Operation::add, left->x, right.x, span_);
  result.y = material_.terms.apply(Operation::add, left->y, right.y, span_);
  return result;
}

}  // namespace wale
