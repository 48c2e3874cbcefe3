/* Prints the robot's state twice a second of robot time, without moving it. Usage: status_monitor [COUNT], default 10.
 * It opens the robot as it stands (reset_robot = 0), so it is also a way to see where the last program has left it. */
#include <kenaf/hrt.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  int count = argc > 1 ? atoi(argv[1]) : 10;
  hrt_config config = hrt_config_default();
  int result = hrt_config_load(&config);
  config.reset_robot = 0;
  if (result == HRT_OK) result = hrt_kenaf_init_with(&config);
  for (int i = 0; i < count && result == HRT_OK; ++i) {
    if (i > 0) result = hrt_sleep(0.5);
    if (result == HRT_OK) result = hrt_show_status();
  }
  if (result != HRT_OK) fprintf(stderr, "status_monitor: %s: %s\n", hrt_error_name(result), hrt_last_error());
  hrt_close();
  return result == HRT_OK ? 0 : 1;
}
