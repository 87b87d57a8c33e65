// grating.dsp as Faust translates it, in the shape of a yardstick; compiled with -DFAUST_TEXT='"grating.dsp.cpp"'.

#include "tests/benchmarks/yardstick.hpp"

// The base classes of the translation, with only the functions that it calls.
struct Meta {
  void declare(const char*, const char*) {}
};
struct UI {
  void openVerticalBox(const char*) {}
  void closeBox() {}
  void addHorizontalSlider(const char*, float*, float, float, float, float) {}
};
class dsp {
 public:
  virtual ~dsp() = default;
  virtual dsp* clone() = 0;
  virtual void compute(int count, float** inputs, float** outputs) = 0;
};

#include FAUST_TEXT

static Grating grating;

void yardstick_begin() { grating.init(900); }

std::size_t yardstick_state_size() { return 0; }

void yardstick_enter(const wale::Hand*, float*) {}

void yardstick_tick(const wale::Hand* hand, float* state, wale::Force* force) {
  yardstick_batch(hand, state, force, 1);
}

void yardstick_batch(const wale::Hand* hands, float*, wale::Force* forces, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    float x = hands[i].position.x, velocity_x = hands[i].velocity.x, velocity_y = hands[i].velocity.y;
    float* inputs[] = {&x, &velocity_x, &velocity_y};
    float* outputs[] = {&forces[i].x, &forces[i].y};
    grating.compute(1, inputs, outputs);
  }
}
