/* hrt.h - control of the Kenaf robot: two main tracks under its body, four tracked flipper arms.
 *
 * One program, two libraries. A program written against this header is linked either with libkenaf_real, which drives
 * the robot, or with libkenaf_sim, which drives its simulation. Nothing else changes: both export the same functions
 * with the same types, and everything above the transport is one implementation.
 *
 *     #include <kenaf/hrt.h>
 *
 *     int main(void) {
 *       if (hrt_kenaf_init() != HRT_OK) return 1;      // hrt_last_error() says why
 *       for (int side = 0; side < 4; ++side)
 *         if (hrt_go_forward(100) != HRT_OK || hrt_turning(90) != HRT_OK) return 1;
 *       return hrt_close() == HRT_OK ? 0 : 1;
 *     }
 *
 * Robot time
 *   Every time here is the robot's: seconds on the robot's clock, which a simulator may run slower or faster than the
 *   wall clock, or stop. Sleeping, waiting, time limits and command_timeout_s all count robot time, so that the speed
 *   of a simulation does not change any result. The few exceptions (such as the time-out of a silent link) are marked
 *   as wall-clock time. The clock advances in cycles of a fixed period (default 10 ms): once per cycle the library
 *   receives the measurements and answers with the commands for the next cycle.
 *
 * Lock step
 *   A simulator in lock step (the default) does not begin the next cycle before this one is answered. After a blocking
 *   call of this header has returned, the library holds the answer until the same thread's next blocking call. It gives
 *   that up once the thread has worked or slept for hold_s, counted from the return of the blocking call and anew from
 *   each call that sets something (hrt_set_tracks, hrt_set_flipper(s), hrt_stop). Time in which the thread waits for a
 *   processor or a disk does not count, but an answer is never held for more than 1 s of wall-clock time. So a program
 *   of blocking calls, with any setting calls between them, gives the same run every time, at every speed of the
 *   simulator and on a busy machine. If a program works or sleeps longer than hold_s, robot time continues meanwhile.
 *   The real robot does not wait.
 *
 * Units and frames
 *   Millimetres, degrees, seconds, amperes, volts. The body frame is x forward, y left, z up (REP 103); angles of a
 *   pose are intrinsic z-y-x angles. Yaw and turning are positive to the left (counter-clockwise seen from above),
 *   pitch is positive nose down, roll is positive right side down. A flipper's angle is 0 straight out along the body
 *   and positive with its tip up, for all four flippers. Speeds and travel of a track are those of its surface,
 *   positive where they drive the robot forward.
 *
 * Threads
 *   There is one robot per process. After hrt_kenaf_init every function may be called from any thread at any time, but
 *   not from a signal handler. hrt_go_forward and hrt_turning are motions: only one at a time, a second one returns
 *   HRT_E_BUSY. Any number of threads may sleep and wait at the same time. hrt_stop and hrt_get_state never wait for
 *   the robot. The library runs threads of its own, with all signals blocked. A child of fork() must not use its
 *   parent's robot; if it ends by exit(), its parent's robot continues. A child that lives on without exec() keeps the
 *   bus of libkenaf_real open: if its parent dies, the drives stop, but SYNC continues on the bus, and the next
 *   hrt_kenaf_init returns HRT_E_REFUSED until the child ends.
 *
 * Pictures
 *   hrt_get_picture returns the newest picture of one of the robot's cameras, and its age. Pictures are not part of the
 *   cycle and never delay it; they arrive by wall-clock time, so their time limit counts that.
 *
 * Errors
 *   A function returns HRT_OK (0) or one of the negative HRT_E... values, explained by hrt_last_error(). No function
 *   ends the process, throws through this interface, or crashes on a null pointer (HRT_E_ARGUMENT). A function that
 *   fails because of its arguments, or because it may not be called at that moment, changes nothing in the robot; its
 *   own comment says what becomes of output arguments.
 *   The robot is lost if the link to it breaks or, in libkenaf_real, if a drive is silent, in fault or restarted. From
 *   then on every function that needs the robot fails, with HRT_E_LINK or, because of a drive, with HRT_E_DEVICE, and
 *   only hrt_close and a new init help. Comments below list HRT_E_LINK alone for both.
 *
 * Safety
 *   - A motion ends with an error instead of a hang: stuck, robot lost, or time limit exceeded. After any of these the
 *     tracks are commanded to stop.
 *   - Track speeds hold until changed, but no longer than command_timeout_s after the last call of any hrt_ function; a
 *     blocking call counts as calling for its whole duration.
 *   - If nothing comes from the program's process any more (killed, suspended, network cut), the robot stops by itself:
 *     a simulated one command_timeout_s after the library's last command, the real one master_silence_s (of its
 *     description) after the library's last heartbeat. This does not depend on the program.
 *   - The simulation is not the robot. A program that is safe in simulation is not necessarily safe on the robot.
 */
