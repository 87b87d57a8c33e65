#ifndef WALE_RUN_H
#define WALE_RUN_H

#include "wale/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The figures of a run that is over, and its record. It never changes. */
typedef struct WaleRun WaleRun;

/* What came to the handle of a patch, as the bandwidth of the device's actuators lets it through, and the levels as which that is
   felt. It never changes. */
typedef struct WaleFelt WaleFelt;

/* On how many ticks each guard changed the force. What Wale compiles keeps to its device by itself: it cuts its force to the
   peak, which wale_program_fate tells, and gives none where that is not a number. So the first two count for other programs.
   Its layout never changes. */
typedef struct WaleGuards {
  int64_t not_a_number; /* zero, because the program's force was not a number */
  int64_t device_limit; /* clamped to the device's peak force on an axis */
  int64_t user_limit;   /* clamped to the user's limit */
  int64_t heat;         /* reduced, because a motor was already hot */
  int64_t energy;       /* reduced, because the program gave more energy than it declares or than the device allows */
  int64_t passivity;    /* damped, because the sampled loop gained energy */
  int64_t slew;         /* slowed after a start, an entry, a leaving or a change of bank */
  int64_t overrun;      /* no force, because no tick had run for more than 20 ms */
  int64_t stale;        /* no force, because the position was an old one */
  int64_t lost;         /* no force, because the device was gone */
  int64_t restored;     /* times that a state was not a number and got its initial value again */
} WaleGuards;

typedef struct WaleRunOptions {
  size_t size;
  double seconds;       /* how long; positive, may be fractional or infinite */
  double kept_seconds;  /* how much of the run's end the record keeps, 2^24 ticks at most (4.6 hours at 1000 Hz); 0: all,
                           so that a run without it is no longer than that */
  int32_t virtual_time; /* 1: as fast as possible on the calling thread; a run of the same stage on a newly
                           opened device gives the same bits; a second one goes on with the person where the first ended */
  int32_t reserved;     /* 0 */
} WaleRunOptions;

typedef struct WaleNow {
  size_t size;
  double time;           /* s since the run began */
  double lateness;       /* s, how long after its deadline the tick began */
  int64_t ticks_run, ticks_missed;
  int64_t revision;      /* how often changes had been handed over to the loop */
  uint64_t patch;        /* the one that the hand is on (wale_patch_id); 0: none */
  WaleVector position;   /* of the hand, m from the workspace's centre */
  WaleVector velocity;   /* m/s */
  WaleVector force;      /* the actuator's at that tick, also after the run, when the device exerts none; 0 after one that failed */
  int32_t inside;        /* 1: the hand is on a patch */
  int32_t reserved;      /* 0 */
  WaleGuards guards;     /* since the run began */
} WaleNow;

enum { WALE_CONTACT_enter = 0, WALE_CONTACT_leave = 1, WALE_CONTACT_press = 2, WALE_CONTACT_release = 3 };

/* A moment at which a hand and a patch begin or end to touch, or the device's button changes on a patch. */
typedef struct WaleContact {
  size_t size;
  uint64_t patch;       /* wale_patch_id */
  double time;          /* s since the run began */
  WaleVector position;  /* of the hand, m from the workspace's centre */
  WaleVector velocity;  /* m/s */
  WaleVector force;     /* the actuator's from this tick on */
  int32_t kind;         /* WALE_CONTACT_… */
  int32_t reserved;     /* 0 */
} WaleContact;

/* Of a run that is over. The text belongs to the run. */
typedef struct WaleRunFigures {
  size_t size;
  int64_t ticks_run, ticks_missed;
  double lateness_p50, lateness_p99, lateness_maximum; /* s */
  double cost_p50, cost_p99, cost_maximum;             /* s, of a tick; 0 in virtual time */
  double seconds_per_tick;
  uint64_t recorded;         /* how many ticks the record has */
  const WaleError* problem;  /* why the recording ended before the run; NULL if it did not. It belongs to the run */
  WaleText scheduling;       /* what the loop asked of the system, and what it got */
  WaleGuards guards;
} WaleRunFigures;

