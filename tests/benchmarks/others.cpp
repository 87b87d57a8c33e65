// What is not the tick itself, a line each: what, ns (or ms) a piece.
//
//   bench_others [guards]   all, or the guards alone

#include <time.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "runtime/machine/spline.hpp"
#include "runtime/stage/front_most.hpp"
#include "runtime/stage/guards.hpp"
#include "runtime/stage/player.hpp"
#include "tests/benchmarks/measure.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/runtime/figures.hpp"
#include "wale/program.hpp"

namespace wale::benchmarks {
namespace {

/// Time that this thread has worked, ns: what others do on the machine beside it is not counted.
double worked() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// The median over repetitions of `work`, divided by `count`, in ns.
template <class Work>
double timed(std::size_t repetitions, double count, Work&& work) {
  std::vector<double> all;
  for (std::size_t i = 0; i < repetitions + 1; ++i) {
    const double start = worked();
    work();
    if (i > 0) all.push_back((worked() - start) / count);
  }
  return median(all);
}

/// `shaped`: ellipses, polygons of 12 corners and masks of 64 by 64 cells instead of rectangles.
void front_most(std::size_t count, bool shaped = false) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<float> place(-0.1f, 0.1f);
  const float side = 0.4f / std::sqrt(static_cast<float>(count));  // each point under four on average
  std::uniform_real_distribution<float> size(0.5f * side, 1.5f * side);
  std::vector<PatchOutline> patches(count);
  for (PatchOutline& each : patches) {
    each = {{place(random), place(random)}, size(random), size(random), static_cast<float>(random() % 100)};
  }
  if (shaped) {
    std::vector<glm::vec2> star;
    for (int i = 0; i < 12; ++i)
      star.emplace_back((i % 2 == 0 ? 0.01 : 0.006) * std::cos(0.5236 * i),
                        (i % 2 == 0 ? 0.01 : 0.006) * std::sin(0.5236 * i));
    std::vector<std::uint8_t> bits(64 * 64);
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = std::hypot(i % 64 - 31.5, i / 64 - 31.5) < 30 || i % 7 == 0;
    const Shape kinds[] = {*Shape::ellipse(0.01f, 0.01f), *Shape::polygon(star), *Shape::mask(bits, 64, 64, 0.001f)};
    for (std::size_t i = 0; i < count; ++i)
      patches[i].shape = kinds[i % 3].stretched({patches[i].width, patches[i].height});
  }
  double built = 0;
  {
    const double start = worked();
    const FrontMost once(patches);
    built = (worked() - start) * 1e-6;
  }
  const FrontMost all(patches);
  std::vector<glm::dvec2> moving, anywhere;
  for (int i = 0; i < 4096; ++i) {
    const double t = static_cast<double>(i) / 900;
    moving.emplace_back(0.09 * std::sin(2.3 * t), 0.09 * std::sin(1.7 * t + 1));
    anywhere.emplace_back(place(random), place(random));
  }
  // The next point waits for what was found at the last one.
  volatile double sink = 0;
  const auto walk = [&](const std::vector<glm::dvec2>& points) {
    double moved = 0;
    for (const glm::dvec2& point : points) moved = 1e-12 * all.at(point + moved);
    sink = moved;
  };
  const double slow = timed(41, 4096, [&] { walk(moving); }), fast = timed(41, 4096, [&] { walk(anywhere); });
  const char* const kind = shaped ? "_shapes" : "";
  std::printf("front_most_%zu%s_moving %.1f\nfront_most_%zu%s_random %.1f\nfront_most_%zu%s_built_ms %.1f\n", count,
              kind, slow, count, kind, fast, count, kind, built);
}

/// One of a hundred thousand patches moves, others with it or not: what the control side does about it, us.
void move(std::size_t count, std::size_t moving) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<float> place(-0.1f, 0.1f);
  const PatchSize size{.width = 0.001f, .height = 0.001f};
  const Program program = *Program::load(example::program());
  const auto memory = std::make_shared<Memory>(program);
  const auto bank = std::make_shared<const PreparedBank>(Bank(program, program.default_parameters(), size));
  Arrangement arrangement;
  const auto put = [&](std::size_t number, glm::vec2 at) {
    arrangement.put({.bank = bank,
                     .memory = memory,
                     .outline = {at, size.width, size.height, 0, number},
                     .number = static_cast<std::uint32_t>(number)});
  };
  for (std::size_t i = 0; i < count; ++i) put(i, {place(random), place(random)});
  const double arranged = timed(3, 1e6, [&] { arrangement.make_base(); });
  for (std::size_t i = 0; i < moving; ++i) put(i, {place(random), place(random)});
  Exchange<PlacedPatches> exchange;
  std::uint32_t revision = 0;
  PlacedPatches all;
  float x = 0.05f;
  const double once = timed(201, 1e3, [&] {
    put(0, {x = -x, 0});
    all = arrangement.hand_over(++revision);
    exchange.publish(all);
  });
  volatile float sink = 0;
  const double found = timed(41, 4096, [&] {
    double last = 0;
    for (int i = 0; i < 4096; ++i) {
      const double t = static_cast<double>(i) / 900;
      const PlacedPatch* const patch = all.at({0.09 * std::sin(2.3 * t) + last, 0.09 * std::sin(1.7 * t + 1)});
      last = patch != nullptr ? 1e-12 * patch->outline.position.x : 0;
    }
    sink = static_cast<float>(last);
  });
  std::printf("move_%zu_of_%zu_us %.1f\nmove_%zu_of_%zu_first_ms %.1f\nmove_%zu_of_%zu_found %.1f\n", moving, count,
              once, moving, count, arranged, moving, count, found);
}