#ifndef KENAF_HRT_H
#define KENAF_HRT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif
#if defined(__GNUC__)
#pragma GCC visibility push(default) /* the libraries hide everything else */
#endif

/* The binary interface described by this header. The functions that every program calls first have this number in their
 * linked name, so that a program compiled with a header of another interface fails to link or to load, instead of
 * misreading structs. In source they are hrt_kenaf_init and hrt_kenaf_init_with; bindings of other languages, which do
 * not read this header, call hrt_kenaf_init_abi1 and hrt_kenaf_init_with_abi1. */
#define HRT_ABI 1
#define hrt_kenaf_init hrt_kenaf_init_abi1
#define hrt_kenaf_init_with hrt_kenaf_init_with_abi1

/* This header is C89 and C++98: of later standards it needs <stdint.h> alone, which has the types of fixed size that a
 * binary interface needs, and which every compiler for Linux brings for every standard. C89 has no `inline`. */
#if defined(__cplusplus) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L)
#define HRT_INLINE static inline
#elif defined(__GNUC__)
#define HRT_INLINE static __inline__
#else
#define HRT_INLINE static
#endif

/* Return values. */
enum {
  HRT_OK = 0,
  HRT_E_NOT_INITIALISED = -1, /* hrt_kenaf_init was not called, or did not succeed, or hrt_close was called */
  HRT_E_BUSY = -2,            /* another motion is under way; the robot or a recording is already open */
  HRT_E_ARGUMENT = -3,        /* a null pointer, a number that is not finite or out of range */
  HRT_E_CONFIG = -4,          /* the configuration file or an environment variable is wrong: file, line, column named */
  HRT_E_LINK = -5,            /* no answer from the robot or its simulation, or the robot is lost, see Errors.
                                 hrt_get_picture also: no answer from the cameras, and its next call tries again */
  HRT_E_REFUSED = -6,         /* the relay answered, but refuses the robot; libkenaf_real: another program has it. The
                                 reason is in hrt_last_error() */
  HRT_E_TIMEOUT = -7,         /* the goal was not reached within its time limit (robot time) */
  HRT_E_STUCK = -8,           /* the sensors show no progress, or a track's current stayed above stuck_current_a */
  HRT_E_STOPPED = -9,         /* hrt_stop or hrt_set_tracks of another thread, or a reset of the world by another
                                 program, ended this motion */
  HRT_E_CLOSED = -10,         /* hrt_close of another thread ended this call */
  HRT_E_DEVICE = -11,         /* no such device or camera, no answer from it, or the request is not supported.
                                 libkenaf_real also: the robot is lost because of a drive, see Errors */
  HRT_E_RECORD = -12,         /* the recording could not be written, or is incomplete */
  HRT_E_INTERNAL = -13        /* out of memory or threads, or a defect of the library */
};

/* Indices of every array of flippers and tracks. */
enum {
  HRT_FRONT_LEFT = 0,
  HRT_FRONT_RIGHT = 1,
  HRT_REAR_LEFT = 2,
  HRT_REAR_RIGHT = 3,
  HRT_ALL_FLIPPERS = 4 /* only as the argument of hrt_set_flipper */
};
enum { HRT_LEFT = 0, HRT_RIGHT = 1 };

