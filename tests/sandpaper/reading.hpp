#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "wale/memory.hpp"
#include "wale/program.hpp"

namespace wale::sandpaper {

inline const std::string folder = std::string(WALE_SOURCE_DIR) + "/library/sandpaper/";

/// A file of library/sandpaper, or a text in its place, read and checked. Throws std::runtime_error with the
/// diagnostics when there are errors or warnings.
class Module {
 public:
  explicit Module(const std::string& file) : Module(file, read(file)) {}

  Module(const std::string& file, std::string text) {
    source_ = sources_.add(folder + file, std::move(text));
    module_ = check_source(sources_, source_, *resolver_, diagnostics_);
    refuse_complaints();
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& material : module_.materials) all.push_back(material.name);
    return all;
  }

  Program program(const std::string& material) {
    auto made = compile_material(module_, material, default_device, sources_, source_, *resolver_, diagnostics_);
    refuse_complaints();
    return *made;
  }

 private:
  static std::string read(const std::string& file) {
    const auto bytes = read_file(folder + file);
    return bytes->bytes;
  }

  void refuse_complaints() const {
    std::string complaints;
    for (const auto& each : diagnostics_.all()) complaints += render_text(each, sources_, false);
    if (!complaints.empty()) throw std::runtime_error(complaints);
  }

  SourceSet sources_;
  Diagnostics diagnostics_;
  std::unique_ptr<Resolver> resolver_ = file_resolver({});
  SourceId source_ = 0;
  CheckedModule module_;
};

/// Parameters by name, in SI units.
using Parameters = std::map<std::string, double>;

inline Bank bank_with(const Program& program, const Parameters& values) {
  std::vector<float> all = program.default_parameters();
  for (const auto& [name, value] : values) all.at(program.parameter(name).value()) = static_cast<float>(value);
  return Bank(program, all, program.default_size());
}

/// Random parameters within their ranges, rounded to floats, so that a bank holds them exactly.
inline Parameters random_parameters(const Program& program, std::mt19937& random) {
  Parameters values;
  for (const auto& declared : program.description().parameters) {
    const double share = static_cast<double>(random()) / 4294967296.0;
    values[declared.name] = static_cast<float>(declared.low + share * (declared.high - declared.low));
  }
  return values;
}

/// The defaults, by name.
inline Parameters default_parameters(const Program& program) {
  Parameters values;
  const auto defaults = program.default_parameters();
  for (std::size_t i = 0; i < defaults.size(); ++i) values[program.description().parameters[i].name] = defaults[i];
  return values;
}

/// Uniform in -size .. size, rounded to a float.
inline double uniform(std::mt19937& random, double size) {
  return static_cast<float>(size * (static_cast<double>(random()) / 2147483648.0 - 1));
}

/// A vector in double precision.
struct Pair {
  double x = 0, y = 0;
  friend Pair operator+(Pair a, Pair b) { return {a.x + b.x, a.y + b.y}; }
  friend Pair operator-(Pair a, Pair b) { return {a.x - b.x, a.y - b.y}; }
  friend Pair operator*(double k, Pair a) { return {k * a.x, k * a.y}; }
};
inline double dot(Pair a, Pair b) { return a.x * b.x + a.y * b.y; }
inline double size(Pair a) { return std::sqrt(dot(a, a)); }

}  // namespace wale::sandpaper
