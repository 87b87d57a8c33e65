// Runs one material on the machine and beside it as C++ (yardstick.hpp), and prints how they compare:
//
//   bench_machine ticks PROGRAM.wpp YARDSTICK.so    dependent ticks, hot and paced; a batch; one line each
//   bench_machine foreign PROGRAM.wpp YARDSTICK.so  ticks beside a yardstick that may round otherwise
//   bench_machine count PROGRAM.wpp TICKS [YARDSTICK.so]
//                                                   only ticks, the machine's or the yardstick's, for a counter of
//                                                   instructions; prints how many of bytecode a tick has
//
// A line is: what, yardstick in ns, machine in ns, ratio.

#include <dlfcn.h>
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "tests/benchmarks/measure.hpp"
#include "tests/benchmarks/yardstick.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale::benchmarks {
namespace {

[[noreturn]] void give_up(const std::string& reason) {
  std::fprintf(stderr, "bench_machine: %s\n", reason.c_str());
  std::exit(1);
}

Program load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto loaded = Program::load(std::as_bytes(std::span(text)));
  if (!loaded) give_up(path + ": " + in_words(loaded.error()));
  return *std::move(loaded);
}

/// What yardstick.hpp declares, from a shared object.
struct Yardstick {
  decltype(&yardstick_begin) begin;
  decltype(&yardstick_state_size) state_size;
  decltype(&yardstick_enter) enter;
  decltype(&yardstick_tick) tick;
  decltype(&yardstick_batch) batch;

  explicit Yardstick(const std::string& path) {
    void* object = dlopen(path.c_str(), RTLD_NOW);
    if (object == nullptr) give_up(dlerror());
    const auto find = [object](const char* name) {
      void* symbol = dlsym(object, name);
      if (symbol == nullptr) give_up(dlerror());
      return symbol;
    };
    begin = reinterpret_cast<decltype(begin)>(find("yardstick_begin"));
    state_size = reinterpret_cast<decltype(state_size)>(find("yardstick_state_size"));
    enter = reinterpret_cast<decltype(enter)>(find("yardstick_enter"));
    tick = reinterpret_cast<decltype(tick)>(find("yardstick_tick"));
    batch = reinterpret_cast<decltype(batch)>(find("yardstick_batch"));
  }
};

/// Hands on a slow walk over the patch, as a person explores it.
std::vector<Hand> walk(std::size_t count) {
  std::vector<Hand> hands(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / 900;
    hands[i].position = {0.05 * std::sin(2.3 * t), 0.05 * std::sin(1.7 * t + 1)};
    hands[i].velocity = {0.115 * std::cos(2.3 * t), 0.085 * std::cos(1.7 * t + 1)};
    hands[i].workspace = hands[i].position;
    hands[i].time = t;
  }
  return hands;
}

/// Hands anywhere on the patch.
std::vector<Hand> anywhere(std::size_t count) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<float> place(-0.055f, 0.055f), speed(-0.3f, 0.3f);
  std::vector<Hand> hands(count);
  for (Hand& hand : hands) {
    hand.position = {place(random), place(random)};
    hand.velocity = {speed(random), speed(random)};
    hand.workspace = hand.position;
  }
  return hands;
}

/// Makes the next tick wait for the last one's force, as the loop through a hand does.
Hand after(Hand hand, Force force) {
  hand.position += force * 1e-9f;
  hand.velocity += force * 1e-9f;
  return hand;
}

void report(const char* what, const Comparison& found) {
  std::printf("%s %.2f %.2f %.3f\n", what, found.yardstick, found.measured, found.ratio);
}

class Bench {
 public:
  Bench(const std::string& program, const std::string& yardstick)
      : program_(load(program)), bank_(program_), memory_(program_), yardstick_(yardstick), hands_(walk(2048)) {
    lookups_ = program_.decoded().lookups(memory_.cells().data());
    yardstick_.begin();
    state_.resize(yardstick_.state_size() + 1);  // never empty
  }

  /// A yardstick that computes something else measures nothing.
  void same_forces() {
    begin();
    for (const Hand& hand : hands_) {
      Force theirs;
      {
        const FloatingPointMode mode;
        yardstick_.tick(&hand, state_.data(), &theirs);
      }
      const Force ours = tick(bank_, memory_, hand);
      if (std::memcmp(&ours, &theirs, sizeof ours) != 0) give_up("the yardstick gives other forces");
    }
  }

  void dependent_ticks() {
    const auto count = static_cast<double>(hands_.size());
    report("tick", compare(
                       41, count, [this] { yardstick_ticks(); }, [this] { machine_ticks(); }));
  }
  void code_alone() {
    const auto count = static_cast<double>(hands_.size());
    report("code", compare(
                       41, count, [this] { yardstick_ticks(); }, [this] { code_ticks(); }));
  }

