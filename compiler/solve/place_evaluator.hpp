#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/check/check.hpp"
#include "compiler/expression/check_expression.hpp"

namespace wale {

/// How a hand moves, m/s and m/s^2.
struct EvenMotion {
  glm::dvec2 velocity{0}, acceleration{0};
};

/// Evaluates terms at places of the patch at time 0, with the parameters at their defaults, of a hand at rest or in the
/// same motion everywhere.
class PlaceEvaluator {
 public:
  /// With `heights`, the slopes and peaks of heights are evaluated too, by differences in the place.
  PlaceEvaluator(const CheckedMaterial& material, const DeviceProfile& device, std::vector<TermId> roots,
                 bool heights = false, const EvenMotion& motion = {})
      : terms_(material.terms), roots_(std::move(roots)), motion_(motion) {
    // As the finished program's, which is cut to the workspace.
    const double widest = device.widest_patch();
    const double width = std::min(material.patch ? (*material.patch)[0] : device.patch_width, widest);
    const double height = std::min(material.patch ? (*material.patch)[1] : device.patch_height, widest);
    rim_ = std::min(device.patch_rim, 0.25 * std::min(width, height));
    half_width_ = width / 2;
    half_height_ = height / 2;
    seconds_per_tick_ = device.rate > 0 ? 1 / device.rate : 0;
    collect(material, device, heights);
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
    for (const TermId id : varying_) values_[id] = value_at_place(id, x, y);
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
  void collect(const CheckedMaterial& material, const DeviceProfile& device, bool heights) {
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
      if (heights && (term.kind == TermKind::gradient || term.kind == TermKind::peak)) {
        PlaceEvaluator& height = heights_.emplace_back(id, PlaceEvaluator(material, device, {term.a}, true)).second;
        possible_ = possible_ && height.possible();
        continue;
      }
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
      else if (term.kind == TermKind::peak)
        values_[id] = height_of(id)->peak();
      else if (term.kind == TermKind::parameter)
        values_[id] = term.index < material.parameters.size() ? material.parameters[term.index].value : 0;
      else if (term.known())
        values_[id] = term.value;
      else if (!term.dependence.on(Dependence::position))
        values_[id] = value_at_place(id, 0, 0);
      else
        varying_.push_back(id);
    }
  }

  PlaceEvaluator* height_of(TermId id) {
    const auto found = std::ranges::find(heights_, id, &std::pair<TermId, PlaceEvaluator>::first);
    return found == heights_.end() ? nullptr : &found->second;
  }

  double value_at_place(TermId id, double x, double y) {
    PlaceEvaluator* height = height_of(id);
    if (height == nullptr) return value_of(terms_[id], x, y);
    constexpr double beside = 1e-6;  // m
    const double dx = terms_[id].index == 0 ? beside : 0, dy = beside - dx;
    return (height->value_at(x + dx, y + dy) - height->value_at(x - dx, y - dy)) / (2 * beside);
  }

  /// The 99th percentile of the first root over the patch less its rim.
  double peak() {
    constexpr int side = 48;
    std::vector<double> values;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        values.push_back(
            value_at(reach_x() * (2.0 * i + 0.9 - side) / side, reach_y() * (2.0 * j + 1.1 - side) / side));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size()));
    std::ranges::nth_element(values, at);
    return *at;
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
      case Input::velocity_x:
      case Input::raw_velocity_x: return motion_.velocity.x;
      case Input::velocity_y:
      case Input::raw_velocity_y: return motion_.velocity.y;
      case Input::acceleration_x:
      case Input::raw_acceleration_x: return motion_.acceleration.x;
      case Input::acceleration_y:
      case Input::raw_acceleration_y: return motion_.acceleration.y;
      default: return 0;
    }
  }

  const Terms& terms_;
  std::vector<TermId> roots_, varying_;
  EvenMotion motion_;
  std::vector<std::pair<TermId, PlaceEvaluator>> heights_;  ///< of each slope and peak
  std::vector<double> values_, sizes_;
  double half_width_ = 0, half_height_ = 0, rim_ = 0, seconds_per_tick_ = 0;
  bool possible_ = true;
};

}  // namespace wale