void guards(const char* what, const DeviceProfile& device) {
  Guards guard(device);
  guard.allow(0.1, 0.5);
  std::mt19937 random(1995);
  std::uniform_real_distribution<float> force(-4, 4);
  std::vector<Force> forces(1024);
  for (Force& each : forces) each = {force(random), force(random)};
  volatile float sink = 0;
  std::printf("%s %.1f\n", what, timed(101, 1024, [&] {
                Force last(0);
                double x = 0;
                for (const Force& each : forces) {
                  last = guard(each + last * 1e-9f, {x = 1e-4 - x, 0}, 1);
                  guard.commanded(last);
                }
                sink = last.x;
              }));
}

void loading() {
  // Programs of about a hundred instructions in all, states, grids, tables, marks and percepts among them.
  std::vector<std::vector<std::byte>> files;
  double instructions = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    const PatchProgram program = example::RandomProgram(seed).make();
    instructions += static_cast<double>(program.setup.size() + program.enter.size() + program.tick.size());
    instructions += static_cast<double>(program.picture.code.size() + program.picture.frame.size());
    for (const Peak& peak : program.peaks) instructions += static_cast<double>(peak.code.size());
    files.push_back(write_patch_program(program));
  }
  std::vector<Program> programs;
  const double all = timed(11, 1e6, [&] {
    programs.clear();
    for (const auto& file : files) {
      auto loaded = Program::load(file);
      if (loaded) programs.push_back(*std::move(loaded));
    }
  });
  std::printf("load_1000_ms %.1f\nload_instructions %.0f\n", all, instructions / 1000);
}

/// One look-up into a sampled map of `side` samples a side, the next place waiting for what was found at the last.
void look_up(std::uint32_t side) {
  HeightTable table{side, side, SharedHeights::Codes(std::size_t{side} * side)};
  std::mt19937 random(1995);
  std::uint16_t* code = &table.heights[0];
  for (std::size_t i = 0; i < table.heights.size(); ++i)
    code[i] = static_cast<std::uint16_t>(32767 + 20000 * std::sin(1e-2 * static_cast<double>(i % side)));
  double made = worked();
  const Spline spline(table);
  made = (worked() - made) * 1e-6;
  std::uniform_real_distribution<float> place(0, static_cast<float>(side - 1));
  std::vector<glm::vec2> anywhere(4096), moving(4096);
  for (glm::vec2& point : anywhere) point = {place(random), place(random)};
  for (std::size_t i = 0; i < moving.size(); ++i)
    moving[i] = glm::vec2(0.37f, 0.21f) * static_cast<float>(i) * static_cast<float>(side) / 4096.0f;
  volatile float sink = 0;
  const auto walk = [&](const std::vector<glm::vec2>& points) {
    float last = 0;
    for (const glm::vec2& point : points) last = sample_of(spline, point.x + last * 1e-30f, point.y).along_a;
    sink = last;
  };
  const double slow = timed(21, 4096, [&] { walk(moving); }), fast = timed(21, 4096, [&] { walk(anywhere); });
  std::printf("map_%u_moving %.1f\nmap_%u_random %.1f\nmap_%u_prefilter_ms %.1f\n", side, slow, side, fast, side, made);
}

}  // namespace
}  // namespace wale::benchmarks

int main(int count, char**) {
  using namespace wale::benchmarks;
  wale::DeviceProfile device = wale::sandpaper();
  guards("guards", device);
  device.delay_x = device.delay_y = 0.0015;
  device.damping_known = true;
  device.continuous_newton = 5;
  device.heating_seconds = 20;
  guards("guards_late", device);
  if (count > 1) return 0;
  front_most(10);
  front_most(1000);
  front_most(100'000);
  front_most(100'000, true);
  move(10, 1);
  move(100'000, 1);
  move(100'000, 100);
  loading();
  look_up(1024);
  look_up(4096);
}