/* ---- Configuration ----
 *
 * Three sources, each overriding the previous one:
 *   1. the defaults built into the library,
 *   2. a TOML file: the one named by the environment variable KENAF_CONFIG, else ./kenaf.toml, else
 *      ~/.config/kenaf/kenaf.toml; its keys are the member names below, and an unknown key is an error,
 *   3. environment variables: KENAF_ and the member's name in capitals, such as KENAF_RELAY=127.0.0.1:45454 or
 *      KENAF_PERIOD_S=0.02; true and false, or 1 and 0. A variable whose name begins with KENAF_ and is neither one of
 *      these nor one of Kenaf's others (the user guide lists them) is an error.
 * Both libraries read all keys, so that they can share one file; each uses its own. */
typedef struct hrt_config {
  uint32_t size;   /* sizeof(hrt_config) of the program, so that the struct can grow */
  uint32_t cookie; /* set by hrt_config_default, checked by hrt_kenaf_init_with */

  /* Cycle and link. */
  double period_s;          /* one cycle, robot time: 0.001 to 1, default 0.01; libkenaf_real: at most 0.02, and long
                               enough for its bus load (else HRT_E_CONFIG): about 0.006 at 500 kbit/s */
  double command_timeout_s; /* the tracks stop after this long without an hrt_ call or, in a simulator, without a
                               command from the library, see Safety; robot time: 0.01 to 10, default 0.1; not below
                               period_s */
  double link_timeout_s;    /* libkenaf_sim: silence that means a lost link, wall clock: 0.05 to 10, default 0.5 */
  double connect_timeout_s; /* libkenaf_sim: how long init waits for the robot, wall clock: 0.05 to 60, default 3 */

  /* Motions: hrt_go_forward and hrt_turning. */
  double max_speed_mmps;           /* 1 to 2000, default 200 */
  double acceleration_mmps2;       /* 10 to 10000, default 400; also the deceleration */
  double max_turn_degps;           /* 1 to 360, default 45 */
  double turn_acceleration_degps2; /* 10 to 3600, default 120 */
  double distance_tolerance_mm;    /* 0.1 to 100, default 1 */
  double angle_tolerance_deg;      /* 0.05 to 10, default 0.3 */
  double stuck_time_s;             /* a motion without progress for this long is stuck, robot time: 0.1 to 60,
                                      default 1 */
  double stuck_current_a;          /* a motion with more current in a track for stuck_time_s is stuck too: 0 to 1000,
                                      default 0 = off */
  double track_gauge_mm;           /* between the tracks' centre lines: 50 to 5000, default 200 */
  double turn_efficiency;          /* the body's turn over the one that the tracks' travel would give without slip:
                                      0.1 to 2, default 1. Used only without an orientation sensor. */

  /* libkenaf_sim. */
  double hold_s;       /* how long lock step lets a program work or sleep, see Lock step: 0 to 0.2, default 0.05 */
  int32_t lockstep;    /* 1: robot time waits for this program (default); 0: it does not */
  int32_t reset_robot; /* 1: init returns the robot to its start pose (default); 0: it stays where it is */
  char relay[128];     /* HOST:PORT of kenaf-relayd, IPv6 with or without brackets, default 127.0.0.1:45454 */

  /* libkenaf_real. */
  double can_timeout_s;   /* how long init waits until all nodes of the bus have started, wall clock: 0.05 to 60,
                             default 5 */
  char can_interface[16]; /* default "": the one named in the robot's description */
  char robot[256];        /* the robot's description, whose table [can] lists the nodes on its bus: a shipped name or
                             the path of a TOML file; default "kenaf" */

  /* Recording. */
  char record[1024]; /* a file: hrt_kenaf_init starts a recording into it, see hrt_record_start; default "": no
                        recording */

  /* libkenaf_sim: pictures. */
  char camera_server[128]; /* HOST:PORT of the world server's cameras, default 127.0.0.1:5003; see hrt_get_picture */
} hrt_config;

/* Fills *config with the defaults. config->size must be set; hrt_config_default() does both. HRT_E_ARGUMENT: null, or
 * the size of no version of this header. Any thread, before or after init. */
int hrt_config_fill(hrt_config* config);

/* Overrides *config by file and environment as above; other members keep their value. HRT_E_ARGUMENT: null or not from
 * hrt_config_default(); HRT_E_CONFIG: *config is unchanged, hrt_last_error() names file, line and column, or the
 * variable, or the members that contradict each other. Reads the environment: not while another thread changes it. */
