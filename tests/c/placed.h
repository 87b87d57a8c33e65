#ifndef PLACED_H
#define PLACED_H

/* What the tests of stages share. */

#include "tests/c/check.h"
#include "tests/c/parts.h"

/* A joystick in a hand that rubs to and fro over 20 mm, once a second. */
static inline WaleDevice* simulated(void) {
  WaleDevice* device = NULL;
  WaleDeviceOptions options = {.size = sizeof options,
                               .hand_mass = 0.5,
                               .hand_damping = 10,
                               .hand_stiffness = 500,
                               .motion = WALE_MOTION_lateral,
                               .amplitude = 0.02,
                               .frequency = 1};
  CHECK_GOOD(wale_device_open(WALE_TEXT("simulated:sandpaper"), &options, &device, &error));
  return device;
}

/* A stage with a simulated device. */
static inline WaleStage* new_stage(void) {
  WaleDevice* device = simulated();
  WaleStage* stage = NULL;
  CHECK_GOOD(wale_stage_create(device, NULL, &stage, &error));
  wale_device_free(device);
  return stage;
}

static inline WaleRun* run_for(WaleStage* stage, double seconds) {
  WaleRun* run = NULL;
  WaleRunOptions options = {.size = sizeof options, .seconds = seconds, .virtual_time = 1};
  CHECK_GOOD(wale_stage_run(stage, &options, &run, &error));
  return run;
}

typedef void (*Part)(void);

/* Runs the parts up to NULL; each leaves no handle. */
static inline void run_parts(const Part* parts) {
  for (int i = 0; parts[i] != NULL; ++i) {
    const size_t before = wale_handles();
    parts[i]();
    if (wale_handles() == before) continue;
    fprintf(stderr, "%s: part %d leaves %d handles\n", __FILE__, i, (int)(wale_handles() - before));
    ++failures;
  }
}

#endif
