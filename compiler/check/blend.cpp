#include "compiler/check/blend.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/expression/formal_use.hpp"

namespace wale {

namespace {

/// If the sum of the weights is less than this, all components are absent; dividing by the sum would be meaningless.
constexpr double least_whole = 1e-6;

}  // namespace

std::optional<Value> Blender::compose(const AssembledMaterial& assembled, StatementChecker& own) {
  constexpr std::size_t operations_of_a_component = 32;
  if (!charge(operations_of_a_component * assembled.components.size())) return std::nullopt;
  Superposition sum;
  std::vector<TermId> weights;
  for (const auto& component : assembled.components) weights.push_back(add_weight(component));
  if (!weights.empty()) {
    const TermId whole = whole_of(weights);
    for (std::size_t i = 0; i < weights.size(); ++i)
      superpose(assembled.components[i], weights[i], material_.terms.apply(Operation::divide, weights[i], whole, span_),
                sum);
  }
  if (surroundings_.diagnostics.is_spent()) return std::nullopt;
  if (!checker_.spender()) warn_of_idle_weights(assembled, weights, sum);
  if (!sum.textures.empty()) add_textures(sum);
  own.check(assembled.statements);
  for (const auto& layer : own.layers()) sum.force = add(sum.force, layer.force);
  levels_ = std::move(sum.levels);
  return sum.force;
}

/// An open texture that is alone is as large as the level says, however much there is of it.
void Blender::warn_of_idle_weights(const AssembledMaterial& assembled, const std::vector<TermId>& weights,
                                   const Superposition& sum) {
  if (weights.size() > 1 && std::ranges::any_of(assembled.percepts, &AskedPercept::blended)) return;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto& component = assembled.components[i];
    const auto is_own = [&](const Texture& texture) { return texture.weight == weights[i]; };
    const bool textured = std::ranges::any_of(sum.textures, is_own);
    if (component.weight == 1 || !textured || sum.textures.size() > 1 ||
        std::ranges::find(sum.weighed, weights[i]) != sum.weighed.end())
      continue;
    surroundings_.diagnostics.report(
        {.code = Code::unused_name,
         .span = component.span,
         .message = fmt::format("the weight of `{}` has no effect: its texture is the only one, and its size follows "
                                "from the level",
                                component.name),
         .help = "leave the weight out, and ask for another level in a `perceptual` block"});
  }
}