int hrt_config_load(hrt_config* config);

/* Returns the built-in defaults, to be changed and passed to hrt_kenaf_init_with. */
HRT_INLINE hrt_config hrt_config_default(void) {
  hrt_config config;
  memset(&config, 0, sizeof config);
  config.size = (uint32_t)sizeof config;
  (void)hrt_config_fill(&config);
  return config;
}

/* ---- Beginning and end ---- */

/* Opens the robot, configured by file and environment, and waits until its first state has arrived. The robot does not
 * move, except flippers whose description requires a homing motion; with reset_robot a simulated robot returns to its
 * start pose. Odometry begins at 0.
 * Blocks up to connect_timeout_s of wall-clock time; libkenaf_real: can_timeout_s until all nodes have started, a
 * second or two to configure them, and the homing. Cannot be interrupted, not even by hrt_close() in another thread.
 * HRT_E_BUSY: the robot is open already (a lost one is closed and reopened), or is being opened or closed;
 * HRT_E_CONFIG, also (libkenaf_real) if the system forbids the real time that the description asks for; HRT_E_LINK: no
 * answer, hrt_last_error() says what to start; HRT_E_REFUSED: another program has the robot, or the relay has no world
 * server; HRT_E_DEVICE: (libkenaf_real) no SocketCAN in the kernel, no such interface, interface down, or a node, named
 * in hrt_last_error() with the reason, that does not start, is not of the expected kind, refuses a value or cannot be
 * enabled; HRT_E_RECORD: the configured recording cannot be started. */
int hrt_kenaf_init(void);

/* The same with *config alone; file and environment are not read (hrt_config_load does that). Also HRT_E_ARGUMENT:
 * null, not from hrt_config_default(), a member out of range, or two that contradict each other; hrt_last_error() names
 * them. */
int hrt_kenaf_init_with(const hrt_config* config);

/* Stops the tracks, ends a recording with the newest cycle, and releases the robot. Calls waiting in other threads
 * return HRT_E_CLOSED. Also called when the process ends by exit() or by returning from main(). Without an open robot,
 * or while another thread opens or closes it: HRT_OK; an opening continues.
 * HRT_E_RECORD: closed, but the recording is incomplete. libkenaf_real also HRT_E_DEVICE and HRT_E_LINK: closed, but
 * drives, named by hrt_last_error(), or the bus did not confirm that the robot stopped; its drives stop by themselves
 * master_silence_s later; or drives have stopped, but no longer hold their position, so that flippers may sink. */
int hrt_close(void);

/* ---- Motions: blocking, closed-loop, one at a time ----
 *
 * Both follow a trapezoidal speed profile, corrected by the sensors, and return once the goal is reached within its
 * tolerance and the robot stands still, with the tracks commanded to 0. A motion starts from the goal heading of the
 * previous one if the robot is still near it (2 degrees), so that the errors of successive motions do not accumulate.
 *
 * HRT_E_NOT_INITIALISED; HRT_E_BUSY: another thread's motion is under way; HRT_E_ARGUMENT; HRT_E_LINK; HRT_E_STUCK: the
 * sensors show no progress for stuck_time_s (travel is measured at the tracks, so tracks spinning in front of a wall
 * are not detected unless stuck_current_a is set); HRT_E_TIMEOUT: after three times the duration of the profile (five
 * times for a turn) plus 5 s; HRT_E_STOPPED, also where another program resets the simulated world; HRT_E_CLOSED;
 * HRT_E_DEVICE: the robot has no track encoders. */

/* Drives `mm` straight forward (negative: backward), -1000000 to 1000000, and holds the heading by the orientation
 * sensor or, without one, by the track encoders. */
int hrt_go_forward(double mm);

/* Turns in place by `deg` to the left (negative: to the right), -36000 to 36000; 720 are two full turns. Measured by
 * the orientation sensor or, without one, by the track encoders and turn_efficiency. */
int hrt_turning(double deg);

/* ---- Direct control: does not block ---- */

