#include "wale/recording.h"

#include <cstdint>

#include "runtime/c/program.hpp"
#include "runtime/c/run.hpp"
#include "runtime/c/sized.hpp"
#include "wale/recording.hpp"

struct WaleRecording {
  wale::Recording recording;
};

using namespace wale::c;

WaleCode wale_recording_open(WaleText path, WaleRecording** recording, WaleError** error) {
  return wale_recording_open_part(path, SIZE_MAX, recording, error);
}

WaleCode wale_recording_open_part(WaleText path, size_t most_ticks, WaleRecording** recording, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto clear = clear_result("recording", recording); !clear) return clear;
    const auto file = read_path("path", path);
    if (!file) return file.error();
    auto opened = wale::Recording::open(*file, most_ticks);
    if (!opened) return std::move(opened).error();
    hand_out(std::make_unique<WaleRecording>(WaleRecording{*std::move(opened)}), recording);
    return {};
  });
}

WaleCode wale_recording_intact(WaleText path, uint64_t* ticks, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("ticks", ticks); !given) return given;
    *ticks = 0;
    const auto file = read_path("path", path);
    if (!file) return file.error();
    const auto intact = wale::Recording::intact(*file);
    if (!intact) return intact.error();
    *ticks = *intact;
    return {};
  });
}

void wale_recording_free(WaleRecording* recording) { free_handle(recording); }

WaleCode wale_recording_details(const WaleRecording* recording, WaleRecordingDetails* details, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("recording", recording); !given) return given;
    if (auto sized = is_sized("details", details); !sized) return sized;
    const wale::RecordingHeader& header = recording->recording.header();
    write_sized(details, {.ticks = recording->recording.ticks(),
                          .rate = header.device.rate,
                          .position_step = header.device.position_step(),
                          .max_force = header.most_newton,
                          .device = text_of(header.device.name),
                          .hand = text_of(header.hand),
                          .complete = recording->recording.complete(),
                          .virtual_time = header.virtual_time});
    return {};
  });
}

WaleCode wale_recording_ticks(const WaleRecording* recording, size_t first, size_t count, size_t each,
                              WaleRecordedTick* ticks, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("recording", recording); !given) return given;
    if (auto there = are_there(first, count, recording->recording.ticks()); !there) return there;
    return write_elements(count, each, ticks, [&](std::size_t i) {
      const wale::RecordedTick tick = recording->recording.tick(first + i);
      return WaleRecordedTick{.period = tick.period,
                              .lateness = tick.lateness,
                              .counts_x = tick.counts.x,
                              .counts_y = tick.counts.y,
                              .velocity = vector_of(tick.velocity),
                              .wanted = vector_of(tick.wanted),
                              .commanded = vector_of(tick.commanded),
                              .force = vector_of(tick.force),
                              .interaction = vector_of(tick.interaction),
                              .skipped = tick.skipped,
                              .patch = tick.patch,
                              .revision = tick.revision,
                              .guards = tick.guards,
                              .contact = static_cast<int32_t>(tick.contact),
                              .button = tick.button,
                              .inside = tick.inside};
    });
  });
}

WaleCode wale_recording_replay(const WaleRecording* recording, WaleReplay* replay, WaleError** error) {
  return call(error, [&]() -> wale::Result<> {
    if (auto given = is_given("recording", recording); !given) return given;
    if (auto sized = is_sized("replay", replay); !sized) return sized;
    const auto done = wale::replay(recording->recording);
    if (!done) return done.error();
    write_sized(replay, {.ticks = done->ticks, .differing = done->differing, .largest_force = done->largest_force});
    return {};
  });
}
