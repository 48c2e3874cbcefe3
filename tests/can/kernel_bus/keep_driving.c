/* Drives forward at 200 mm/s for ever: keep_driving [CYCLES]; after CYCLES cycles it calls nothing any more, as a
 * program does whose own thread hangs. Says "driving" once it moves; on an error says it, closes the robot, opens it
 * once more, drives for 50 cycles and says "recovered". */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <kenaf/hrt.h>

static int drive(long cycles) {
  hrt_state state = hrt_state_init();
  int degraded = 0;
  for (long i = 0; cycles == 0 || i < cycles; ++i) {
    if (hrt_set_tracks(200, 200) != HRT_OK || hrt_wait_cycle(&state) != HRT_OK) return 0;
    if (i == 50) puts("driving");
    if ((state.activity & HRT_DEGRADED) != 0 && !degraded) {
      char warning[200];
      hrt_get_warning(warning, sizeof warning);
      printf("degraded: %s\n", warning);
      degraded = 1;
    }
    fflush(stdout);
  }
  return 1;
}

int main(int argc, char** argv) {
  const long cycles = argc > 1 ? atol(argv[1]) : 0;
  if (hrt_kenaf_init() != HRT_OK) {
    printf("init: %s\n", hrt_last_error());
    return 1;
  }
  if (drive(cycles)) {
    puts("hanging");
    fflush(stdout);
    for (;;) sleep(1000);
  }
  printf("lost: %s\n", hrt_last_error());
  fflush(stdout);
  hrt_close();
  sleep(2); /* who looks on sees how the robot stops before it moves again */
  for (int tries = 0; hrt_kenaf_init() != HRT_OK; ++tries) { /* until the interface is up again */
    if (tries == 20) return 1;
    sleep(1);
  }
  if (!drive(50)) return 1;
  puts("recovered");
  hrt_close();
  return 0;
}
