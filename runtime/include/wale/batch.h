#ifndef WALE_BATCH_H
#define WALE_BATCH_H

#include "wale/program.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A parameter's value, SI. Its layout never changes. */
typedef struct WaleSetting {
  WaleText name;
  double value;
} WaleSetting;

/* Many independent hands, each moved through `ticks` ticks. All arrays are row by row: one row for each hand, in it one entry
   for each tick. Those that may be NULL are computed. Positions and motions are from the patch's centre, in m, m/s, m/s^2. */
typedef struct WaleBatchOptions {
  size_t size;
  size_t hands, ticks;
  const WaleVector* position;
  const WaleVector* velocity;         /* NULL: differences of positions, times the device's rate; 0 at the first tick */
  const WaleVector* acceleration;     /* NULL: differences of velocities, times the rate; 0 at the first tick */
  const WaleVector* raw_velocity;     /* NULL: differences of positions */
  const WaleVector* raw_acceleration; /* NULL: differences of raw velocities */
  const WaleVector* workspace;        /* from the workspace's centre; NULL: as `position` */
  const double* time;                 /* s, for each tick, the same for all hands; NULL: the tick's number times the period */
  const uint8_t* button;              /* 1: pressed; NULL: never */
  const WaleSetting* settings;        /* of parameters, clamped to their ranges; others have their defaults */
  size_t setting_count;
  float width, height, rim;           /* m, of the patch, cut to the workspace; both sides 0: the program's own */
  float reserved;                     /* 0 */
} WaleBatchOptions;

/* Runs the program on all hands, on all cores, and writes a force (N; of a pad amplitude and frequency) for each hand and tick.
   Each hand has its own states, which it keeps from tick to tick, and enters where it is at its first tick; nothing writes
   grids. The forces are those of a patch before the guards, to the bit, and do not depend on the number of cores. Beyond the
   patch's edge they are 0, and the states go on: a hand that comes back does not enter anew.
   Errors: unknown_name for a setting; malformed_value for NULL, a size that makes no sense, or a setting, a place, a
   motion or a time that is not finite. */
WALE_API WaleCode wale_batch(const WaleProgram* program, const WaleBatchOptions* options, WaleVector* forces,
                             WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