/// Makes the weight a parameter, so that a slider can move a blend from one component to another.
TermId Blender::add_weight(const AssembledMaterial::Component& component) {
  const std::string name = material_.parameter_names.free(material_.parameters, component.weight_name);
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

/// The sum of the weights, by which each is divided for its share; a share is 0 if all weights are 0.
TermId Blender::whole_of(const std::vector<TermId>& weights) {
  Terms& terms = material_.terms;
  TermId whole = weights.front();
  for (std::size_t i = 1; i < weights.size(); ++i) whole = terms.apply(Operation::add, whole, weights[i], span_);
  return terms.apply(Operation::maximum, whole, terms.literal(least_whole, span_), span_);
}

void Blender::superpose(const AssembledMaterial::Component& component, TermId weight, TermId share,
                        Superposition& sum) {
  if (surroundings_.diagnostics.is_spent()) return;
  const std::optional<Span> spender = checker_.spender();  // the outermost component, which the author wrote
  if (!spender) checker_.spend_on(component.span);
  const std::size_t first_carrier = checker_.record().carriers.size();
  StatementChecker statements(material_, checker_, surroundings_, component.name);
  const std::size_t errors_before = surroundings_.diagnostics.error_count();
  const auto force = compose(*component.material, statements);
  add_levels(component, share, sum);
  if (force) add_leaves(*force, weight, component.name, first_carrier, sum);
  checker_.spend_on(spender);
  if (!force) {
    if (surroundings_.diagnostics.error_count() == errors_before)
      surroundings_.diagnostics.report(
          {.code = Code::different_structures,
           .span = span_,
           .message = fmt::format("`{}` has percepts but no force, so there is nothing to blend", component.name),
           .help = "give it a `physical` block, or leave it out and ask for its percepts in the blend"});
  }
}

/// Separates the open textures of a component's force, which is a sum, from its other terms.
void Blender::add_leaves(const Value& force, TermId weight, const std::string& name, std::size_t first_carrier,
                         Superposition& sum) {
  auto& carriers = checker_.record().carriers;
  CarriersByForce by_force;
  for (std::size_t i = first_carrier; i < carriers.size(); ++i)
    by_force[{carriers[i].force_x, carriers[i].force_y}].push_back(i);
  std::vector<Value> waiting{force};
  while (!waiting.empty()) {
    constexpr std::size_t operations_of_a_leaf = 8;
    if (!charge(operations_of_a_leaf)) return;
    const Value leaf = waiting.back();
    waiting.pop_back();
    const Term x = material_.terms[leaf.x], y = material_.terms[leaf.y];
    const bool is_sum = x.kind == TermKind::operation && x.operation == Operation::add &&
                        y.kind == TermKind::operation && y.operation == Operation::add;
    if (by_force.contains({leaf.x, leaf.y}) || !is_sum) {
      add_leaf(weight, name, leaf, by_force, sum);
      continue;
    }
    for (const auto& [a, b] : {std::pair{x.b, y.b}, std::pair{x.a, y.a}}) {
      Value part = leaf;
      part.x = a, part.y = b;
      waiting.push_back(part);
    }
  }
  std::size_t index = 0;
  std::erase_if(carriers, [&](const Carrier&) { return std::ranges::binary_search(sum.taken, index++); });
  sum.taken.clear();
}

/// Adds the levels that a component or its own components ask for, each weighted by the component's share.
void Blender::add_levels(const AssembledMaterial::Component& component, TermId share, Superposition& sum) {
  for (const auto& asked : component.material->percepts) {
    auto& all = sum.levels[asked.name];
    if (!asked.blended) {
      all.push_back({component.name, asked.level, share});
      continue;
    }
    const auto& parts = levels_[asked.name];
    if (!charge(4 * parts.size())) return;
    for (LevelShare part : parts) {
      part.share = material_.terms.apply(Operation::multiply, share, part.share, span_);
      all.push_back(std::move(part));
    }
  }
}

void Blender::add_leaf(TermId weight, const std::string& name, const Value& leaf, CarriersByForce& by_force,
                       Superposition& sum) {
  Carrier* carrier = nullptr;
  if (const auto found = by_force.find({leaf.x, leaf.y}); found != by_force.end()) {
    const std::size_t index = found->second.front();
    carrier = &checker_.record().carriers[index];
    found->second.erase(found->second.begin());
    if (found->second.empty()) by_force.erase(found);
    if (carrier->open) {
      sum.textures.push_back({weight, *carrier, name});
      sum.taken.insert(std::ranges::lower_bound(sum.taken, index), index);
      return;
    }
  }
  if (!carrier && material_.terms.dependence(leaf.x).on(Dependence::open)) {
    surroundings_.diagnostics.report(
        {.code = Code::different_structures,
         .span = span_,
         .message = fmt::format("the open texture of `{}` is not a separate term of its force", name),
         .help = "write its force as a sum with the texture as one term, or give the texture an amplitude"});
    return;
  }
  sum.weighed.push_back(weight);
  const Value weighed = scaled(leaf, weight);
  if (carrier) {
    carrier->size = material_.terms.apply(Operation::multiply, carrier->size, weight);
    carrier->force_x = weighed.x;
    carrier->force_y = weighed.y;
  }
  sum.force = add(sum.force, weighed);
}

/// Whether the textures can be solved as one, by one size: all are of heights, by the same force function. Otherwise
/// reports the first that cannot.
bool Blender::can_be_one(const std::vector<Texture>& textures) {
  const auto refuse = [&](std::string message, std::string help) {
    surroundings_.diagnostics.report(
        {.code = Code::different_structures, .span = span_, .message = std::move(message), .help = std::move(help)});
    return false;
  };
  const Texture& first = textures.front();
  for (const auto& texture : textures) {
    if (!texture.carrier.relief)
      return refuse(
          fmt::format("`{}` of `{}` is left open, and it is not the texture of a height", texture.carrier.name,
                      texture.component),
          fmt::format("give it its size in `{}`: a blend has one open size, that of its texture", texture.component));
    if (texture.carrier.name != first.carrier.name)
      return refuse(fmt::format("`{}` of `{}` and `{}` of `{}` are both left open", first.carrier.name, first.component,
                                texture.carrier.name, texture.component),
                    "give one of them its size: a blend has one open size, so its open textures must be made by the "
                    "same force function");
  }
  return true;
}

/// Replaces several textures by one: the same force function of the blended height, with its size open again.
void Blender::add_textures(Superposition& sum) {
  const auto textures = sum.textures;
  constexpr std::size_t operations_of_a_texture = 32;
  if (!charge(operations_of_a_texture * textures.size())) return;
  const std::string function_name = textures.front().carrier.name.substr(0, textures.front().carrier.name.find(' '));
  if (!can_be_one(textures)) return;
  for (const auto& texture : textures) material_.blended_opens.insert(material_.terms[texture.carrier.size].index);
  const auto* function = surroundings_.declarations.functions.find(function_name);
  const auto height = blended_height(textures);
  if (!function || !height) return;
  std::vector<Actual> actuals(function->node->parameters.size());
  const auto of_height = height_of(*function->node);
  if (!of_height) return;
  actuals[*of_height] = {.value = *height, .span = span_, .given = true};
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
  std::optional<TermId> height, whole;
  for (const auto& [weight, carrier, component] : textures) {
    const TermId along_x = terms.add({.kind = TermKind::gradient, .a = *carrier.relief, .index = 0, .span = span_});
    const TermId along_y = terms.add({.kind = TermKind::gradient, .a = *carrier.relief, .index = 1, .span = span_});
    const TermId squares = terms.apply(Operation::add, terms.apply(Operation::multiply, along_x, along_x, span_),
                                       terms.apply(Operation::multiply, along_y, along_y, span_), span_);
    const TermId slope = terms.apply(Operation::square_root, squares, span_);
    const TermId steepest = terms.add({.kind = TermKind::peak, .a = slope, .span = span_});
    if (!whole) whole = whole_of(weights);
    const TermId of_whole = terms.apply(Operation::divide, weight, *whole, span_);
    const TermId share = terms.apply(Operation::multiply,
                                     terms.apply(Operation::divide, *carrier.relief, steepest, span_), of_whole, span_);
    height = height ? terms.apply(Operation::add, *height, share, span_) : share;
  }
  if (!height) return std::nullopt;
  return Value{.type = Value::Type::number,
               .x = *height,
               .dimension = surroundings_.declarations.dimension("length"),
               .span = span_};
}

bool Blender::charge(std::size_t operations) {
  const std::optional<Span> spender = checker_.spender();
  return surroundings_.diagnostics.charge(operations, spender ? *spender : span_, Work::blend);
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
