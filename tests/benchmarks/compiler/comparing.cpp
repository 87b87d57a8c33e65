// How long it takes to compare a library with itself: `wale compare` of a thousand files, and the pairs alone.
#include <benchmark/benchmark.h>

#include <cmath>

#include "compiler/command/memory.hpp"
#include "compiler/compare/compare.hpp"
#include "compiler/compare/compare_files.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/benchmarks/compiler/materials.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::benchmarks::comparing_test {
namespace {

/// Material `number` of many, none like another: textures, mixtures, fluids, springs, walls and what lies between.
std::string one_of_many(std::size_t number) {
  const double way = static_cast<double>(number % 997) / 997;  // 0 .. 1, all over it
  const auto size = [&](double low, double high) { return low * std::pow(high / low, way); };
  const std::string forces[] = {
      fmt::format("lateral(grating(x, period: {:.4f} mm), amplitude: {:.4f} N)", size(0.8, 9), size(4, 0.3)),
      fmt::format("lateral(grating(x, period: {:.4f} mm, duty: 0.3) + grating(y, period: {:.4f} mm), amplitude: 1.5 N)",
                  size(1, 8), size(7, 1.2)),
      fmt::format("lateral(gradient_noise(x / {0:.4f} mm, y / {0:.4f} mm), amplitude: {1:.4f} N)", size(1, 9),
                  size(0.4, 3)),
      fmt::format("viscous({:.4f} N s/m) + sticky({:.4f} N)", size(0.5, 12), size(1.5, 0.2)),
      fmt::format("spring({:.4f} N/m)", size(15, 240)),
      fmt::format("firm({:.4f} N/m)", size(100, 1500)),
      fmt::format("lateral(grating(length(hand), period: {:.4f} mm), amplitude: 1 N) + viscous({:.4f} N s/m)",
                  size(1, 6), size(1, 8)),
      fmt::format("bumps(grating(x, period: {:.4f} mm, smooth: 0.25), amplitude: {:.4f} N)", size(12, 60), size(1, 4)),
  };
  return fmt::format("wale 1\n\nmaterial m{} {{\n  physical {{\n    force = {}\n  }}\n}}\n", number,
                     forces[number % std::size(forces)]);
}

/// A folder of many files, a material each, gone with it.
class ManyFiles {
 public:
  explicit ManyFiles(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) names_.push_back(folder_.write(fmt::format("m{}.wale", i), one_of_many(i)));
  }

  const std::vector<std::string>& names() const { return names_; }

 private:
  TemporaryFolder folder_;
  std::vector<std::string> names_;
};

std::vector<Cues> cues_of_all(const std::vector<ComparedFile>& files) {
  std::vector<Cues> all;
  for (const ComparedFile& file : files) {
    if (!file.opened) throw std::runtime_error(in_words(file.opened.error()));
    for (const auto& each : file.opened->diagnostics.all())
      if (severity_of(each.code) == Severity::error)
        throw std::runtime_error(render_text(each, file.opened->sources, false));
    all.insert(all.end(), file.cues.begin(), file.cues.end());
  }
  return all;
}

/// From many files to the text that a person reads.
void CompareFiles(benchmark::State& state) {
  command::keep_freed_memory();  // as the command does
  const ManyFiles files(static_cast<std::size_t>(state.range(0)));
  const auto common = common_modules();
  for (auto _ : state) {
    const auto read = read_cues(files.names(), {}, common->declarations);
    const ComparisonMatrix matrix(cues_of_all(read), common->declarations);
    if (matrix.materials().size() != files.names().size()) throw std::runtime_error("a material is missing");
    benchmark::DoNotOptimize(comparison_text(matrix));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(CompareFiles)->Arg(20)->Arg(1000)->Iterations(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Half a million pairs of materials that have been read.
void CompareHalfAMillionPairs(benchmark::State& state) {
  std::vector<Cues> materials;
  for (std::size_t i = 0; i < 1000; ++i) {
    Cues& cues = materials.emplace_back(Cues{"m", default_device, {}});
    for (std::size_t cue = 0; cue < cue_count; ++cue)
      if ((i * 31 + cue * 17) % 5 != 0)
        cues.values[cue] = 0.1 + static_cast<double>((i * 7919 + cue * 104729) % 1000) / 50;
  }
  const auto common = common_modules();
  for (auto _ : state) {
    const ComparisonMatrix matrix(materials, common->declarations);
    benchmark::DoNotOptimize(matrix.nearest(20));
  }
  state.SetItemsProcessed(state.iterations() * 499'500);
}
BENCHMARK(CompareHalfAMillionPairs)->Unit(benchmark::kMillisecond);

/// What `wale compare --json` writes of a thousand.
void WriteAMatrixOfAThousand(benchmark::State& state) {
  std::vector<Cues> materials;
  for (std::size_t i = 0; i < 1000; ++i) {
    Cues& cues = materials.emplace_back(Cues{"m", default_device, {}});
    cues[CueKind::amplitude] = 0.2 + static_cast<double>(i * 7919 % 1000) / 200;
    cues[CueKind::period] = 1e-3 + static_cast<double>(i * 104729 % 1000) / 2e5;
  }
  const ComparisonMatrix matrix(materials, common_modules()->declarations);
  for (auto _ : state) benchmark::DoNotOptimize(comparison_json(matrix));
}
BENCHMARK(WriteAMatrixOfAThousand)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wale::benchmarks::comparing_test