  /// Instances that remember, all over the patch, one thread.
  void batch() {
    const std::vector<Hand> hands = anywhere(2048);
    std::vector<Force> theirs(hands.size()), ours(hands.size());
    Batch batch(bank_, hands.size(), &memory_);
    batch.enter(hands);
    std::vector<float> rows(state_.size() * hands.size());
    for (std::size_t i = 0; i < hands.size(); ++i) {
      yardstick_.enter(&hands[i], state_.data());
      for (std::size_t k = 0; k < state_.size(); ++k) rows[k * hands.size() + i] = state_[k];
    }
    const auto yardstick = [&] {
      const FloatingPointMode mode;
      yardstick_.batch(hands.data(), rows.data(), theirs.data(), hands.size());
    };
    const auto machine = [&] { batch.tick(hands, ours); };
    yardstick();
    machine();
    if (std::memcmp(theirs.data(), ours.data(), ours.size() * sizeof(Force)) != 0)
      give_up("the yardstick gives other forces in a batch");
    report("batch", compare(81, static_cast<double>(hands.size()), yardstick, machine));
  }

  /// One tick a period, by turns: between two, caches and predictors belong to others.
  void paced_ticks() {
    std::vector<double> yardstick, machine;
    begin();
    timespec when{};
    clock_gettime(CLOCK_MONOTONIC, &when);
    for (std::size_t i = 0; i < 1800; ++i) {
      when.tv_nsec += 1'111'111;
      if (when.tv_nsec >= 1'000'000'000) when.tv_nsec -= 1'000'000'000, ++when.tv_sec;
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) != 0) {
      }
      const Hand& hand = hands_[i % hands_.size()];
      Force force;
      const double start = now();
      if (i % 2 == 0) {
        yardstick_.tick(&hand, state_.data(), &force);
      } else {
        force = tick(bank_, memory_, hand);
      }
      const double took = now() - start;
      sink_ = sink_ + force.x;
      (i % 2 == 0 ? yardstick : machine).push_back(took);
    }
    const double one = median(yardstick), other = median(machine);
    std::printf("paced %.0f %.0f %.3f\n", one, other, other / one);
  }

 private:
  void begin() {
    memory_.enter(bank_, hands_[0]);
    yardstick_.enter(&hands_[0], state_.data());
  }

  void yardstick_ticks() {
    begin();
    const FloatingPointMode mode;
    Force force(0);
    for (const Hand& hand : hands_) {
      const Hand next = after(hand, force);
      yardstick_.tick(&next, state_.data(), &force);
    }
    sink_ = sink_ + force.x;
  }
  void machine_ticks() {
    begin();
    Force force(0);
    for (const Hand& hand : hands_) force = tick(bank_, memory_, after(hand, force));
    sink_ = sink_ + force.x;
  }
  /// The interpreter alone: what `tick` does around it, the yardstick does not.
  void code_ticks() {
    begin();
    const FloatingPointMode mode;
    const DecodedProgram& program = program_.decoded();
    const PatchProgram& description = program.description;
    float* registers = bank_.registers().data();
    float* states = registers + description.first_state();
    const std::size_t count = description.states.size();
    std::vector<float> next(count);
    std::copy_n(memory_.states().data(), count, states);
    Force force(0);
    for (const Hand& hand : hands_) {
      program.hand_reader(after(hand, force), registers);
      run_threaded(program.lane_tick, lookups_, registers);
      for (std::size_t i = 0; i < count; ++i) next[i] = registers[description.states[i].next];
      std::copy_n(next.data(), count, states);
      force = {registers[program.force_x], registers[program.force_y]};
    }
    sink_ = sink_ + force.x;
  }

  Program program_;
  Bank bank_;
  Memory memory_;
  Yardstick yardstick_;
  std::vector<Hand> hands_;
  LaneLookups lookups_;
  std::vector<float> state_;  ///< the yardstick's
  volatile float sink_ = 0;
};

}  // namespace
}  // namespace wale::benchmarks

int main(int argc, char** argv) {
  using namespace wale::benchmarks;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "ticks" && argc == 4) {
    Bench bench(argv[2], argv[3]);
    bench.same_forces();
    bench.dependent_ticks();
    bench.code_alone();
    bench.batch();
    bench.paced_ticks();
  } else if (what == "foreign" && argc == 4) {
    Bench(argv[2], argv[3]).dependent_ticks();
  } else if (what == "count" && (argc == 4 || argc == 5)) {
    const wale::Program program = load(argv[2]);
    wale::Bank bank(program);
    wale::Memory memory(program);
    const auto hands = walk(2048);
    memory.enter(bank, hands[0]);
    float sum = 0;
    const long count = std::atol(argv[3]);
    if (argc == 5) {
      const Yardstick yardstick(argv[4]);
      yardstick.begin();
      std::vector<float> state(yardstick.state_size() + 1);
      yardstick.enter(&hands[0], state.data());
      wale::Force force;
      for (long i = 0; i < count; ++i) {
        yardstick.tick(&hands[static_cast<std::size_t>(i) % hands.size()], state.data(), &force);
        sum += force.x;
      }
    } else {
      for (long i = 0; i < count; ++i) sum += tick(bank, memory, hands[static_cast<std::size_t>(i) % hands.size()]).x;
    }
    std::printf("%zu\n", program.description().tick.size());
    return std::isnan(sum) ? 1 : 0;  // and so the ticks are needed
  } else {
    std::fputs("usage: bench_machine ticks|foreign PROGRAM.wpp YARDSTICK.so | count PROGRAM.wpp TICKS\n", stderr);
    return 2;
  }
}
