// How long it takes from a text to a patch program, and how that grows.

#include <benchmark/benchmark.h>

#include "compiler/format/format.hpp"
#include "compiler/parse/lex.hpp"
#include "compiler/parse/parse.hpp"
#include "tests/benchmarks/compiler/materials.hpp"

namespace wale::benchmarks::compiling_test {
namespace {

/// Text to patch program, verified. Bar: 100 us; aim: 40 us. What of it the language's own files take,
/// `TheLanguagesOwnFiles` says. What comes after it counts for itself: `Stage_Load`, which verifies again and decodes,
/// since the runtime trusts nobody's file, and measuring (`measuring.cpp`), which has a bar of its own.
void AMaterialOf40Lines(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(compiled(material_of_40_lines));
}
BENCHMARK(AMaterialOf40Lines)->Unit(benchmark::kMicrosecond);

void TheLanguagesOwnFiles(benchmark::State& state) {
  for (auto _ : state) {
    Desk desk;
    benchmark::DoNotOptimize(check_source(desk.sources, desk.add("wale 1\n"), desk.resolver, desk.diagnostics));
  }
}
BENCHMARK(TheLanguagesOwnFiles)->Unit(benchmark::kMicrosecond);

// The stages of it, each alone.

void Stage_Lex(benchmark::State& state) {
  Desk desk;
  const SourceId source = desk.add(material_of_40_lines);
  for (auto _ : state) benchmark::DoNotOptimize(lex(desk.sources, source, desk.diagnostics));
}
BENCHMARK(Stage_Lex)->Unit(benchmark::kMicrosecond);

void Stage_Parse(benchmark::State& state) {
  Desk desk;
  const SourceId source = desk.add(material_of_40_lines);
  for (auto _ : state) benchmark::DoNotOptimize(parse(desk.sources, source, desk.diagnostics));
  desk.expect_no_errors();
}
BENCHMARK(Stage_Parse)->Unit(benchmark::kMicrosecond);

/// From the checked material on.
struct Checked {
  Desk desk;
  CheckedModule module;

  explicit Checked(const std::string& text)
      : module(check_source(desk.sources, desk.add(text), desk.resolver, desk.diagnostics)) {
    desk.expect_no_errors();
  }
  SolvedMaterial solved() {
    return solve(module.materials.front(), module, default_device, desk.sources, desk.resolver, desk.diagnostics);
  }
};

void Stage_Solve(benchmark::State& state) {
  Checked checked(material_of_40_lines);
  for (auto _ : state) {
    checked.desk.diagnostics.renew_budget();
    benchmark::DoNotOptimize(checked.solved());
  }
}
BENCHMARK(Stage_Solve)->Unit(benchmark::kMicrosecond);

/// A material that says only what it feels like, in five percepts. Bar: 1 ms.
void SolveFivePercepts(benchmark::State& state) {
  Checked checked(material_of_five_percepts);
  for (auto _ : state) {
    checked.desk.diagnostics.renew_budget();
    benchmark::DoNotOptimize(checked.solved());
  }
  checked.desk.expect_no_errors();
}
BENCHMARK(SolveFivePercepts)->Unit(benchmark::kMicrosecond);

void Stage_Lower(benchmark::State& state) {
  const SolvedMaterial solved = Checked(material_of_40_lines).solved();
  for (auto _ : state) {
    Diagnostics diagnostics;
    benchmark::DoNotOptimize(lower(solved, diagnostics));
  }
}
BENCHMARK(Stage_Lower)->Unit(benchmark::kMicrosecond);

void Stage_Emit(benchmark::State& state) {
  const SolvedMaterial solved = Checked(material_of_40_lines).solved();
  Diagnostics diagnostics;
  const LoweredMaterial lowered = lower(solved, diagnostics);
  for (auto _ : state) {
    diagnostics.renew_budget();
    benchmark::DoNotOptimize(emit(lowered, solved, diagnostics));
  }
}
BENCHMARK(Stage_Emit)->Unit(benchmark::kMicrosecond);

void Stage_Verify(benchmark::State& state) {
  const PatchProgram program = emitted(material_of_40_lines);
  for (auto _ : state) benchmark::DoNotOptimize(verify(program));
}
BENCHMARK(Stage_Verify)->Unit(benchmark::kMicrosecond);

/// Not the compiler's: with it begin measuring and running.
void Stage_Load(benchmark::State& state) {
  const PatchProgram program = emitted(material_of_40_lines);
  for (auto _ : state) benchmark::DoNotOptimize(loaded(program));
}
BENCHMARK(Stage_Load)->Unit(benchmark::kMicrosecond);

void CheckTheLibrary(benchmark::State& state) {
  const auto files = shipped_files();
  for (auto _ : state) {
    for (const auto& [name, text] : files) {
      SourceSet sources;
      Diagnostics diagnostics;
      const auto resolver = file_resolver({});
      benchmark::DoNotOptimize(check_source(sources, sources.add(name, text), *resolver, diagnostics));
    }
  }
}
BENCHMARK(CheckTheLibrary)->Unit(benchmark::kMillisecond);

// How it grows: N lines.

void ParseALargeFile(benchmark::State& state) {
  Desk desk;
  const SourceId source = desk.add(large_file(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(parse(desk.sources, source, desk.diagnostics));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(ParseALargeFile)->RangeMultiplier(10)->Range(100, 10000)->Complexity()->Unit(benchmark::kMillisecond);

void FormatALargeFile(benchmark::State& state) {
  Desk desk;
  const SourceId source = desk.add(large_file(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(format(desk.sources, source, desk.diagnostics));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(FormatALargeFile)->RangeMultiplier(10)->Range(100, 10000)->Complexity()->Unit(benchmark::kMillisecond);

void CheckALargeFile(benchmark::State& state) {
  const std::string text = large_file(state.range(0));
  for (auto _ : state) Checked{text};
  state.SetComplexityN(state.range(0));
}
BENCHMARK(CheckALargeFile)->RangeMultiplier(10)->Range(100, 10000)->Complexity()->Unit(benchmark::kMillisecond);

void CompileAChainOfLets(benchmark::State& state) {
  const std::string text = chain_of_lets(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(compiled(text));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(CompileAChainOfLets)->RangeMultiplier(10)->Range(100, 10000)->Complexity()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wale::benchmarks::compiling_test