/* Commands both track speeds, -2000 to 2000 mm/s, from the next cycle on, until changed or until command_timeout_s
 * after the last hrt_ call. The drives limit their acceleration. The robot limits speeds to its own maximum
 * (libkenaf_real: of its description); hrt_state.commanded_track_mmps and recordings show the requested speeds. Ends a
 * motion under way, which returns HRT_E_STOPPED. HRT_E_NOT_INITIALISED, HRT_E_ARGUMENT, HRT_E_LINK. */
int hrt_set_tracks(double left_mmps, double right_mmps);

/* Commands one flipper, or HRT_ALL_FLIPPERS, to an angle, -360 to 360 degrees: 0 straight out, positive tip up. The
 * flipper moves at its own speed, within the limits of its drive, and holds the angle; see hrt_wait_flippers. An angle
 * beyond the joint's range becomes the same direction within the range or, if there is none, the nearer end;
 * hrt_state.commanded_flipper_deg, recordings and hrt_wait_flippers use the requested angle. A flipper that the robot
 * has not is commanded in vain: HRT_OK, and nothing moves. HRT_E_NOT_INITIALISED, HRT_E_ARGUMENT, HRT_E_LINK. */
int hrt_set_flipper(int flipper, double deg);

/* Commands all four at once. */
int hrt_set_flippers(double front_left_deg, double front_right_deg, double rear_left_deg, double rear_right_deg);

/* Stops: tracks to 0 at once; flippers that are still moving are commanded to the angles measured last and hold them. A
 * motion or hrt_wait_flippers in another thread returns HRT_E_STOPPED. Does not block. HRT_E_NOT_INITIALISED,
 * HRT_E_LINK. */
int hrt_stop(void);

/* ---- Waiting: blocking, robot time ---- */

/* Waits until every flipper that was ever commanded is within `tolerance_deg` (0.1 to 90) of its angle, at most
 * `timeout_s` (0 to 3600). HRT_E_TIMEOUT: hrt_last_error() names those that are not; they continue to move.
 * HRT_E_DEVICE: the robot does not measure its flippers; HRT_E_STOPPED; otherwise as hrt_sleep. */
int hrt_wait_flippers(double tolerance_deg, double timeout_s);

/* Waits `seconds` of robot time, 0 to 86400, rounded up to whole cycles; 0 returns at once.
 * HRT_E_NOT_INITIALISED, HRT_E_ARGUMENT, HRT_E_LINK, HRT_E_CLOSED. */
int hrt_sleep(double seconds);

/* Returns robot time in seconds, as of the newest cycle; -1 if no robot is open. */
double hrt_time(void);

/* ---- State ---- */

/* Bits of hrt_state.valid: which members were measured. Members whose bit is missing are 0. A sensor slower than the
 * cycle keeps bit and value until it measures again; a recording has the value only in cycles that measured it. */
enum {
  HRT_HAS_POSTURE = 1 << 0,  /* roll, pitch, yaw by the robot's orientation sensor; in names, "posture" means this */
  HRT_HAS_ENCODERS = 1 << 1, /* track_mm, track_mmps, odometry */
  HRT_HAS_FLIPPERS = 1 << 2, /* flipper_deg */
  HRT_HAS_CURRENTS = 1 << 3, /* track_a, flipper_a */
  HRT_HAS_BATTERY = 1 << 4,  /* battery_v */
  HRT_HAS_INERTIAL = 1 << 5, /* gyro, acceleration */
  HRT_HAS_POSE = 1 << 6      /* pose_*: from an external source */
};

/* Bits of hrt_state.activity. */
enum {
  HRT_MOTION_ACTIVE = 1 << 0,      /* a motion is under way */
  HRT_PAUSED = 1 << 1,             /* the simulation's clock has been stopped by somebody */
  HRT_STOPPED_BY_SILENCE = 1 << 2, /* the tracks were stopped, until their next command, because no hrt_ call came for
                                      command_timeout_s; libkenaf_sim also: because no command came from the library */
  HRT_RECORDING = 1 << 3,          /* a recording is under way, and its rows can be written: falls with the first one
                                      that cannot, see hrt_record_start */
  HRT_IN_LOCKSTEP = 1 << 4,        /* robot time waits for this program */
  HRT_DEGRADED = 1 << 5            /* the robot lacks something, or a recording is incomplete, or (libkenaf_real) its
                                      configuration does not fit its description, or (libkenaf_sim) it did not begin at
                                      the first start pose: hrt_get_warning says what */
};

