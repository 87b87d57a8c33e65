#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/check/check.hpp"
#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Evaluates terms at places of the patch, with a hand at rest at time 0 and the parameters at their defaults.
class PlaceEvaluator {
 public:
  PlaceEvaluator(const CheckedMaterial& material, const DeviceProfile& device, std::vector<TermId> roots)
      : terms_(material.terms), roots_(std::move(roots)) {
    const double width = material.patch ? (*material.patch)[0] : device.patch_width;
    const double height = material.patch ? (*material.patch)[1] : device.patch_height;
    rim_ = std::min(device.patch_rim, 0.25 * std::min(width, height));
    half_width_ = width / 2;
    half_height_ = height / 2;
    seconds_per_tick_ = device.rate > 0 ? 1 / device.rate : 0;
    collect(material);
  }

  /// Whether all that the roots need can be evaluated.
  bool possible() const { return possible_; }
  std::size_t operations() const { return varying_.size(); }
  /// Half the sides of the patch less its rim, m.
  double reach_x() const { return half_width_ - rim_; }
  double reach_y() const { return half_height_ - rim_; }

  /// The value of a root after `at`.
  double operator[](std::size_t root) const { return values_[roots_[root]]; }
  void at(double x, double y) {
    for (const TermId id : varying_) values_[id] = value_of(terms_[id], x, y);
  }
  double value_at(double x, double y) {
    at(x, y);
    return (*this)[0];
  }
  /// After `at`: how large the numbers are of which the first root is the sum, so that its rounding is a share of them.
  double size_of_sum() {
    sizes_.resize(values_.size());
    for (std::size_t id = 0; id < values_.size(); ++id) sizes_[id] = std::abs(values_[id]);
    for (const TermId id : varying_) {
      const Term& term = terms_[id];
      if (term.kind != TermKind::operation) continue;
      const double a = sizes_[term.a], b = sizes_[term.b];
      switch (term.operation) {
        case Operation::add:
        case Operation::subtract: sizes_[id] = a + b; break;
        case Operation::negate: sizes_[id] = a; break;
        case Operation::multiply:
          sizes_[id] = std::max(a * std::abs(values_[term.b]), b * std::abs(values_[term.a]));
          break;
        default: break;
      }
    }
    return sizes_[roots_[0]];
  }

 private:
  /// Finds the terms that the roots need, evaluates those that are the same everywhere, and lists the others in order.
  void collect(const CheckedMaterial& material) {
    values_.resize(terms_.size());
    std::vector<char> needed(terms_.size());
    TermId last = 0;
    for (const TermId root : roots_) needed[root] = 1, last = std::max(last, root);
    for (TermId id = last + 1; id-- > 0;) {
      if (!needed[id]) continue;
      const Term& term = terms_[id];
      if (level_of_table(term, material)) continue;
      const bool is_look_up = term.kind == TermKind::operation &&
                              (term.operation == Operation::sample || term.operation == Operation::recall ||
                               term.operation == Operation::cell || term.operation == Operation::peak);
      const bool is_known_kind = term.kind == TermKind::literal || term.kind == TermKind::input ||
                                 term.kind == TermKind::parameter || term.kind == TermKind::operation;
      if (is_look_up || !is_known_kind) {
        possible_ = false;
        return;
      }
      for (const TermId operand : operands(term)) needed[operand] = 1;
    }
    for (TermId id = 0; id <= last; ++id) {
      if (!needed[id]) continue;
      const Term& term = terms_[id];
      if (const auto level = level_of_table(term, material))
        values_[id] = *level;
      else if (term.kind == TermKind::parameter)
        values_[id] = term.index < material.parameters.size() ? material.parameters[term.index].value : 0;
      else if (term.known())
        values_[id] = term.value;
      else if (!term.dependence.on(Dependence::position))
        values_[id] = value_of(term, 0, 0);
      else
        varying_.push_back(id);
    }
  }

  /// What a look-up in a level table, as a picture of one grey is, gives everywhere: its height or, for a slope, 0.
  std::optional<double> level_of_table(const Term& term, const CheckedMaterial& material) const {
    if (term.kind != TermKind::component) return std::nullopt;
    const Term& look_up = terms_[term.a];
    if (look_up.operation != Operation::sample || look_up.index >= material.tables.size()) return std::nullopt;
    const auto& heights = material.tables[look_up.index].heights;
    if (heights.empty() || std::ranges::adjacent_find(heights, std::not_equal_to{}) != heights.end())
      return std::nullopt;
    return term.index == 0 ? heights[0] : 0;
  }

  double value_of(const Term& term, double x, double y) const {
    if (term.kind == TermKind::operation)
      return result_in_double(term.operation, values_[term.a], values_[term.b], values_[term.c]);
    switch (term.input()) {
      case Input::x:
      case Input::workspace_x: return x;
      case Input::y:
      case Input::workspace_y: return y;
      case Input::patch_half_width: return half_width_;
      case Input::patch_half_height: return half_height_;
      case Input::patch_rim: return rim_;
      case Input::seconds_per_tick: return seconds_per_tick_;
      default: return 0;
    }
  }

  const Terms& terms_;
  std::vector<TermId> roots_, varying_;
  std::vector<double> values_, sizes_;
  double half_width_ = 0, half_height_ = 0, rim_ = 0, seconds_per_tick_ = 0;
  bool possible_ = true;
};

}  // namespace wale
