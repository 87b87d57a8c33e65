#ifndef WALE_LOOP_H
#define WALE_LOOP_H

#include "wale/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A run of a stage whose ticks the program serves itself, on a thread of its own and by its own clock. All guards are in it. It
   may outlive its stage: from then on its force is 0. */
typedef struct WaleLoop WaleLoop;

enum { WALE_READING_good = 0, WALE_READING_stale = 1, WALE_READING_lost = 2 };

/* A device's report, once a tick. */
typedef struct WaleReading {
  size_t size;
  int32_t counts_x, counts_y;        /* encoder counts from the workspace's centre */
  int32_t button;                    /* 1: pressed */
  int32_t contact;                   /* WALE_READING_…: unless it is good, the force is 0 */
  int32_t measures_interaction;      /* 1: the device measures the force of the hand on the handle */
  float interaction_x, interaction_y; /* N, that force, averaged over the period that just ended */
  int32_t reserved;                  /* 0 */
} WaleReading;

/* Begins a run of the stage; its own device, if it has one, is not used. Errors as for wale_stage_start. */
WALE_API WaleCode wale_loop_begin(WaleStage* stage, WaleLoop** loop, WaleError** error);
/* Serves one tick: gives the force (N; of a pad its amplitude and frequency) to command for this reading. `periods` have passed
   since the last step: 1 unless some were missed; less counts as 1, more than 2^31 - 1 as so many. It looks at no clock: count.
   Where they say that more than 20 ms were missed, the force is 0 once and slews back. Counts beyond 2^29 either way are a lost
   reading, and an interaction that is not finite was not measured. One thread at a time. A loop or a reading of NULL, or one of
   a wrong size, gives no force, and so does a `contact` that is unknown, and a reading that sets fields which are newer than
   this library (elsewhere newer_file).
   Real-time: allocates nothing, takes no lock, makes no system call. */
WALE_API WaleVector wale_loop_step(WaleLoop* loop, const WaleReading* reading, int64_t periods);
/* The force that the actuator really exerts since the last step, where the device tells it, also for wale_stage_now and the
   recording; one that is not finite is passed over. Real-time as above. */
WALE_API void wale_loop_exerted(WaleLoop* loop, WaleVector force);
/* Ends the run. */
WALE_API void wale_loop_free(WaleLoop* loop);

#ifdef __cplusplus
}
#endif

#endif