/* State of the robot as of one cycle. */
typedef struct hrt_state {
  uint32_t size;               /* sizeof(hrt_state) of the program, so that the struct can grow: see hrt_state_init() */
  uint32_t valid;              /* HRT_HAS_... */
  uint32_t activity;           /* HRT_MOTION_ACTIVE ... */
  uint32_t flippers_commanded; /* bit i: commanded_flipper_deg[i] was commanded since init, and the robot has it */
  uint64_t cycle;              /* number of the cycle, 1 = the first one after init */
  double time_s;               /* robot time of the measurement */

  double roll_deg, pitch_deg, yaw_deg; /* body in world, each in (-180, 180]; yaw is 0 where the sensor has its zero:
                                          to hold a heading, use odometry_yaw_deg */
  double gyro_degps[3];                /* turn rate about x, y, z of the body */
  double acceleration_mmps2[3];        /* along x, y, z of the body; at rest on level ground 0, 0, +9807 */

  double track_mm[2];    /* travel of each track's surface since the robot was placed or switched on */
  double track_mmps[2];  /* and its speed */
  double track_a[2];     /* motor currents */
  double flipper_deg[4]; /* 0 for one that the robot has not */
  double flipper_a[4];
  double battery_v;

  /* Dead reckoning by the library since init: the tracks' mean travel along the orientation sensor's heading and slope,
   * or along the encoders' heading if there is no such sensor. Start: 0, 0, 0; x is forward at the start, y left. Yaw
   * is not wrapped: it counts full turns. Tracks slip, so this drifts. A reset of the world by another program adds
   * nothing: from then on this tells how the robot was driven, not where it is. */
  double odometry_x_mm, odometry_y_mm, odometry_yaw_deg;

  /* Pose in the world of the body frame, whose origin is the body's geometric centre, from an external
   * source: a simulator's ground truth. The real robot does not know it: a control program must not need it. */
  double pose_x_mm, pose_y_mm, pose_z_mm, pose_roll_deg, pose_pitch_deg, pose_yaw_deg;

  /* Commands of the newest answer to the robot, before the robot limits them. */
  double commanded_track_mmps[2];
  double commanded_flipper_deg[4];

  /* The link. */
  double round_trip_ms; /* to the world server and back (real: to the drives), wall clock, newest; 0 = not yet known */
  uint64_t late_cycles; /* answers that came after the cycle they were for, since init */
  uint64_t lost_cycles; /* cycles whose state never arrived, since init */
} hrt_state;

/* Returns an empty state for hrt_get_state. */
HRT_INLINE hrt_state hrt_state_init(void) {
  hrt_state state;
  memset(&state, 0, sizeof state);
  state.size = (uint32_t)sizeof state;
  return state;
}

/* Copies the newest state, all of it from one cycle. Does not block. state->size must be set. HRT_E_NOT_INITIALISED;
 * HRT_E_ARGUMENT: null or the size of no version of this header; HRT_E_LINK: the robot is lost, *state holds the last
 * state that arrived. */
int hrt_get_state(hrt_state* state);

/* Waits for the next cycle and copies its state: the clock of a control loop. `state` may be null. Returns as hrt_sleep
 * and hrt_get_state do. */
int hrt_wait_cycle(hrt_state* state);

/* Describes what is missing on the robot, in one line of English such as "inclinometer (node 7) is silent: no posture,
 * and the heading is that of the tracks"; "" if nothing is missing. Also reports, until hrt_record_stop, a recording
 * that is incomplete, because the disk is full or too slow. libkenaf_real also reports a track_gauge_mm more than 5 %
 * off the description's; libkenaf_sim that the robot did not begin at the world's first start pose, because it was not
 * free. Writes at most size - 1 bytes and a zero, even if the call fails for a reason other than its arguments.
 * HRT_E_NOT_INITIALISED; HRT_E_ARGUMENT: null or size 0; HRT_E_LINK: as of the last state. */
int hrt_get_warning(char* text, size_t size);