/* One tick. */
typedef struct WaleTick {
  double time;            /* s since the run began */
  WaleVector position;    /* m from the workspace's centre, by the encoder */
  WaleVector velocity;    /* m/s, filtered */
  WaleVector force;       /* told to the device from this tick on, in its steps: without its delay and bandwidth */
  WaleVector interaction; /* N from hand to handle over the period before; not-a-number where unknown */
  float lateness;         /* s */
  uint32_t skipped;       /* periods that were not served just before this tick */
  int32_t inside;         /* 1: the hand was within the patch */
  int32_t reserved;       /* 0 */
  uint64_t patch;         /* wale_patch_id of the one that the hand was on; 0: none */
  uint64_t change;        /* another number after each change of that patch's program, parameters or size */
} WaleTick;

WALE_API void wale_run_free(WaleRun* run);
WALE_API WaleCode wale_run_figures(const WaleRun* run, WaleRunFigures* figures, WaleError** error);
/* Copies `count` ticks of the record from number `first` on. `each` is sizeof(WaleTick): the distance of two ticks in `ticks`,
   and how much of each is written. Error: malformed_value for ticks that are not there, or a wrong size. */
WALE_API WaleCode wale_run_ticks(const WaleRun* run, size_t first, size_t count, size_t each, WaleTick* ticks,
                                 WaleError** error);

struct WalePatch;

/* All 0 is the default. */
typedef struct WaleMeasureOptions {
  size_t size;
  double settling;       /* s, left out at the beginning: forces slew in and the hand comes up to speed */
  double stuck_seconds;  /* the hand counts as stuck if within this time it moves by no more than `stuck_counts`; 0: 0.05 */
  double stuck_counts;   /* encoder counts on each axis; 0: 2 */
  int64_t least_crossings; /* of a texture, for a level, not negative; 0: 50 */
} WaleMeasureOptions;

/* N (of a pad m/s^2, where the hand was on the patch); not-a-number where it was not measured. */
typedef struct WaleFeltFigures {
  size_t size;
  int64_t ticks;         /* measured: on the patch, after settling */
  int64_t ticks_rubbing; /* of them, those with the hand not stuck; of a pad all */
  int64_t crossings;     /* flanks of a texture that the hand crossed */
  double stuck;          /* share of the ticks within the patch */
  double force_p99, force_maximum, force_rms;                   /* of the commands, in the device's steps */
  double rubbing_p99, rubbing_maximum, rubbing_rms;             /* the same while rubbing */
  double interaction_p99, interaction_maximum, interaction_rms; /* between hand and handle while rubbing */
  double drag;           /* N: what the force would be by this law alone, against the motion */
  double viscosity;      /* N s/m */
  double stiffness;      /* N/m */
  double wall_stiffness; /* N/m */
  double wall_damping;   /* N s/m */
  double mass;           /* kg */
  double shaking;        /* N */
  uint64_t levels;       /* how many percepts: wale_felt_level */
} WaleFeltFigures;

/* A percept as what was measured is felt. Text and error belong to the WaleFelt. */
typedef struct WaleFeltLevel {
  size_t size;
  WaleText name;             /* "roughness" */
  double predicted;          /* the carrier's size that the program aims at, SI */
  double measured;           /* the carrier's size; 0 if it was not measured */
  double level;              /* 1 is the percept's reference stimulus; not-a-number if there is none */
  const WaleError* problem;  /* why there is none: not_measured; NULL if there is one */
} WaleFeltLevel;

/* Measures what the hand felt of a patch in a run of its stage, and reads the percepts of its program back through its maps.
   Only the ticks on this patch count, and if its program, parameters or size changed during the run, only those after the last
   change. `options` may be NULL. Errors: malformed_value; wrong_moment if the patch is gone, is on another stage than the run
   was, or has other parameters, another size or program since the run; not_measured if the hand was not on the patch after
   `settling`, or the run kept no record, as that of wale_stage_start. */
WALE_API WaleCode wale_felt_measure(const WaleRun* run, const struct WalePatch* patch, const WaleMeasureOptions* options,
                                    WaleFelt** felt, WaleError** error);
WALE_API void wale_felt_free(WaleFelt* felt);
WALE_API WaleCode wale_felt_figures(const WaleFelt* felt, WaleFeltFigures* figures, WaleError** error);
WALE_API WaleCode wale_felt_level(const WaleFelt* felt, size_t index, WaleFeltLevel* level, WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
