#include "wale/loop.h"

#include <optional>

#include "runtime/c/run.hpp"
#include "runtime/c/sized.hpp"
#include "runtime/c/stage.hpp"
#include "wale/loop.hpp"

struct WaleLoop {
  std::optional<wale::Loop> loop = {};
};

using namespace wale::c;

WaleCode wale_loop_begin(WaleStage* stage, WaleLoop** loop, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("loop", loop); !clear) return clear;
    if (auto given = is_stage(stage); !given) return given;
    HandleToBe<WaleLoop> handle(loop);
    auto begun = wale::Loop::begin(stage->stage);
    if (!begun) return std::move(begun).error();
    handle->loop.emplace(*std::move(begun));
    handle.give();
    return {};
  });
}

WaleVector wale_loop_step(WaleLoop* loop, const WaleReading* reading, int64_t periods) {
  if (loop == nullptr) return {};
  wale::Reading read{.contact = wale::Contact::stale};
  if (has_size(reading) && is_known(*reading)) {
    WaleReading given{};
    std::memcpy(&given, reading, std::min(reading->size, sizeof given));
    read.counts = {given.counts_x, given.counts_y};
    read.button = given.button != 0;
    if (given.measures_interaction != 0) read.interaction = {given.interaction_x, given.interaction_y};
    read.contact = given.contact == WALE_READING_good    ? wale::Contact::good
                   : given.contact == WALE_READING_stale ? wale::Contact::stale
                                                         : wale::Contact::lost;
  }
  return vector_of(loop->loop->step(read, periods));
}

void wale_loop_exerted(WaleLoop* loop, WaleVector force) {
  if (loop != nullptr) loop->loop->exerted({force.x, force.y});
}

void wale_loop_free(WaleLoop* loop) { free_handle(loop); }