/* Describes how hrt_kenaf_init has set the robot up, for people, a line each without an end of the last one.
 * libkenaf_real says of each drive which of the two watches it has that stop it when the program ends: "track left
 * (node 1) watches its master's heartbeat (0x1016, 0.1 s) and its commands (0x1400:05, 0.1 s)"; and whether its cycles
 * run in real time: "cycles by SCHED_FIFO at priority 50, memory locked". libkenaf_sim: "". Writes, fails and ends as
 * hrt_get_warning does; 1000 bytes hold it for six drives. */
int hrt_get_setup(char* text, size_t size);

/* Prints the newest state to standard output in a few lines of text. HRT_E_NOT_INITIALISED; HRT_E_LINK: prints the last
 * state that arrived. */
int hrt_show_status(void);

/* ---- Pictures ----
 *
 * Pictures of the robot's cameras. The robot's description lists them ([[camera]]): for Kenaf "Camera" at the front and
 * "BirdsEye" above. libkenaf_sim gets their pictures from the world server's image port (camera_server), libkenaf_real
 * from the video device named in the description (V4L2).
 *
 *     static unsigned char pixels[640 * 480 * 3];
 *     hrt_picture picture = hrt_picture_init();
 *     while (hrt_get_picture("Camera", HRT_PICTURE_RGB, pixels, sizeof pixels, 1, &picture) == HRT_OK)
 *       steer_by(pixels, picture.width, picture.height, picture.age_ms);     // each picture once, always the newest
 *
 * Cost. The first call for a camera opens a connection and starts a thread, hrt_close ends both. A program that
 * requests no picture has neither; no cycle ever waits for one. Pictures are transferred from the first call until 2 s
 * (wall clock) after the last; the next call resumes the transfer, which may take a real camera a second.
 *
 * Time. Pictures are made, sent and read in wall-clock time, so timeout_s and age_ms count that, and which picture a
 * call returns may differ from run to run. A call that has to wait is a blocking call: robot time continues, track
 * speeds hold, and in lock step robot time then waits for the program's next call. A call that finds its picture, or
 * has timeout_s = 0, does not block, and counts in lock step as the program's own work. So a control loop of
 * hrt_wait_cycle uses timeout_s = 0 and takes HRT_E_TIMEOUT for "no new one". */

/* Formats that hrt_get_picture writes to `data`. Both: rows from the top, each from the left. */
enum {
  HRT_PICTURE_RGB = 0, /* 3 bytes a pixel: red, green, blue, 0 to 255; no padding: 3 * width * height bytes */
  HRT_PICTURE_JPEG = 1 /* a whole JPEG file. One made by the camera is passed on unchanged (a webcam's may lack the
                          standard Huffman tables, as Motion JPEG allows); else quality is the description's
                          jpeg_quality */
};

/* Properties of a picture. */
typedef struct hrt_picture {
  uint32_t size;         /* sizeof(hrt_picture) of the program, so that the struct can grow: see hrt_picture_init() */
  int32_t format;        /* HRT_PICTURE_... of `data` */
  int32_t width, height; /* pixels */
  uint64_t number;       /* of this picture at this camera; grows, a gap counts pictures that this program missed.
                            Also an argument: a picture with another number is requested; 0 = any */
  double time_s;         /* robot time of its exposure. libkenaf_real: from age and cycle, accurate to a cycle;
                            -1: unknown */
  double age_ms;         /* from its exposure to the return of this call, wall clock, never less than the true age;
                            -1: unknown. libkenaf_sim: the age at sending, reported by the server, plus the time since
                            the picture was requested, which is shortly before it is due: some milliseconds too much,
                            and up to a period for the first ones. libkenaf_real: from the driver's time stamp; if that
                            marks the end of a picture, its period is added */
  size_t bytes;          /* of `data`: written, or needed if `capacity` is too small */
  char camera[64];       /* the camera's name; "" if the server does not report it */
} hrt_picture;

/* Returns an empty hrt_picture for hrt_get_picture: its number is 0, so that the first call gets any picture. Use one
 * for each camera and loop, and a new one after hrt_kenaf_init, because cameras restart their counts. */
