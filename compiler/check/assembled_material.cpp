#include "compiler/check/assembled_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace wale {

void measure(AssembledMaterial& material) {
  std::size_t levels = 1;
  material.size = material.work = material.statements.size();
  for (const auto& assembled : material.statements)
    if (assembled.value) material.work += assembled.value->parts.size();  // which `between` adds up
  for (const auto& component : material.components) {
    material.size += 1 + component.material->size;
    material.work += 1 + component.material->work;
    levels += component.material->percepts.size();
  }
  material.work += levels * material.percepts.size();
}

std::vector<std::string> parameters_of(const AssembledMaterial& material) {
  std::vector<std::string> all;
  for (const auto& assembled : material.statements)
    if (const auto* param = std::get_if<ParamStatement>(&assembled.statement->what)) all.emplace_back(param->name.text);
  for (const auto& component : material.components) {
    all.push_back(component.weight_name);
    for (auto& name : parameters_of(*component.material)) all.push_back(std::move(name));
  }
  return all;
}

std::vector<std::string> arguments_of(const AssembledMaterial& material) {
  std::vector<std::string> all = parameters_of(material);
  for (const AskedPercept& each : material.percepts) all.push_back(each.name);
  return all;
}

bool set_default(AssembledMaterial& material, std::string_view parameter, const Mixture& value) {
  bool found = false;
  for (auto& assembled : material.statements)
    if (const auto* param = std::get_if<ParamStatement>(&assembled.statement->what);
        param && param->name.text == parameter)
      assembled.value = value, found = true;
  for (auto& component : material.components) {
    auto copy = std::make_shared<AssembledMaterial>(*component.material);
    if (set_default(*copy, parameter, value)) component.material = copy, found = true;
  }
  return found;
}

Dial dial_named(const AssembledMaterial& material, std::string_view name) {
  for (const auto& component : material.components) {
    if (component.weight_name == name) return Dial::weight;
    for (const auto& asked : component.material->percepts)
      if (!asked.blended && component.name + "_" + asked.name == name) return Dial::level;
    if (const Dial within = dial_named(*component.material, name); within != Dial::none) return within;
  }
  return Dial::none;
}

void turn(AssembledMaterial& material, std::string_view name, double value) {
  for (auto& component : material.components) {
    if (component.weight_name == name) component.weight = value;
    auto copy = std::make_shared<AssembledMaterial>(*component.material);
    for (auto& asked : copy->percepts)
      if (!asked.blended && component.name + "_" + asked.name == name) asked.level = value;
    turn(*copy, name, value);
    component.material = copy;
  }
  blend_levels(material);
}

void mix(AssembledMaterial& a, const AssembledMaterial& b, double share, Span made_at) {
  for (std::size_t i = 0; i < a.statements.size(); ++i) {
    const auto* param = std::get_if<ParamStatement>(&a.statements[i].statement->what);
    if (!param) continue;
    if (!a.statements[i].value && !b.statements[i].value) continue;  // both have the parameter's own default
    const auto own = [&](const AssembledStatement& each) {
      return each.value.value_or(Mixture{.parts = {{1, each.tree, param->value, each.home}}});
    };
    Mixture mixed{.parts = {}, .made_at = made_at};
    for (auto part : own(a.statements[i]).parts) part.weight *= 1 - share, mixed.parts.push_back(part);
    for (auto part : own(b.statements[i]).parts) part.weight *= share, mixed.parts.push_back(part);
    a.statements[i].value = std::move(mixed);
  }
  for (auto& percept : a.percepts) {
    const auto& other = *std::ranges::find(b.percepts, percept.name, &AskedPercept::name);
    if (percept.level != other.level || percept.evidence != other.evidence)
      percept.made_at = made_at, percept.evidence.reset();
    percept.level += share * (other.level - percept.level);
    percept.blended = percept.blended && other.blended;
  }
  for (std::size_t i = 0; i < a.components.size(); ++i) {
    auto& component = a.components[i];
    auto copy = std::make_shared<AssembledMaterial>(*component.material);
    mix(*copy, *b.components[i].material, share, made_at);
    component.material = copy;
    component.weight += share * (b.components[i].weight - component.weight);
  }
  measure(a);
  blend_levels(a);
}

void name_weights(std::vector<AssembledMaterial::Component>& components) {
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, int> counts;  // for each name, a number below which none is free
  for (auto& component : components) {
    component.weight_name = component.name + "_weight";
    int& count = counts.try_emplace(component.name, 2).first->second;
    while (!taken.insert(component.weight_name).second)
      component.weight_name = fmt::format("{}_weight_{}", component.name, count++);
  }
}

void blend_levels(AssembledMaterial& material) {
  double whole = 0;
  for (const auto& component : material.components) whole += component.weight;
  for (auto& percept : material.percepts) {
    if (!percept.blended) continue;
    percept.level = 0;
    for (const auto& component : material.components)
      for (const auto& asked : component.material->percepts)
        if (asked.name == percept.name) percept.level += component.weight / whole * asked.level;
  }
}

}  // namespace wale
