/* Drives a square of 100 mm sides: forward, a quarter turn to the left, four times over. The smallest program there is
 * for this robot. Linked with libkenaf_real it drives the robot, linked with libkenaf_sim its simulation. */
#include <kenaf/hrt.h>
#include <stdio.h>

/* Says what failed; true where it did. */
static int failed(const char* what, int result) {
  if (result == HRT_OK) return 0;
  fprintf(stderr, "square: %s: %s: %s\n", what, hrt_error_name(result), hrt_last_error());
  return 1;
}

int main(int argc, char** argv) {
  if (argc > 1) {
    fprintf(stderr, "square: not expected: %s; there are no arguments\n", argv[1]);
    return 2;
  }
  if (failed("init", hrt_kenaf_init())) return 1;
  for (int side = 0; side < 4; ++side) {
    if (failed("forward", hrt_go_forward(100)) || failed("turn", hrt_turning(90))) {
      hrt_close();
      return 1;
    }
    hrt_show_status();
  }
  return failed("close", hrt_close());
}
