#ifndef WALE_RECORDING_H
#define WALE_RECORDING_H

#include "wale/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A file that a run made (WaleStageOptions.record), complete or up to the moment when its process was killed. It never changes;
   any number of threads may use it at once. */
typedef struct WaleRecording WaleRecording;

/* The text belongs to the recording. */
typedef struct WaleRecordingDetails {
  size_t size;
  uint64_t ticks;
  double rate;          /* Hz */
  double position_step; /* m per encoder count */
  double max_force;     /* N, the largest force that the user allowed; infinite without a limit */
  WaleText device;      /* the name of its profile */
  WaleText hand;        /* what moved the handle; empty if that is not known */
  int32_t complete;     /* 1: the run came to its end */
  int32_t virtual_time; /* 1: the run was in virtual time */
} WaleRecordingDetails;

typedef struct WaleRecordedTick {
  int64_t period;         /* its number since the run began, from 0 */
  int64_t lateness;       /* ns after its deadline */
  int32_t counts_x, counts_y; /* encoder, from the workspace's centre */
  WaleVector velocity;    /* m/s, filtered */
  WaleVector wanted;      /* the program's force */
  WaleVector commanded;   /* after the guards */
  WaleVector force;       /* exerted by the actuator */
  WaleVector interaction; /* N, from hand to handle over the period before; not-a-number where unknown */
  uint32_t skipped;       /* periods just before that nobody served */
  uint32_t patch;         /* its number; 0xffffffff: none */
  uint32_t revision;      /* how often the patches on the stage had been handed over to the loop */
  uint32_t guards;        /* bits, in the order: not a number, device limit, user limit, energy, passivity, slew, overrun, stale,
                             lost, restored, heat */
  int32_t contact;        /* 0 good, 1 stale, 2 lost */
  int32_t button;         /* 1: pressed */
  int32_t inside;         /* 1: the hand was within a patch */
  int32_t reserved;       /* 0 */
} WaleRecordedTick;

typedef struct WaleReplay {
  size_t size;
  uint64_t ticks;       /* replayed */
  uint64_t differing;   /* ticks that are not bit for bit as recorded */
  double largest_force; /* the largest difference of the commanded force, N or m/s^2 */
} WaleReplay;

/* Reads the file and checks it; what happens to it later does not matter. Errors: unreadable_file, newer_file, damaged_file. */
WALE_API WaleCode wale_recording_open(WaleText path, WaleRecording** recording, WaleError** error);
/* The same of its first `most_ticks` ticks, or fewer if it has fewer: the part before a damage or a cut, which
   wale_recording_intact counts. `complete` is 0 if ticks are left out. */
WALE_API WaleCode wale_recording_open_part(WaleText path, size_t most_ticks, WaleRecording** recording, WaleError** error);
/* How many ticks of a file can be opened: all of a whole one, and of one that is damaged or cut short those before that place, for
   `most_ticks` above. The first 320 KiB hold the conditions and the first events: of a file cut there nothing is left.
   Errors: unreadable_file, newer_file; damaged_file for a file that is no recording. */
WALE_API WaleCode wale_recording_intact(WaleText path, uint64_t* ticks, WaleError** error);
WALE_API void wale_recording_free(WaleRecording* recording);
WALE_API WaleCode wale_recording_details(const WaleRecording* recording, WaleRecordingDetails* details, WaleError** error);
/* Copies `count` ticks from number `first` on; `each` is sizeof(WaleRecordedTick), as for wale_run_ticks. */
WALE_API WaleCode wale_recording_ticks(const WaleRecording* recording, size_t first, size_t count, size_t each,
                                       WaleRecordedTick* ticks, WaleError** error);
/* Runs the recorded programs on the recorded counts again and compares bit for bit. Takes a while. Errors: those of the recorded
   programs and changes. */
WALE_API WaleCode wale_recording_replay(const WaleRecording* recording, WaleReplay* replay, WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
