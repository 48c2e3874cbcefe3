/* Prints how the robot was set up, and its state twice a second of robot time, without moving it. Usage:
 * status_monitor [COUNT], default 10; exit status 2: wrong arguments. It opens the robot as it stands (reset_robot =
 * 0), so it is also a way to see where the last program has left it. */
#include <ctype.h>
#include <kenaf/hrt.h>
#include <stdio.h>
#include <stdlib.h>

/* Says what failed; true where it did. */
static int failed(const char* what, int result) {
  if (result == HRT_OK) return 0;
  fprintf(stderr, "status_monitor: %s: %s: %s\n", what, hrt_error_name(result), hrt_last_error());
  return 1;
}

/* A whole number from 1 to 1000000; 0 of any other text. */
static int count_from(const char* text) {
  char* end = NULL;
  long count = strtol(text, &end, 10);
  return isdigit((unsigned char)*text) && *end == '\0' && count >= 1 && count <= 1000000 ? (int)count : 0;
}

int main(int argc, char** argv) {
  int count = argc > 1 ? count_from(argv[1]) : 10;
  if (argc > 2 || count == 0) {
    fprintf(stderr, "usage: status_monitor [COUNT], a whole number from 1 to 1000000\n");
    return 2;
  }
  hrt_config config = hrt_config_default();
  int result = hrt_config_load(&config);
  config.reset_robot = 0;
  if (result == HRT_OK) result = hrt_kenaf_init_with(&config);
  int bad = failed("init", result);
  char setup[2000] = "";
  if (!bad && hrt_get_setup(setup, sizeof setup) == HRT_OK && *setup) printf("%s\n", setup);
  for (int i = 0; i < count && !bad; ++i) {
    bad = (i > 0 && failed("sleep", hrt_sleep(0.5))) || failed("state", hrt_show_status());
  }
  return failed("close", hrt_close()) || bad;
}
