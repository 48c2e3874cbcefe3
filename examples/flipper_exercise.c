/* Moves the flippers: all of them up, each one alone, front and rear against each other, and back. The robot stays
 * where it is; keep half a metre free around it. */
#include <kenaf/hrt.h>
#include <stdio.h>

static const double kTolerance_deg = 2;
static const double kTimeout_s = 10;

/* Says what failed; true where it did. */
static int failed(const char* what, int result) {
  if (result == HRT_OK) return 0;
  fprintf(stderr, "flipper_exercise: %s: %s: %s\n", what, hrt_error_name(result), hrt_last_error());
  return 1;
}

/* Waits for the flippers after a command was given; true where either failed. */
static int moved_badly(const char* what, int result) {
  if (result == HRT_OK) result = hrt_wait_flippers(kTolerance_deg, kTimeout_s);
  if (failed(what, result)) return 1;
  printf("%s: done at %.2f s\n", what, hrt_time());
  return 0;
}

static int exercise(void) {
  static const char* const names[] = {"front left", "front right", "rear left", "rear right"};
  if (moved_badly("all up", hrt_set_flipper(HRT_ALL_FLIPPERS, 60))) return 1;
  for (int i = 0; i < 4; ++i) {
    if (moved_badly(names[i], hrt_set_flipper(i, 20))) return 1;
    if (moved_badly(names[i], hrt_set_flipper(i, 60))) return 1;
  }
  if (moved_badly("front low, rear high", hrt_set_flippers(15, 15, 90, 90))) return 1;
  if (moved_badly("front high, rear low", hrt_set_flippers(90, 90, 15, 15))) return 1;
  return moved_badly("all up", hrt_set_flipper(HRT_ALL_FLIPPERS, 60));
}

int main(int argc, char** argv) {
  if (argc > 1) {
    fprintf(stderr, "flipper_exercise: not expected: %s; there are no arguments\n", argv[1]);
    return 2;
  }
  if (failed("init", hrt_kenaf_init())) return 1;
  int bad = exercise();
  return failed("close", hrt_close()) || bad;
}
