// How the work of the compiler grows with each construct of the language, and with each inside another: a search for
// texts that take more than they deserve. `build/tests/bench_growth [MILLISECONDS]` prints those that take longer.

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "compiler/format/format.hpp"
#include "tests/compiler/compiling.hpp"
#include "tests/compiler/growing.hpp"

namespace wale::growing {
namespace {

double bar = 20;  // ms

double milliseconds_since(std::chrono::steady_clock::time_point before) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count();
}

void measure(const std::string& name, int n, const std::string& text) {
  compiling::Files files;
  files.contents["relation.csv"] = "x (mm), force (N)\n0, 0\n1, 1\n2, 0\n";
  alarm(60);  // a text that takes longer than this ends the search
  fmt::print("\r{} {}\033[K", name, n);
  std::fflush(stdout);
  const auto before = std::chrono::steady_clock::now();
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("growing.wale", text);
  const CheckedModule module = check_source(sources, source, files, diagnostics);
  const double checked = milliseconds_since(before);
  const std::size_t taken = diagnostics.budget().taken();
  std::string result = "good";
  double compiled = 0;
  const auto outcome = [&](const Diagnostics& of) {
    for (const auto& each : of.all())
      if (severity_of(each.code) == Severity::error)
        return fmt::format("{} {}", code_name(each.code), each.message.substr(0, 50));
    return std::string("good");
  };
  if (diagnostics.has_errors()) {
    result = outcome(diagnostics);
    for (const auto& each : diagnostics.all()) render_text(each, sources, false);
  } else if (!module.materials.empty()) {
    Diagnostics own;
    const auto start = std::chrono::steady_clock::now();
    compile_material(module, module.materials.back().name, default_device, sources, source, files, own);
    compiled = milliseconds_since(start);
    result = outcome(own);
    if (own.budget().taken() > taken) result += fmt::format(" ({} to compile)", own.budget().taken());
  }
  const double all = milliseconds_since(before);
  const auto start = std::chrono::steady_clock::now();
  Diagnostics ignored;
  format(sources, source, ignored);
  const double formatted = milliseconds_since(start);
  if (all > bar || formatted > bar)
    fmt::print("\r\033[K{:>6} bytes {:7.1f} + {:6.1f} ms, {:6.1f} to format, {:>8} operations, {}: {} {}\n",
               text.size(), checked, all - checked, formatted, taken, result, name, n);
}

}  // namespace
}  // namespace wale::growing

int main(int count, char** arguments) {
  using namespace wale::growing;
  const std::string only = count > 2 ? arguments[2] : "";
  if (count > 1) bar = std::atof(arguments[1]);
  const auto body = [](const Part& part) {
    return part.statements + "force = vector(1 N * " + part.value + ", 0 N)\n";
  };
  const auto texture = [](const Part& part) { return part.statements + "force = lateral(" + part.value + ")\n"; };
  const std::vector<int> sizes = {8, 16, 30, 60, 150, 500, 1500, 4000};
  if (only.empty() || only == "texts")
    for (const auto& each : texts())
      for (const int n : sizes) measure(each.name, n, each.grow(n));
  if (only.empty() || only == "expressions")
    for (const auto& each : expressions())
      for (const int n : sizes)
        measure(each.name, n,
                materials()[0].grow(0, each.grow("p", n, "x / 1 mm").declarations, "",
                                    body(each.grow("p", n, "x / 1 mm"))));
  if (only.empty() || only == "materials")
    for (const auto& each : materials())
      for (const int n : sizes) {
        measure(each.name, n, each.grow(n, "", "", "force = spring(1 N/m)\n"));
        measure(std::string(each.name) + " with textures", n,
                each.grow(n, "", "roughness 0.5", "force = lateral(sin(k * x / 1 mm))\n"));
      }
  if (only.empty() || only == "pairs")
    for (const int n : {6, 12, 24, 50}) {
      for (const auto& outer : expressions())
        for (const auto& inner : expressions()) {
          const Part within = inner.grow("q", n, "x / 1 mm");
          Part whole = outer.grow("p", n, within.value);
          whole.declarations.insert(0, within.declarations);
          whole.statements.insert(0, within.statements);
          measure(fmt::format("{} of {}", outer.name, inner.name), n,
                  materials()[0].grow(0, whole.declarations, "", body(whole)));
        }
      for (const auto& outer : materials())
        for (const auto& inner : expressions()) {
          const Part within = inner.grow("q", n, "x / 1 mm");
          measure(fmt::format("{} of {}", outer.name, inner.name), n,
                  outer.grow(n, within.declarations, "", body(within)));
          measure(fmt::format("{} with textures of {}", outer.name, inner.name), n,
                  outer.grow(n, within.declarations, "roughness 0.5", texture(within)));
        }
    }
  fmt::print("\r\033[K");
}
