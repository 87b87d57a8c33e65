#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "wale/patch_program.hpp"

namespace wale {

/// The names of a list of parameters that grows. A blend has thousands, so the names are indexed.
class ParameterNames {
 public:
  bool contains(const std::vector<Parameter>& parameters, const std::string& name) {
    if (parameters.size() <= few) return std::ranges::find(parameters, name, &Parameter::name) != parameters.end();
    for (; indexed_ < parameters.size(); ++indexed_) names_.insert(parameters[indexed_].name);
    return names_.contains(name);
  }

  /// The name itself, or if it is taken the first free one of `name_2`, `name_3` …
  std::string free(const std::vector<Parameter>& parameters, const std::string& name) {
    if (!contains(parameters, name)) return name;
    int& count = counts_.try_emplace(name, 2).first->second;
    std::string numbered;
    while (contains(parameters, numbered = fmt::format("{}_{}", name, count))) ++count;
    return numbered;
  }

 private:
  static constexpr std::size_t few = 16;

  std::size_t indexed_ = 0;
  std::unordered_set<std::string> names_;
  std::unordered_map<std::string, int> counts_;  ///< for each name, a number below which none is free
};

}  // namespace wale
