// How long it takes to read a program's force and to say what it feels like. Bars: describing 10 ms; reading 1 000
// materials for a comparison 10 s on two cores.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "compiler/command/memory.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_extracted.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"
#include "tests/benchmarks/compiler/materials.hpp"

namespace wale::benchmarks::describing_test {
namespace {

Program made(const std::string& statements) {
  return loaded(compiled("wale 1\nmaterial m { physical {\n" + statements + "\n} }\n"));
}

/// A material of the library, with what it imports and its pictures.
Program shipped(const std::string& file) {
  const std::string path = std::string(WALE_SOURCE_DIR) + "/library/" + file;
  std::ifstream stream(path, std::ios::binary);
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({WALE_SOURCE_DIR "/library"});
  const SourceId source = sources.add(path, std::string(std::istreambuf_iterator<char>(stream), {}));
  auto program = compile(sources, source, "", default_device, *resolver, diagnostics);
  if (!program) throw std::runtime_error(render_text(diagnostics.all().front(), sources, false));
  return *program;
}

const Declarations& declarations() { return common_modules()->declarations; }

/// The one that has a bar: 10 ms.
Program five_percepts() { return loaded(compiled(material_of_five_percepts)); }
Program velvet() { return shipped("fabric/velvet.wale"); }
Program corduroy() { return shipped("fabric/corduroy.wale"); }
Program perlin() { return made("force = lateral(1 mm * noise2(x / 2 mm, y / 2 mm), amplitude: 1 N)"); }
Program spring() { return made("force = -120 N/m * hand"); }
Program oil() { return shipped("fluid/oil.wale"); }
Program grille() { return shipped("metal/grille.wale"); }
Program photograph() { return shipped("stone/slate.wale"); }
Program friction() {
  return made(
      "state anchor : position = hand in -115 mm .. 115 mm\nlet stretch = hold(hand - anchor, 2 mm)\n"
      "next anchor = hand - stretch\nforce = -500 N/m * stretch");
}

/// The carriers of everything that is felt.
void Extract(benchmark::State& state, Program (*make)()) {
  const Bank bank(make());
  for (auto _ : state) benchmark::DoNotOptimize(read(bank, declarations()));
}
/// And what follows from them.
void DescribeExtracted(benchmark::State& state, Program (*make)()) {
  const Bank bank(make());
  const Description plain = describe(bank, declarations(), Texture::left_out);
  for (auto _ : state) {
    Description description = plain;
    describe_extracted(description, bank, read(bank, declarations()), declarations());
    benchmark::DoNotOptimize(description);
  }
}
/// Processor time, s, of so many ticks as fill a plane of 256 by 256 places.
double seconds_of_a_plane(const Bank& bank) {
  constexpr std::size_t lines = 8, columns = 8192;
  std::vector<Hand> hands(columns);
  for (std::size_t i = 0; i < columns; ++i) hands[i].position = {static_cast<float>(i) * 5e-6f, 0};
  std::vector<Force> forces(columns);
  const std::clock_t begin = std::clock();
  for (std::size_t line = 0; line < lines; ++line) {
    tick_all(bank, hands, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// All that `wale describe` tells. `planes`: how many times as long as the force at 256 by 256 places of it, which a
/// busy machine leaves as it is.
void Describe(benchmark::State& state, Program (*make)()) {
  const Bank bank(make());
  double planes = seconds_of_a_plane(bank);
  const std::clock_t begin = std::clock();
  for (auto _ : state) benchmark::DoNotOptimize(describe(bank, declarations()));
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  planes += seconds_of_a_plane(bank);
  state.counters["planes"] = seconds / static_cast<double>(state.iterations()) / (0.5 * planes);
}

/// Every material of one in `state.range(0)` of the library's files: how much processor time half of them take at most,
/// all but a twentieth, and the slowest, ms; and half of those that ask for one percept.
template <class What>
void each_of_the_library(benchmark::State& state, What what) {
  command::keep_freed_memory();  // as the command does
  std::vector<Program> programs;
  const auto resolver = file_resolver({WALE_SOURCE_DIR "/library"});
  std::int64_t file = 0;
  for (const auto& [path, text] : shipped_files()) {
    if (!path.starts_with(WALE_SOURCE_DIR "/library/") || file++ % state.range(0) != 0) continue;
    SourceSet sources;
    Diagnostics diagnostics;
    const SourceId source = sources.add(path, text);
    const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
    for (const CheckedMaterial& material : module.materials)
      if (auto program =
              compile_material(module, material.name, default_device, sources, source, *resolver, diagnostics))
        programs.push_back(*std::move(program));
  }
  std::vector<double> took(programs.size(), HUGE_VAL);
  for (auto _ : state)
    for (std::size_t i = 0; i < programs.size(); ++i) {
      const Bank bank(programs[i]);
      const std::clock_t begin = std::clock();
      what(bank);
      took[i] = std::min(took[i], 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
  std::vector<double> one_percept;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const auto& percepts = programs[i].description().percepts;
    if (std::ranges::count_if(percepts, [](const PerceptRecord& each) { return each.parameter.has_value(); }) == 1)
      one_percept.push_back(took[i]);
  }
  std::ranges::sort(one_percept);
  std::ranges::sort(took);
  if (!one_percept.empty()) state.counters["median_of_one_percept"] = one_percept[one_percept.size() / 2];
  state.counters["median"] = took[took.size() / 2];
  state.counters["p95"] = took[took.size() * 95 / 100];
  state.counters["slowest"] = took.back();
  state.counters["above_10_ms"] =
      static_cast<double>(std::ranges::count_if(took, [](double time) { return time > 10; }));
}
void ReadLibrary(benchmark::State& state) {
  each_of_the_library(state, [](const Bank& bank) { benchmark::DoNotOptimize(read(bank, declarations())); });
}
void DescribeLibrary(benchmark::State& state) {
  each_of_the_library(state, [](const Bank& bank) { benchmark::DoNotOptimize(describe(bank, declarations())); });
}
BENCHMARK(ReadLibrary)->ArgName("one_in")->Arg(40)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(DescribeLibrary)->ArgName("one_in")->Arg(40)->Arg(1)->Unit(benchmark::kMillisecond);

#define EACH_MATERIAL(what)                                                             \
  BENCHMARK_CAPTURE(what, five_percepts, five_percepts)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(what, corduroy, corduroy)->Unit(benchmark::kMillisecond);           \
  BENCHMARK_CAPTURE(what, velvet, velvet)->Unit(benchmark::kMillisecond);               \
  BENCHMARK_CAPTURE(what, grille, grille)->Unit(benchmark::kMillisecond);               \
  BENCHMARK_CAPTURE(what, perlin, perlin)->Unit(benchmark::kMillisecond);               \
  BENCHMARK_CAPTURE(what, photograph, photograph)->Unit(benchmark::kMillisecond);       \
  BENCHMARK_CAPTURE(what, spring, spring)->Unit(benchmark::kMillisecond);               \
  BENCHMARK_CAPTURE(what, oil, oil)->Unit(benchmark::kMillisecond);                     \
  BENCHMARK_CAPTURE(what, stateful_friction, friction)->Unit(benchmark::kMillisecond)

EACH_MATERIAL(Extract);
EACH_MATERIAL(DescribeExtracted);
EACH_MATERIAL(Describe);

}  // namespace
}  // namespace wale::benchmarks::describing_test