HRT_INLINE hrt_picture hrt_picture_init(void) {
  hrt_picture picture;
  memset(&picture, 0, sizeof picture);
  picture.size = (uint32_t)sizeof picture;
  return picture;
}

/* Writes the newest picture of `camera` to `data` and its properties to *picture.
 *
 * camera    a name from the robot's description, at most 63 bytes; null or "": the robot's first camera. libkenaf_sim:
 *           of the robot placed last, unless the name is "ROBOT/CAMERA" as the world server names robots.
 * format    HRT_PICTURE_RGB or HRT_PICTURE_JPEG.
 * data      `capacity` bytes; null with capacity 0 queries the required size. JPEG files differ in size; they hardly
 *           ever exceed 3 * width * height bytes. Its contents are unspecified if the call fails.
 * timeout_s 0 to 60, wall clock: longest wait for a picture whose number is not picture->number.
 *
 * HRT_OK: *picture and `data` belong to the same picture.
 * HRT_E_TIMEOUT: no other picture in time; *picture is unchanged. Also while the connection is still being made.
 * HRT_E_ARGUMENT: picture null or its size wrong, data null, no such format, or a number out of range. Or `capacity` is
 *   too small: picture->bytes, width, height, format and camera give the requirements, everything else is unchanged, so
 *   that the next call returns this picture or a newer one.
 * HRT_E_DEVICE: no such camera: hrt_last_error() lists the existing ones. libkenaf_real: the description gives it no
 *   device, or the device is missing, in use, unplugged, silent, no camera, or lacks the resolution. Either: the
 *   picture is damaged or larger than 4096 x 4096.
 * HRT_E_LINK: the robot is lost; or (libkenaf_sim) no server at camera_server, or it falls silent or sends
 *   something else.
 * HRT_E_CONFIG: camera_server is no HOST:PORT, or (libkenaf_real) a [[camera]] of the description is wrong.
 * HRT_E_CLOSED; HRT_E_NOT_INITIALISED.
 * After HRT_E_DEVICE, HRT_E_CONFIG and HRT_E_LINK caused by a camera the robot continues, and the next call reopens the
 * camera.
 *
 * May be called from any thread; hrt_stop does not end it. Decodes in the calling thread. */
int hrt_get_picture(const char* camera, int format, void* data, size_t capacity, double timeout_s,
                    hrt_picture* picture);

/* ---- Recording ---- */

/* Records every cycle from the newest one on into a CSV file of the format kenaf-runs/1 (SI units): commands,
 * measurements, and the pose if known. A row's command is the one in force from that row's time on. A separate thread
 * writes to <path>.part, which hrt_record_stop renames to `path`: that file is complete or absent, and an incomplete
 * recording stays in the part file. No cycle waits for the disk; only in lock step, where robot time waits too, a row
 * that finds 8192 others queued waits 0.1 s for the disk before it is lost. An existing file of that name is replaced.
 * A full disk, or another reason why a row cannot be written, shows within a cycle or two: HRT_RECORDING falls,
 * hrt_get_warning has the reason, and no later row is written. The robot goes on; hrt_record_stop ends the recording.
 * HRT_E_NOT_INITIALISED; HRT_E_BUSY: a recording was not ended; HRT_E_ARGUMENT: null or empty; HRT_E_RECORD: the file
 * cannot be created; HRT_E_LINK. */
int hrt_record_start(const char* path);

/* Ends the recording and waits until the file is complete. HRT_E_NOT_INITIALISED; HRT_E_RECORD: none was under way, or
 * it could not be written, or rows were lost because the disk was too slow: hrt_last_error() says how many. */
int hrt_record_stop(void);

/* ---- Error texts and version ---- */

/* Returns the reason for the last failure in this thread, one line of English without a line end; "" if there was none.
 * Never null. Valid until this thread's next hrt_ call fails. */
const char* hrt_last_error(void);

/* Returns "HRT_E_STUCK" for HRT_E_STUCK, "HRT_OK" for HRT_OK, "unknown error" for other values. Never null; static. */
const char* hrt_error_name(int error);

/* The library's version, "MAJOR.MINOR.PATCH", and which library this is: "real" or "sim". Never null; static. */
const char* hrt_version(void);
const char* hrt_library(void);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif /* KENAF_HRT_H */
