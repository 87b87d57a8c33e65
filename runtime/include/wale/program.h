#ifndef WALE_PROGRAM_H
#define WALE_PROGRAM_H

#include "wale/device.h"
#include "wale/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A verified patch program, ready to run, with the warnings about its text if it was compiled from one. It never changes; any
   number of threads may use it at once. Stages, batches and snapshots keep what they need of it: it may be freed at any
   time. */
typedef struct WaleProgram WaleProgram;

/* All texts belong to the program. */
typedef struct WaleProgramDetails {
  size_t size;
  WaleText material;         /* its name, "corduroy" */
  WaleText device;           /* the name of the profile that it is built for */
  WaleText taken;            /* if the name could have meant another material too: which one was taken; mostly empty */
  double width, height, rim; /* m, of a patch whose size nobody gives */
  double rate;               /* Hz, ticks per second of its device */
  int32_t vibrates;          /* 1: it shakes a pad instead of pushing */
  int32_t has_colour;        /* 1: its author declares colours of the surface */
  size_t parameters, percepts, states, grids, warnings; /* how many it has */
  size_t fates;              /* and of these */
} WaleProgramDetails;

/* A quantity that can be changed while the program runs. Values are in SI units; shown = value / unit_in_si. */
typedef struct WaleParameter {
  size_t size;
  WaleText name;
  WaleText description;
  WaleText unit;     /* as the author wrote it, "mm"; empty for a plain number */
  WaleText si_unit;  /* "m" */
  double unit_in_si;
  double value;                /* the default */
  double low, high;            /* the range: low <= value <= high */
  double soft_low, soft_high;  /* the usual range, for a slider */
} WaleParameter;

/* A percept of the program. */
typedef struct WalePercept {
  size_t size;
  WaleText name;     /* "roughness" */
  WaleText carrier;  /* "lateral amplitude" */
  WaleText unit;     /* of the carrier's size, SI: "N" */
  WaleText map;      /* the map that gives its level */
  WaleText source;   /* its citation */
  int64_t parameter;  /* the number of the parameter that is its level; -1 if there is none */
  double amplitude;   /* the carrier's size that the program aims at with its default parameters, in `unit` */
  double level;       /* the level that this size is felt as, by the map; 1 is the percept's reference stimulus */
  double valid_low, valid_high; /* the sizes for which the map was measured */
} WalePercept;

/* How well the device renders what the text asks for: as it was meant; by a substitute, or with a figure from another handle;
   weaker than asked for, because the device gives no more, so that the program itself cuts its force; not at all. */
enum { WALE_FATE_kept = 1, WALE_FATE_approximated = 2, WALE_FATE_saturated = 3, WALE_FATE_lost = 4 };

/* What becomes of a percept that the text asks for, or of a part of its physics. */
typedef struct WaleFate {
  size_t size;
  WaleText name;        /* "roughness"; of physics "lateral amplitude" */
  int32_t is_percept;   /* 0: physics */
  int32_t fate;         /* one of WALE_FATE_… */
  double asked, given;  /* levels of a percept; `given` is 0 if it is lost; both are 0 for physics */
  WaleText reason;      /* how it is rendered, or why not; may be empty */
} WaleFate;

/* Reads and verifies the bytes of a .wpp file; they are read during the call only.
   Errors: damaged_file, newer_file, refused_program; malformed_value for NULL. */
WALE_API WaleCode wale_program_load(const void* bytes, size_t length, WaleProgram** program, WaleError** error);

WALE_API void wale_program_free(WaleProgram* program);

/* The bytes of its .wpp file: gives their number, and writes them if `capacity` is enough, otherwise nothing. Equal programs
   give equal bytes on every machine. `to` may be NULL with capacity 0. */
WALE_API WaleCode wale_program_bytes(const WaleProgram* program, void* to, size_t capacity, size_t* length,
                                     WaleError** error);

/* Errors: malformed_value for NULL, a wrong size, or an index that is too large. */
WALE_API WaleCode wale_program_details(const WaleProgram* program, WaleProgramDetails* details, WaleError** error);
WALE_API WaleCode wale_program_parameter(const WaleProgram* program, size_t index, WaleParameter* parameter,
                                         WaleError** error);
WALE_API WaleCode wale_program_percept(const WaleProgram* program, size_t index, WalePercept* percept, WaleError** error);
/* Of the percepts in the order asked for, then of the physics. */
WALE_API WaleCode wale_program_fate(const WaleProgram* program, size_t index, WaleFate* fate, WaleError** error);

/* The figures of the device that it is built for, also of one that only its text declares: for wale_stage_create_for. The text
   belongs to the program. Errors: malformed_value for NULL or a wrong size. */
WALE_API WaleCode wale_program_profile(const WaleProgram* program, WaleProfile* profile, WaleError** error);

/* A warning about its text, in the order of their places; it belongs to the program. NULL beyond the last. */
WALE_API const WaleError* wale_program_warning(const WaleProgram* program, size_t index);

#ifdef __cplusplus
}
#endif

#endif
