/* Drives onto a box that is higher than the tracks' end wheels: front flippers up, on to the box until they have
 * lifted the nose, rear flippers down to push, and all flippers straight once the robot lies level on top. It feels
 * its way by the orientation sensor alone. In simulation: kenaf-world --world step-100; the box begins 1 m ahead. */
#include <kenaf/hrt.h>
#include <stdio.h>

static const double kDriveSpeed_mmps = 100;
static const double kClimbSpeed_mmps = 80;

static int check(const char* what, int result) {
  if (result == HRT_OK) return 1;
  fprintf(stderr, "obstacle_drive: %s: %s: %s\n", what, hrt_error_name(result), hrt_last_error());
  return 0;
}

/* Nose-up pitch, averaged over a tenth of a second: hrt.h counts nose down as positive. False where it failed. */
static int nose_up_deg(double* out) {
  hrt_state state = hrt_state_init();
  double sum = 0;
  for (int i = 0; i < 10; ++i) {
    if (!check("state", hrt_wait_cycle(&state))) return 0;
    sum -= state.pitch_deg;
  }
  *out = sum / 10;
  return 1;
}

/* Drives on at `speed_mmps` until the nose is above (or below) `deg`, at most `limit_s` of robot time. */
static int drive_until(const char* what, double speed_mmps, int above, double deg, double limit_s) {
  double start_s = hrt_time(), nose_deg = 0;
  if (!check(what, hrt_set_tracks(speed_mmps, speed_mmps))) return 0;
  do {
    if (!nose_up_deg(&nose_deg)) return 0;
    if (hrt_time() - start_s > limit_s) {
      fprintf(stderr, "obstacle_drive: %s: not within %g s, the nose is up by %.1f degrees\n", what, limit_s, nose_deg);
      return 0;
    }
  } while (above ? nose_deg < deg : nose_deg > deg);
  printf("%s: nose up %.1f degrees at %.2f s\n", what, nose_deg, hrt_time());
  return 1;
}

static int flippers(const char* what, double front_deg, double rear_deg) {
  return check(what, hrt_set_flippers(front_deg, front_deg, rear_deg, rear_deg)) &&
         check(what, hrt_wait_flippers(3, 10));
}

static int climb(void) {
  hrt_state state = hrt_state_init();
  if (!flippers("front flippers up", 50, 10)) return 0;
  if (!check("approach", hrt_go_forward(450))) return 0;
  if (!drive_until("the flippers lift the nose", kDriveSpeed_mmps, 1, 8, 15)) return 0;
  /* Rear flippers down: they push the tail up while the tracks pull. The front ones reach for the top. */
  if (!check("push", hrt_set_flippers(10, 10, -20, -20))) return 0;
  if (!drive_until("over the edge", kClimbSpeed_mmps, 0, 4, 20)) return 0;
  if (!check("on top", hrt_set_tracks(0, 0))) return 0;
  if (!flippers("flippers straight", 30, 30)) return 0;
  if (!check("forward", hrt_go_forward(300))) return 0;
  if (!check("state", hrt_get_state(&state))) return 0;
  printf("on top at %.2f s; odometry %.0f mm\n", state.time_s, state.odometry_x_mm);
  if (state.valid & HRT_HAS_POSE) printf("pose: x %.0f mm, z %.0f mm\n", state.pose_x_mm, state.pose_z_mm);
  return 1;
}

int main(int argc, char** argv) {
  if (argc > 1) {
    fprintf(stderr, "obstacle_drive: not expected: %s; there are no arguments\n", argv[1]);
    return 2;
  }
  if (!check("init", hrt_kenaf_init())) return 1;
  int done = climb();
  return check("close", hrt_close()) && done ? 0 : 1;
}
