#ifndef WALE_DEVICE_H
#define WALE_DEVICE_H

#include "wale/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An opened joystick or pad. A stage that has it keeps it: the handle may be freed at any time. A real device exerts no force
   until a stage runs on it, and lets go when both the handle and its stage are freed. */
typedef struct WaleDevice WaleDevice;

/* What is plugged in and what can be simulated, as it was when the list was made. */
typedef struct WaleDevices WaleDevices;

/* The figures of a device; 0: not declared. Of a pad, which has no force, `force` is 0. */
typedef struct WaleProfile {
  size_t size;
  WaleText name;
  double workspace_diameter;           /* m */
  double position_counts;              /* encoder counts over the workspace's diameter, per axis */
  double force;                        /* N, peak per axis */
  double force_counts;                 /* command steps from zero to peak force */
  double rate;                         /* Hz, control ticks per second, 100 .. 10000 */
  double speed_limit;                  /* m/s */
  double slew;                         /* N/s: how fast the output may move after an entry or a change; above 0 for a device
                                          that pushes (otherwise a run or a loop gives unusable_device), 0 on a pad: no limit */
  double continuous_force;             /* N per axis, that its motor bears for ever */
  double heating_seconds;              /* s, the time constant of its heating */
  double active_power;                 /* W, the most that a program may give to the hand by itself */
  double velocity_window;              /* ticks, at most 100; the longest window of the velocity filter */
  double velocity_noise_counts;        /* counts; the band that the velocity filter treats as noise */
  double patch_width, patch_height, patch_rim; /* m; the patch of a material that declares none */
  double mass;                         /* kg, moving mass at the handle; at 0 the guard against a loop that gains energy does
                                          not act */
  double damping;                      /* N s/m */
  double friction;                     /* N */
  double delay_x, delay_y;             /* s, at most 1, from a sample to the force that answers it, besides the hold of a period */
  double bandwidth_x, bandwidth_y;     /* Hz, at which the actuator has lost 3 dB; 0: no limit */
  int32_t vibrates;                    /* 1: a pad that shakes */
  int32_t has_position;                /* 0: a pad that does not know where the finger is */
} WaleProfile;

enum { WALE_DEVICE_real = 0, WALE_DEVICE_pointer = 1, WALE_DEVICE_simulated = 2 };

/* A device that wale_device_open can open, or why it cannot. Texts and error belong to the list. */
typedef struct WaleDeviceInfo {
  size_t size;
  WaleText spelling;          /* for wale_device_open: a port as "1-2", "pointer", "simulated:sandpaper" */
  WaleText name;              /* as it calls itself; of a simulated one its profile's */
  WaleText numbers;           /* vendor and product on USB, "1209:ffb0"; may be empty */
  WaleText profile;           /* the name of the declaration with its figures; empty: none is about it */
  WaleText can;               /* what a real one can do, in a line; may be empty */
  WaleText held_by;           /* other programs that have it open, with commas between them; mostly empty */
  const WaleError* obstacle;  /* why it cannot be used now; NULL if no reason is known */
  int32_t kind;               /* WALE_DEVICE_… */
  int32_t is_generic;         /* 1: the figures are assumed, since no declaration names it */
} WaleDeviceInfo;

enum {
  WALE_MOTION_rest = 0,     /* aims at `centre`; at 0, 0 it is no motion of its own: see `hand_mass` */
  WALE_MOTION_lateral = 1,  /* a sine of `amplitude` along `direction` about `centre` */
  WALE_MOTION_circular = 2, /* a circle of radius `amplitude` */
  WALE_MOTION_press = 3,    /* pushes of depth `amplitude` along `direction` that begin at `centre` */
  WALE_MOTION_trace = 4,    /* through `points`: `count` rows of time (s), x and y (m), times rising; between them a cubic */
  WALE_MOTION_hold = 5      /* aims at `centre`, also at 0, 0 */
};

/* How to open a device; all 0 is the default. `hand` and `motion` are those of the simulated person at a simulated device. */
typedef struct WaleDeviceOptions {
  size_t size;
  WaleText built_for;    /* only the device of this profile; empty: any */
  WaleText transport;    /* one of the ways to drive a real device, as "hidraw"; empty: its driver chooses */
  WaleText keeper;       /* the program wale-keeper; empty: it is found beside the executable or the library */
  double max_force;      /* N at the handle (of a pad m/s^2): what is sent to the device keeps within it, also to a simulated
                            one; 0: no other limit than its own */
  int32_t priority;      /* 1 .. 99: SCHED_FIFO for the threads that serve a real device, if it is permitted; 0: ordinary */
  int32_t disregard_owner; /* 1: with the runtime alone, do not refuse a real device whose owner declares devices */
  double hand_mass;      /* kg; with damping and stiffness 0 too nothing holds it, which is an error with a motion
                            (wale_library_open_device: then an ordinary hand, which rubs to and fro unless there is a
                            motion). Damping and stiffness pull to where the motion aims */
  double hand_damping;   /* N s/m */
  double hand_stiffness; /* N/m */
  int32_t motion;        /* WALE_MOTION_… */
  int32_t reserved;      /* 0 */
  double amplitude;      /* m */
  double frequency;      /* Hz */
  double centre_x, centre_y;       /* m */
  double direction_x, direction_y; /* any length; 0, 0: along x */
  const double* points;  /* of a trace; read during the call only */
  size_t count;          /* how many rows */
} WaleDeviceOptions;

/* All that is plugged in, also what cannot be used, then the pointer, then one simulation for each shipped device. Takes some
   milliseconds for each real device. wale_library_devices knows the owner's declarations too. Error: short_of_resources. */
WALE_API WaleCode wale_devices(WaleDevices** devices, WaleError** error);
WALE_API void wale_devices_free(WaleDevices* devices);
/* 0 for NULL. */
WALE_API size_t wale_devices_count(const WaleDevices* devices);
/* Errors: malformed_value for NULL, a wrong size, or an index that is too large. */
WALE_API WaleCode wale_devices_info(const WaleDevices* devices, size_t index, WaleDeviceInfo* info, WaleError** error);

/* The figures of a shipped device by the name of its profile, for wale_stage_create_for. The text lasts for ever.
   Error: unknown_device. */
WALE_API WaleCode wale_profile(WaleText name, WaleProfile* profile, WaleError** error);

/* Opens a device as `--device` of the command line spells it: "auto" (the best real one, else a simulated one), "usb",
   "simulated", "simulated:NAME", the name of a profile, "pointer", "1209:ffb0", "1-2". `options` may be NULL. May take a
   second. A keeper, a process of its own, watches over a real device from the start; none that can hurt is opened without.
   A Falcon must be moved for homing before it is used: its handle all the way in, then all the way out.
   The runtime alone does not read its owner's declarations, and refuses a real device where there are some:
   wale_library_open_device reads them.
   Errors: unknown_device, absent_device, unusable_device, other_device, untrusted_device, no_keeper; malformed_value for an
   option out of its range. */
WALE_API WaleCode wale_device_open(WaleText spelling, const WaleDeviceOptions* options, WaleDevice** device,
                                   WaleError** error);
WALE_API void wale_device_free(WaleDevice* device);
/* Its figures. The text belongs to the device. */
WALE_API WaleCode wale_device_profile(const WaleDevice* device, WaleProfile* profile, WaleError** error);

#ifdef __cplusplus
}
#endif

#endif
