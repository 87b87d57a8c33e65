// How long it takes to measure a program, which ends every compilation. Bar: 2 ms.

#include <benchmark/benchmark.h>

#include "compiler/measure/measure.hpp"
#include "tests/benchmarks/compiler/materials.hpp"

namespace wale::benchmarks::measuring_test {
namespace {

/// From what the compiler gives away: verified anew and decoded, its peaks taken, then measured.
void MeasureAProgram(benchmark::State& state) {
  const PatchProgram program = compiled(material_of_40_lines);
  for (auto _ : state) benchmark::DoNotOptimize(measure(Bank(loaded(program))));
}
BENCHMARK(MeasureAProgram)->Unit(benchmark::kMicrosecond);

/// Its peaks, which every change of a parameter works out again.
void FillABank(benchmark::State& state) {
  const Program program = loaded(compiled(material_of_40_lines));
  for (auto _ : state) benchmark::DoNotOptimize(Bank(program));
}
BENCHMARK(FillABank)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace wale::benchmarks::measuring_test
